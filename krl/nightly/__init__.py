"""A nightly run: its steps, each a command within limits, and the report on all of them."""
