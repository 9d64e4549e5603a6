"""Files: limits for untrusted input, caches, atomic writes."""
