# SPDX-License-Identifier: Apache-2.0
"""A fleet file -> everything its robots need: rewritten descriptions, tables, related files."""
