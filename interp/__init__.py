"""The cell: a checked program goes in, a trace comes out.

Two interpreters of different construction, a tree interpreter and a bytecode machine, will stand
here, with the controller that they share (clock, advance run, interrupts, triggers, submit) and the
simulated arm that it moves. Nothing of it is built yet.
"""

__all__: list[str] = []
