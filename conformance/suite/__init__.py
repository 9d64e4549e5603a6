"""The conformance suite: rules, cases, and their expectations."""
