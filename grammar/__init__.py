"""The language: text to checked program. Knows nothing of running it."""

__all__: list[str] = []
