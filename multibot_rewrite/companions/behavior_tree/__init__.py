"""Behavior trees of Nav2."""
