"""Programs for who works on this repository: tables from sources, and pages. Not installed."""
