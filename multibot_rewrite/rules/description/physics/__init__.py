# SPDX-License-Identifier: Apache-2.0
"""MB6: mass, inertia, shapes, and geometry against the robot."""

# The files of its rules, loaded where they are asked.
THEMES = (".mass", ".inertia", ".shapes", ".drives", ".sensors", ".placement", ".loads")
