"""The page of a nightly run, its history, its failures and its summary."""
