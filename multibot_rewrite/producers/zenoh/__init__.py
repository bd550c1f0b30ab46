# SPDX-License-Identifier: Apache-2.0
"""The graph as a Zenoh router knows it; needs no ROS."""

# What the keys of rmw_zenoh's liveliness tokens begin with.
SPACE = "@ros2_lv"
