"""Control flow and data flow: through a routine, across files, and what stops the advance run."""
