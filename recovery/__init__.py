"""Grammar recovery: what a corpus shows that the grammar does not have yet."""
