# SPDX-License-Identifier: Apache-2.0
"""A running system looked at: what is in it, what is wrong with it, what changes."""
