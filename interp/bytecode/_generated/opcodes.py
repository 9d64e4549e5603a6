"""The opcodes.

Made from interp/bytecode/instructions.tsv by python -m interp.bytecode.instruction_set --write.
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
    PASS_VIEW = 40
    ROW = 41
    ROW_VIEW = 42
    COPY = 43
    CLEAR = 44
    FILL_POSE = 45
    FILL_ARRAY = 46
    COPY_VIEW = 47
    SET_TEXT = 48
    ADD_INT = 49
    SUB_INT = 50
    MUL_INT = 51
    DIV_INT = 52
    NEG_INT = 53
    ADD_REAL = 54
    SUB_REAL = 55
    MUL_REAL = 56
    DIV_REAL = 57
    NEG_REAL = 58
    EQ_INT = 59
    NE_INT = 60
    LT_INT = 61
    GT_INT = 62
    LE_INT = 63
    GE_INT = 64
    EQ_REAL = 65
    NE_REAL = 66
    LT_REAL = 67
    GT_REAL = 68
    LE_REAL = 69
    GE_REAL = 70
    EQ_BOOL = 71
    NE_BOOL = 72
    EQ_ENUM = 73
    NE_ENUM = 74
    NOT_BOOL = 75
    AND_BOOL = 76
    OR_BOOL = 77
    EXOR_BOOL = 78
    NOT_BITS = 79
    AND_BITS = 80
    OR_BITS = 81
    EXOR_BITS = 82
    COMPOSE = 83
    INT_TO_REAL = 84
    REAL_TO_INT = 85
    CHAR_TO_INT = 86
    INT_TO_CHAR = 87
    ADD_CONSTANT = 88
    UNLESS_EQ_INT = 89
    UNLESS_NE_INT = 90
    UNLESS_LT_INT = 91
    UNLESS_GT_INT = 92
    UNLESS_LE_INT = 93
    UNLESS_GE_INT = 94
    UNLESS_LT_REAL = 95
    UNLESS_GT_REAL = 96
    UNLESS_LE_REAL = 97
    UNLESS_GE_REAL = 98
    FOR_LOCAL = 99
    FOR_DATA = 100
    TELL_LOCAL = 101
    TELL_DATA = 102
    TELL_REF = 103
    TELL = 104
    TELL_BRANCH = 105
    PASS_LOCAL = 106
