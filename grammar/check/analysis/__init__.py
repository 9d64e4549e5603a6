"""Analyses that several checks use: names in scope, types, constants, accesses, flow graph."""
