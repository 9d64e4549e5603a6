"""Rules, cases, their expectations, and the linter of cases."""
