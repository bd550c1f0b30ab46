# SPDX-License-Identifier: Apache-2.0
"""Snapshots as messages of the type ``rosgraph_msgs/Graph``."""
