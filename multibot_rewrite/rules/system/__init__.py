"""What hurts any system of several robots, planned or not: rules over a graph and its robots."""
