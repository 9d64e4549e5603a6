"""What was observed of a case against what was expected; executors compared."""
