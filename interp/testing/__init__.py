"""Runs of unit tests of robot programs: calls of routines, stand-ins, coverage."""
