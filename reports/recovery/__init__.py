"""Pages of the recovery of a grammar: survey, growth, automatic recovery."""
