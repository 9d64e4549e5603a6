"""What checks ask about a file: names in scope, types, constants, accesses, the flow graph."""
