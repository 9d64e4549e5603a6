"""Speed of the survey, and how well it finds damage done to a grammar on purpose."""
