"""What is asked about a description: for its rewrite and for the lint."""
