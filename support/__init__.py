"""Code that every package needs and that does not depend on KRL: files, processes, measurement."""
