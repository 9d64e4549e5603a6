"""Running programs: the program a file means, options of a run, what is said of a finished one."""
