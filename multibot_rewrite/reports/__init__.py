"""What is told of a description beside its rewrite."""
