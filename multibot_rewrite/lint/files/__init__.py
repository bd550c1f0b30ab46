"""From a path to what rules look at: which files there are, how they expand, which belong together."""
