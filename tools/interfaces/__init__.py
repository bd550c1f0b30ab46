"""What the nodes of public packages declare, read from their sources: publishers, services, tf."""
