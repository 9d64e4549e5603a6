"""The language: from text to a checked program. Knows nothing of running it."""
