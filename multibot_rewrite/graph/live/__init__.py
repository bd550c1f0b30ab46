"""Speaking to the live graph: a child process with rclpy, and the command's side of it."""
