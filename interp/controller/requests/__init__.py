"""Requests of executors and their answers: waits, motions, variables, predefined routines."""
