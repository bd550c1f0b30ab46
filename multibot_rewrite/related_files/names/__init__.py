# SPDX-License-Identifier: Apache-2.0
"""Names of the description and of the ROS graph -> the names that each robot has."""
