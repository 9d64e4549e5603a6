"""Stand-ins for what an incomplete backup uses and does not contain.

==================== ===============================================================================
module               contents
==================== ===============================================================================
`unreadable_lines`   runs a file with syntax errors without the wrong lines
`library`            our versions of routines and data that controllers and packages provide
`unset_data`         values for data that are declared and read, but never set
`uses`               infers the type of an undeclared name from its uses
`signatures`         writes declarations for such names in KRL
`completion`         completes a project with stand-ins, and lists them
==================== ===============================================================================
"""
