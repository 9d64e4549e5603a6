"""Native code: register code as C, compiled by the installed compiler."""
