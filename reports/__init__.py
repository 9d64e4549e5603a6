"""HTML pages made from the records of commands."""
