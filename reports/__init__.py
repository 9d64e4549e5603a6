"""Pages that people read, made from records."""
