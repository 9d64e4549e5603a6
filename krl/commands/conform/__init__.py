"""`krl conform`: cases, metamorphic laws and planted faults."""
