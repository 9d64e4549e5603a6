"""The debugger for every executor: stops, steps, watches, changes, block selection, going back."""
