"""What every check reports, and the rules that the reports come from."""
