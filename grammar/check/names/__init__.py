"""Names: undeclared, declared twice, and the certainty of unknown names over a project."""
