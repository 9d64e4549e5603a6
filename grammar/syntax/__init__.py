"""The abstract syntax tree of KRL: built from parse trees, walked, printed, formatted."""
