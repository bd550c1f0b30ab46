"""What a rewrite does to names, on records: the plan of a fleet."""
