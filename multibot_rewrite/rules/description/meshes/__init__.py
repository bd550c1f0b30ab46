# SPDX-License-Identifier: Apache-2.0
"""MB7: mesh and texture files, and the packages they are in."""

# The files of its rules, loaded where they are asked.
THEMES = (".lookup", ".paths", ".boxes")
