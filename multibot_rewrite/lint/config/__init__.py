"""What to lint and report: settings and their file, ignore comments, known findings, changed files."""
