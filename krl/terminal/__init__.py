"""Terminal output and shared options: progress, tables, output files, survey summary."""
