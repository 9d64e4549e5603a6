"""What every package needs and nothing here is about KRL: files, processes, measurements."""

__all__: list[str] = []
