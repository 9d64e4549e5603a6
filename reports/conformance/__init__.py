"""Pages of a conformance run and of the paper's claims."""
