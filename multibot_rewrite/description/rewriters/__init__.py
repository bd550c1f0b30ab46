# SPDX-License-Identifier: Apache-2.0
"""The tree of rewriters: plugin definitions hung where they apply, and code for the odd ones."""
