"""`krl construct`: constructs, which extend the grammar."""
