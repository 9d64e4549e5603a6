"""Measuring the cost of a function: time and memory in a separate process."""
