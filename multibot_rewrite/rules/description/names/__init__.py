# SPDX-License-Identifier: Apache-2.0
"""MB3: how names are written."""

# The files of its rules, loaded where they are asked.
THEMES = (".links_and_joints", ".ros_names")
