"""Support for unit tests of robot programs: drivers that call routines, stand-ins, coverage."""
