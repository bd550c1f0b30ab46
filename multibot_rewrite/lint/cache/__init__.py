"""Results of earlier lints, kept while all that they rest on is the same."""
