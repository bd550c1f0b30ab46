"""Rules about what a launch file starts: its words, its simulator, its models and its nodes."""
