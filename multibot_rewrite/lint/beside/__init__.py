"""Files beside a description: what they are, and what is wrong in them."""
