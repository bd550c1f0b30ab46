"""The rules: a folder a group, a file a theme. A rule is its words, its examples and its check."""
