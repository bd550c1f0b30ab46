# SPDX-License-Identifier: Apache-2.0
"""Findings about robot descriptions: a file -> subjects -> rules -> findings -> a report."""
