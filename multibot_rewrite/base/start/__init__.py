# SPDX-License-Identifier: Apache-2.0
"""The file that each child process of Python begins with; nothing else is in this folder."""
