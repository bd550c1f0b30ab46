"""Launch files: the one that is written, and those that a fleet names."""
