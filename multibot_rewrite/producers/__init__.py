"""Where a system is read from: one module or folder a source."""
