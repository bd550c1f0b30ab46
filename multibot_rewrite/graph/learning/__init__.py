"""Running nodes -> what their code asks for, as a file of nodes and stacks."""
