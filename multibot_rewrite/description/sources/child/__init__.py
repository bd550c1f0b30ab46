# SPDX-License-Identifier: Apache-2.0
"""The process that expands xacro: what runs in it, and the fences around it.

Nothing here imports more than the standard library and xacro: what a hostile file finds in its
process is as little as possible.
"""
