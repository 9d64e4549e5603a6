"""Inputs: scripts, channels, the operator, and inputs that change by themselves."""
