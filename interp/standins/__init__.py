"""Stand-ins for what an incomplete backup uses and does not contain.

==================== ===============================================================================
module               contents
==================== ===============================================================================
`unreadable_lines`   runs a file with syntax errors without the wrong lines
`library`            our versions of routines and data that controllers and packages provide
`unset_data`         values for data that are declared and read, but never set
`uses`               facts about undeclared names
`use_reader`         reads these facts from the uses of the names in a file
`signatures`         writes declarations for such names in KRL
`completion`         completes a project with stand-ins, and lists them
==================== ===============================================================================
"""
