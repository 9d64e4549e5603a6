"""Benchmarks of the check: its speed, and how many planted mistakes it finds."""
