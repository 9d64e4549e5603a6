"""The front end: from KRL text to a checked program. Nothing here runs a program."""
