"""Where a description comes from."""
