# SPDX-License-Identifier: Apache-2.0
"""Reports about a description: changes, explanations, coverage and suggested vocabulary."""
