"""Motion: the advance run, motions and their queue, positions, override and braking."""
