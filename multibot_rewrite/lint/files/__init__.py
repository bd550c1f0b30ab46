"""From a path to what rules look at: which files there are, how they expand and which belong together."""
