"""`krl conform`: conformance cases, metamorphic laws and planted faults."""
