"""Reports about a description: changes, explanations, coverage and suggested vocabulary."""
