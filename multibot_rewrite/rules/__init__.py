"""What is asked of a system, and of a plan beside it: one rule a fault, whoever asks."""
