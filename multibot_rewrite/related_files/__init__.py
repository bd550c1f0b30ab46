# SPDX-License-Identifier: Apache-2.0
"""Files that use the names of a description (parameters, RViz, MoveIt ...): renamed for each robot."""
