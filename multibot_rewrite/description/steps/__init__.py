# SPDX-License-Identifier: Apache-2.0
"""The steps of a rewrite, one module each: document, collect, plan, apply, verify."""
