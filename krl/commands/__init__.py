"""The commands, one module each. Imports are inside the functions, so that `krl` starts fast."""
