"""A description: its text read, checked, rewritten and proved."""
