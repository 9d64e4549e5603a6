"""The controller: clock, advance run, motion queue, interrupts, triggers, submit, variables."""
