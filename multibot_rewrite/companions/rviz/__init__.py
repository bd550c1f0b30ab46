"""RViz configurations."""
