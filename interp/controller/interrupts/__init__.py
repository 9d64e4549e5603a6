"""What runs on top of a program: interrupt routines, actions of triggers, cyclic evaluation."""
