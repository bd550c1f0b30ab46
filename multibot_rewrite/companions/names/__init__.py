"""Names of the description and of the ROS graph -> the names that each robot has."""
