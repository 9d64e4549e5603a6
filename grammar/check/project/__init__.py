"""All checks, run over a file, a project or a backup; suppressing, keeping and mending."""
