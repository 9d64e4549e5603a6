"""The conformance suite: rules, cases, their expectations, and the linter of cases."""
