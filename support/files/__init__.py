"""Files of strangers read within limits, and our own files written whole or not at all."""
