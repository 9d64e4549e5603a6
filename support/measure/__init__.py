"""What a function costs: time and memory in a process of its own."""
