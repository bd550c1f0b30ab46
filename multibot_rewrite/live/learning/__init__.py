"""Running nodes -> a file of nodes and stacks with the names in their code."""
