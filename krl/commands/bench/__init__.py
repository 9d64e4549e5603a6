"""`krl bench`: figures of the tools themselves."""
