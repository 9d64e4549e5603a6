"""How fast the survey is, and how well it finds damage done to a grammar on purpose."""
