"""One module a command. Each imports the rooms it needs inside the command, to start quickly."""

__all__: list[str] = []
