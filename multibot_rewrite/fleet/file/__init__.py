"""The fleet file and what it names, as records."""
