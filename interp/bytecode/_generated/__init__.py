"""Made from ``instructions.tsv`` by ``python -m interp.bytecode.isa --write``; do not edit."""
