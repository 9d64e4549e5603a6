"""The instruction set: its table, the notation of stack effects, and what is generated."""
