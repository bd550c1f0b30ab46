"""One system: what runs on some robots, and whose each of its names is."""
