"""Names: not declared, declared twice, and how unknown ones are graded over a project."""
