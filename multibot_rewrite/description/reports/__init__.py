# SPDX-License-Identifier: Apache-2.0
"""Reports about a description: changes, explanations, a xacro's arguments and suggested plugin
definitions."""
