"""The rules of ``multibot check``, and the look-ups they share; all pure."""
