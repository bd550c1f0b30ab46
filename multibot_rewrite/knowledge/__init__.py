"""What is known of nodes of public packages: data by family, one reader for all of it."""
