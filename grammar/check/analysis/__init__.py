"""Analyses that checks share: names in scope, types, constants, accesses, the flow graph."""
