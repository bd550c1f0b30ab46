# SPDX-License-Identifier: Apache-2.0
"""MB2: names that nothing declares, or that are declared twice."""

# The files of its rules, loaded where they are asked.
THEMES = (
    ".undeclared",
    ".duplicates",
    ".gazebo",
    ".control",
    ".controllers",
    ".interfaces",
    ".simulated",
    ".transforms",
)
