"""What runs on top of a program: interrupt routines, calls of triggers, cyclic evaluation."""
