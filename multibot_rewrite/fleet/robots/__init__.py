"""The robots of a fleet: their descriptions, nodes and places."""
