"""Differential testing: random programs on several executors, whose traces must be equal."""
