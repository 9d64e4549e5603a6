"""The values of KRL: operators, built-in functions, text forms, faults, frames."""
