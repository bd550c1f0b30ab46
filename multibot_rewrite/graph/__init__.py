"""The live ROS graph as records, and its comparison with a plan; only ``live`` needs ROS."""
