"""The page of a conformance run and the page of the paper's claims."""
