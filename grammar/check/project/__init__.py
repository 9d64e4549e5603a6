"""Runs all checks over a file, a project or a backup; suppression, caching and repair."""
