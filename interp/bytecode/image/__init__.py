"""Bytecode as bytes: layout, reader, writer."""
