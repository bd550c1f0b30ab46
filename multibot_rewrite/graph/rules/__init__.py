"""The rules of the check, and the look-ups they share; all pure."""
