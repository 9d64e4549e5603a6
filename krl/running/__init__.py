"""Running programs: loading, options, notes and pictures of a finished run."""
