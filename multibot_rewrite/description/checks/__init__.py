# SPDX-License-Identifier: Apache-2.0
"""Checks of a description that both the rewrite and the lint run."""
