"""Control flow and data flow in a routine and across files, and stops of the advance run."""
