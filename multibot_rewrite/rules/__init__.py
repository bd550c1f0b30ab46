"""Rules that several commands ask."""
