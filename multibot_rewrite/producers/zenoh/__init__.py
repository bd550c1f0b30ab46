# SPDX-License-Identifier: Apache-2.0
"""The graph as a Zenoh router knows it; needs no ROS."""
