"""What MoveIt, an SRDF, a bridge and lists of parameters name, against what the same robot has."""
