"""The bytecode verifier: well-formedness, types and stack effects are checked before a run."""
