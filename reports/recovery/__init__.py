"""Pages about the recovery of a grammar: survey, growth, automatic recovery."""
