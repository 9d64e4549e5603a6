"""Images checked before they run: stack effects, types, well-formedness."""
