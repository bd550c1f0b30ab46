# SPDX-License-Identifier: Apache-2.0
"""MB8: an SRDF against its URDF."""

# The files of its rules, loaded where they are asked.
THEMES = (".names", ".pairs", ".states")
