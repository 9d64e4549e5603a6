"""The linter of cases: their form, and whether they claim more than their rules say."""
