"""A first fleet file for descriptions: what lies beside them, what they are, what follows from it."""
