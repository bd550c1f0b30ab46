"""What a lint is asked to report: patterns of files, comments that silence, known findings, changed files."""
