# SPDX-License-Identifier: Apache-2.0
"""MB5: the kinematic tree and its joints."""

# The files of its rules, loaded where they are asked.
THEMES = (".tree", ".limits", ".joints", ".mimic", ".starts", ".control_values")
