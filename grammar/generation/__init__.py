"""Random valid KRL programs, reproducible from a seed."""
