"""`krl construct`: constructs on their way into the grammar."""
