# SPDX-License-Identifier: Apache-2.0
"""A description: its text read, checked, rewritten and verified."""
