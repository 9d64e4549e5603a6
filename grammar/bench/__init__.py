"""The check measured: how fast it is, and how many planted mistakes it finds."""
