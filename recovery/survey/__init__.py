"""Every file of a corpus read under one grammar, and what could not be read."""
