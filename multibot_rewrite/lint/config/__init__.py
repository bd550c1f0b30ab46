"""What a lint is asked to report: patterns of files, ignore comments, known findings, changed files."""
