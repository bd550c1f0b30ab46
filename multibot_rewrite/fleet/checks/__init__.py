"""What was made is asked whether it fits together."""
