# SPDX-License-Identifier: Apache-2.0
"""Reports about a description: changes, explanations, xacro arguments, suggested definitions."""
