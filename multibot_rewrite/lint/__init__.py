"""Findings about robot descriptions: a file -> subjects -> rules -> findings -> a report."""
