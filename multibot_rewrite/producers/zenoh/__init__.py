"""The graph as a Zenoh router knows it; needs no ROS."""
