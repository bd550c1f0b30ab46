# SPDX-License-Identifier: Apache-2.0
"""Access to the live graph: child processes that use rclpy, and the command's side of them."""
