"""State: clock, trace, variables, signals, messages, tasks, profile: what all parts share."""
