"""MoveIt's files."""
