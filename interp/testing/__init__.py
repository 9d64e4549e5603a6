"""What unit tests of robot programs need of a run: routines called, stood in for, and covered."""
