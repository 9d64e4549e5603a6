"""The door: the `krl` command. It reads arguments, calls the rooms below and prints."""

__all__: list[str] = []
