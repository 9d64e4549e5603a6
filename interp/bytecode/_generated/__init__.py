"""Made from ``instructions.tsv`` (``python -m interp.bytecode.instruction_set``); do not edit."""
