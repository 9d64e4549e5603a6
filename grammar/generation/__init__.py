"""Valid programs made at random from a seed."""
