"""Benchmarks of executors, arm and real programs."""
