"""The opcodes.

Made from interp/bytecode/instructions.tsv by python -m interp.bytecode.isa --write.
"""

from enum import IntEnum

__all__ = ["Op"]


class Op(IntEnum):
    """The opcodes by name; what they do stands in the table that this is made from."""

    LINE = 0
    AT = 1
    JUMP = 2
    JUMP_IF = 3
    JUMP_UNLESS = 4
    CASE = 5
    CALL = 6
    RETURN = 7
    RETURN_VALUE = 8
    ASK = 9
    BUILTIN = 10
    PROCEED = 11
    FAIL = 12
    UNLINKED = 13
    PUSH_INT = 14
    PUSH_REAL = 15
    PUSH_BOOL = 16
    PUSH_CHAR = 17
    PUSH_ENUM = 18
    PUSH_NOTHING = 19
    PUSH_NO_VIEW = 20
    DROP = 21
    LOAD_LOCAL = 22
    LOAD_DATA = 23
    STORE_LOCAL = 24
    STORE_DATA = 25
    REF_LOCAL = 26
    REF_DATA = 27
    LOAD_REF = 28
    LOAD = 29
    STORE = 30
    MEMBER = 31
    INDEX = 32
    INDEX_LOCAL = 33
    INDEX_DATA = 34
    INDEX_VIEW = 35
    ELEMENT_LOCAL = 36
    ELEMENT_DATA = 37
    VIEW = 38
    LOAD_VIEW = 39
    ROW = 40
    ROW_VIEW = 41
    COPY = 42
    CLEAR = 43
    FILL_POSE = 44
    FILL_ARRAY = 45
    SET_TEXT = 46
    ADD_INT = 47
    SUB_INT = 48
    MUL_INT = 49
    DIV_INT = 50
    NEG_INT = 51
    ADD_REAL = 52
    SUB_REAL = 53
    MUL_REAL = 54
    DIV_REAL = 55
    NEG_REAL = 56
    EQ_INT = 57
    NE_INT = 58
    LT_INT = 59
    GT_INT = 60
    LE_INT = 61
    GE_INT = 62
    EQ_REAL = 63
    NE_REAL = 64
    LT_REAL = 65
    GT_REAL = 66
    LE_REAL = 67
    GE_REAL = 68
    EQ_BOOL = 69
    NE_BOOL = 70
    EQ_ENUM = 71
    NE_ENUM = 72
    NOT_BOOL = 73
    AND_BOOL = 74
    OR_BOOL = 75
    EXOR_BOOL = 76
    NOT_BITS = 77
    AND_BITS = 78
    OR_BITS = 79
    EXOR_BITS = 80
    COMPOSE = 81
    INT_TO_REAL = 82
    REAL_TO_INT = 83
    CHAR_TO_INT = 84
    INT_TO_CHAR = 85
    ADD_CONSTANT = 86
    UNLESS_EQ_INT = 87
    UNLESS_NE_INT = 88
    UNLESS_LT_INT = 89
    UNLESS_GT_INT = 90
    UNLESS_LE_INT = 91
    UNLESS_GE_INT = 92
    UNLESS_LT_REAL = 93
    UNLESS_GT_REAL = 94
    UNLESS_LE_REAL = 95
    UNLESS_GE_REAL = 96
    FOR_LOCAL = 97
    FOR_DATA = 98
    TELL_LOCAL = 99
    TELL_DATA = 100
    TELL_REF = 101
    TELL = 102
    TELL_BRANCH = 103
