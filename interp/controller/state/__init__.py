"""The state that all parts share: clock, trace, variables, signals, messages, tasks, profile."""
