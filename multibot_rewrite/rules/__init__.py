"""Rules that several commands ask: one a fault, whoever asks."""
