"""The `krl` command: reads arguments, calls the packages below and prints."""
