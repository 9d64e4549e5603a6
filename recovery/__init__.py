"""The survey: what the corpus knows that the grammar does not yet."""

__all__: list[str] = []
