"""The `krl` command: reads arguments, calls the packages below and prints."""

__all__: list[str] = []
