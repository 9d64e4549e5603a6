"""The debug adapter: debugging from editors with the Debug Adapter Protocol."""
