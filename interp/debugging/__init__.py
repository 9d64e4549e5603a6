"""Debugging on every executor: stops, steps, watches, changes, block selection, going back."""
