"""Files: untrusted input read within limits, results kept, output written whole or not at all."""
