"""Remap tables: the remap rules and resolved names of every node of every robot, in several formats."""
