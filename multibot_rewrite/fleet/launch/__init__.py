# SPDX-License-Identifier: Apache-2.0
"""Launch files: the one that is written, and those that a fleet names."""
