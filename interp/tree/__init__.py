"""The tree interpreter: the readable reference executor, in which each routine is a generator."""
