"""Handlers of executors' requests: waits, motions, variables, predefined routines."""
