# SPDX-License-Identifier: Apache-2.0
"""The rules: a folder per group, a file per theme. A rule has a description, examples and a check."""
