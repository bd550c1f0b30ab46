"""Checks of a description that both the rewrite and the lint run."""
