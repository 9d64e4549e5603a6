"""Stand-ins for what an incomplete backup calls and does not hold.

==================== ===============================================================================
module               what it is
==================== ===============================================================================
`unreadable_lines`   a file with syntax errors, as a program without the lines that are wrong
`library`            routines and data that controllers and packages bring along, written by us
`unset_data`         values for data that is declared, read and never set
`uses`               what the uses of an undeclared name imply about its type
`signatures`         declarations for such names, as KRL
`completion`         a project with its stand-ins, and a list of them
==================== ===============================================================================
"""
