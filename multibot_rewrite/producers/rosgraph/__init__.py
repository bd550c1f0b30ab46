"""Snapshots as messages of the type ``rosgraph_msgs/Graph``."""
