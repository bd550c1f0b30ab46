"""Findings as text, JSON, SARIF, GitHub annotations, GitLab code quality, JUnit, Markdown."""
