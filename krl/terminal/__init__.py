"""The terminal: options, progress, tables, output files, the summary of a survey."""
