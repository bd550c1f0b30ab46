"""``multibot doctor``: a graph without a plan -> its robots, as far as they show, and their plan."""
