# SPDX-License-Identifier: Apache-2.0
"""A running system: what is in it, what is wrong with it, what changes."""
