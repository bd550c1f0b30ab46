# SPDX-License-Identifier: Apache-2.0
"""Programs for who works on this repository: tables from sources, and pages. Not installed."""
