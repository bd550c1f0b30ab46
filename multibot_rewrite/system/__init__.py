"""What runs on the robots, in one form for every source: records, conventions, the file."""
