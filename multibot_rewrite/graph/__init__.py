"""The live ROS graph: what it looks like, told so that a program without ROS can judge it."""
