"""One module a command. Each imports what it needs inside the command, to start quickly."""
