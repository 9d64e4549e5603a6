"""The debug adapter: a debugger for editors, by the Debug Adapter Protocol."""
