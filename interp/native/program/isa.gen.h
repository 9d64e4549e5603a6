/* Made from interp/bytecode/instructions.tsv by python -m interp.bytecode.instruction_set --write. */
#ifndef KRL_ISA_GEN_H
#define KRL_ISA_GEN_H

#define KRL_IMAGE_MAGIC "KRLI"
#define KRL_IMAGE_FORMAT 4
#define KRL_MAX_CELLS 1048576

/* X(name, number of operands, place of a target or -1), in the order of the opcodes. */
#define KRL_OPCODES(X) \
    X(LINE, 2, 1) \
    X(AT, 2, 1) \
    X(JUMP, 1, 0) \
    X(JUMP_IF, 1, 0) \
    X(JUMP_UNLESS, 1, 0) \
    X(CASE, 2, 1) \
    X(CALL, 1, -1) \
    X(RETURN, 0, -1) \
    X(RETURN_VALUE, 0, -1) \
    X(ASK, 1, -1) \
    X(BUILTIN, 1, -1) \
    X(PROCEED, 0, -1) \
    X(FAIL, 1, -1) \
    X(UNLINKED, 1, -1) \
    X(PUSH_INT, 1, -1) \
    X(PUSH_REAL, 1, -1) \
    X(PUSH_BOOL, 1, -1) \
    X(PUSH_CHAR, 1, -1) \
    X(PUSH_ENUM, 2, -1) \
    X(PUSH_NOTHING, 0, -1) \
    X(PUSH_NO_VIEW, 2, -1) \
    X(DROP, 0, -1) \
    X(LOAD_LOCAL, 1, -1) \
    X(LOAD_DATA, 1, -1) \
    X(STORE_LOCAL, 1, -1) \
    X(STORE_DATA, 1, -1) \
    X(REF_LOCAL, 2, -1) \
    X(REF_DATA, 2, -1) \
    X(LOAD_REF, 1, -1) \
    X(LOAD, 0, -1) \
    X(STORE, 0, -1) \
    X(MEMBER, 2, -1) \
    X(INDEX, 1, -1) \
    X(INDEX_LOCAL, 2, -1) \
    X(INDEX_DATA, 2, -1) \
    X(INDEX_VIEW, 1, -1) \
    X(ELEMENT_LOCAL, 2, -1) \
    X(ELEMENT_DATA, 2, -1) \
    X(VIEW, 1, -1) \
    X(LOAD_VIEW, 1, -1) \
    X(PASS_VIEW, 1, -1) \
    X(ROW, 2, -1) \
    X(ROW_VIEW, 2, -1) \
    X(COPY, 1, -1) \
    X(CLEAR, 1, -1) \
    X(FILL_POSE, 2, -1) \
    X(FILL_ARRAY, 2, -1) \
    X(COPY_VIEW, 2, -1) \
    X(SET_TEXT, 1, -1) \
    X(ADD_INT, 0, -1) \
    X(SUB_INT, 0, -1) \
    X(MUL_INT, 0, -1) \
    X(DIV_INT, 0, -1) \
    X(NEG_INT, 0, -1) \
    X(ADD_REAL, 0, -1) \
    X(SUB_REAL, 0, -1) \
    X(MUL_REAL, 0, -1) \
    X(DIV_REAL, 0, -1) \
    X(NEG_REAL, 0, -1) \
    X(EQ_INT, 0, -1) \
    X(NE_INT, 0, -1) \
    X(LT_INT, 0, -1) \
    X(GT_INT, 0, -1) \
    X(LE_INT, 0, -1) \
    X(GE_INT, 0, -1) \
    X(EQ_REAL, 0, -1) \
    X(NE_REAL, 0, -1) \
    X(LT_REAL, 0, -1) \
    X(GT_REAL, 0, -1) \
    X(LE_REAL, 0, -1) \
    X(GE_REAL, 0, -1) \
    X(EQ_BOOL, 0, -1) \
    X(NE_BOOL, 0, -1) \
    X(EQ_ENUM, 0, -1) \
    X(NE_ENUM, 0, -1) \
    X(NOT_BOOL, 0, -1) \
    X(AND_BOOL, 0, -1) \
    X(OR_BOOL, 0, -1) \
    X(EXOR_BOOL, 0, -1) \
    X(NOT_BITS, 0, -1) \
    X(AND_BITS, 0, -1) \
    X(OR_BITS, 0, -1) \
    X(EXOR_BITS, 0, -1) \
    X(COMPOSE, 2, -1) \
    X(INT_TO_REAL, 0, -1) \
    X(REAL_TO_INT, 0, -1) \
    X(CHAR_TO_INT, 0, -1) \
    X(INT_TO_CHAR, 0, -1) \
    X(ADD_CONSTANT, 1, -1) \
    X(UNLESS_EQ_INT, 1, 0) \
    X(UNLESS_NE_INT, 1, 0) \
    X(UNLESS_LT_INT, 1, 0) \
    X(UNLESS_GT_INT, 1, 0) \
    X(UNLESS_LE_INT, 1, 0) \
    X(UNLESS_GE_INT, 1, 0) \
    X(UNLESS_LT_REAL, 1, 0) \
    X(UNLESS_GT_REAL, 1, 0) \
    X(UNLESS_LE_REAL, 1, 0) \
    X(UNLESS_GE_REAL, 1, 0) \
    X(FOR_LOCAL, 4, 3) \
    X(FOR_DATA, 4, 3) \
    X(TELL_LOCAL, 2, -1) \
    X(TELL_DATA, 2, -1) \
    X(TELL_REF, 3, -1) \
    X(TELL, 2, -1) \
    X(TELL_BRANCH, 1, -1) \
    X(PASS_LOCAL, 1, -1) \

enum krl_opcode {
    KRL_LINE = 0, /* -- */
    KRL_AT = 1, /* -- */
    KRL_JUMP = 2, /* -- */
    KRL_JUMP_IF = 3, /* BOOL -- */
    KRL_JUMP_UNLESS = 4, /* BOOL -- */
    KRL_CASE = 5, /* like(constant) -- t */
    KRL_CALL = 6, /* arguments(code) -- result(code) */
    KRL_RETURN = 7, /* -- */
    KRL_RETURN_VALUE = 8, /* own_result() -- */
    KRL_ASK = 9, /* request(entry) -- reply(entry) */
    KRL_BUILTIN = 10, /* inputs(entry) -- output(entry) */
    KRL_PROCEED = 11, /* -- */
    KRL_FAIL = 12, /* -- */
    KRL_UNLINKED = 13, /* -- */
    KRL_PUSH_INT = 14, /* -- INT */
    KRL_PUSH_REAL = 15, /* -- REAL */
    KRL_PUSH_BOOL = 16, /* -- BOOL */
    KRL_PUSH_CHAR = 17, /* -- CHAR */
    KRL_PUSH_ENUM = 18, /* -- type */
    KRL_PUSH_NOTHING = 19, /* -- nothing */
    KRL_PUSH_NO_VIEW = 20, /* -- [element,rank]? */
    KRL_DROP = 21, /* t -- */
    KRL_LOAD_LOCAL = 22, /* -- cell */
    KRL_LOAD_DATA = 23, /* -- cell */
    KRL_STORE_LOCAL = 24, /* cell -- */
    KRL_STORE_DATA = 25, /* cell -- */
    KRL_REF_LOCAL = 26, /* -- @type */
    KRL_REF_DATA = 27, /* -- @type */
    KRL_LOAD_REF = 28, /* -- @parameter */
    KRL_LOAD = 29, /* @t -- t */
    KRL_STORE = 30, /* @t t -- */
    KRL_MEMBER = 31, /* whole(offset,type) -- @type */
    KRL_INDEX = 32, /* @array INT*array -- @array[] */
    KRL_INDEX_LOCAL = 33, /* INT*array -- @array[] */
    KRL_INDEX_DATA = 34, /* INT*array -- @array[] */
    KRL_INDEX_VIEW = 35, /* INT*view -- @view[] */
    KRL_ELEMENT_LOCAL = 36, /* INT*array -- array[] */
    KRL_ELEMENT_DATA = 37, /* INT*array -- array[] */
    KRL_VIEW = 38, /* @array -- [array] */
    KRL_LOAD_VIEW = 39, /* -- [view] */
    KRL_PASS_VIEW = 40, /* -- [view]? */
    KRL_ROW = 41, /* @array INT*count -- [array/count] */
    KRL_ROW_VIEW = 42, /* INT*count -- [view/count] */
    KRL_COPY = 43, /* @type @type -- */
    KRL_CLEAR = 44, /* @type -- */
    KRL_FILL_POSE = 45, /* @to @of -- */
    KRL_FILL_ARRAY = 46, /* [element,rank] [element,rank] -- */
    KRL_COPY_VIEW = 47, /* [array] -- [array] */
    KRL_SET_TEXT = 48, /* letters -- */
    KRL_ADD_INT = 49, /* INT INT -- INT */
    KRL_SUB_INT = 50, /* INT INT -- INT */
    KRL_MUL_INT = 51, /* INT INT -- INT */
    KRL_DIV_INT = 52, /* INT INT -- INT */
    KRL_NEG_INT = 53, /* INT -- INT */
    KRL_ADD_REAL = 54, /* REAL REAL -- REAL */
    KRL_SUB_REAL = 55, /* REAL REAL -- REAL */
    KRL_MUL_REAL = 56, /* REAL REAL -- REAL */
    KRL_DIV_REAL = 57, /* REAL REAL -- REAL */
    KRL_NEG_REAL = 58, /* REAL -- REAL */
    KRL_EQ_INT = 59, /* INT INT -- BOOL */
    KRL_NE_INT = 60, /* INT INT -- BOOL */
    KRL_LT_INT = 61, /* INT INT -- BOOL */
    KRL_GT_INT = 62, /* INT INT -- BOOL */
    KRL_LE_INT = 63, /* INT INT -- BOOL */
    KRL_GE_INT = 64, /* INT INT -- BOOL */
    KRL_EQ_REAL = 65, /* REAL REAL -- BOOL */
    KRL_NE_REAL = 66, /* REAL REAL -- BOOL */
    KRL_LT_REAL = 67, /* REAL REAL -- BOOL */
    KRL_GT_REAL = 68, /* REAL REAL -- BOOL */
    KRL_LE_REAL = 69, /* REAL REAL -- BOOL */
    KRL_GE_REAL = 70, /* REAL REAL -- BOOL */
    KRL_EQ_BOOL = 71, /* BOOL BOOL -- BOOL */
    KRL_NE_BOOL = 72, /* BOOL BOOL -- BOOL */
    KRL_EQ_ENUM = 73, /* ENUM ENUM -- BOOL */
    KRL_NE_ENUM = 74, /* ENUM ENUM -- BOOL */
    KRL_NOT_BOOL = 75, /* BOOL -- BOOL */
    KRL_AND_BOOL = 76, /* BOOL BOOL -- BOOL */
    KRL_OR_BOOL = 77, /* BOOL BOOL -- BOOL */
    KRL_EXOR_BOOL = 78, /* BOOL BOOL -- BOOL */
    KRL_NOT_BITS = 79, /* INT -- INT */
    KRL_AND_BITS = 80, /* INT INT -- INT */
    KRL_OR_BITS = 81, /* INT INT -- INT */
    KRL_EXOR_BITS = 82, /* INT INT -- INT */
    KRL_COMPOSE = 83, /* @right @left @right -- */
    KRL_INT_TO_REAL = 84, /* INT -- REAL */
    KRL_REAL_TO_INT = 85, /* REAL -- INT */
    KRL_CHAR_TO_INT = 86, /* CHAR -- INT */
    KRL_INT_TO_CHAR = 87, /* INT -- CHAR */
    KRL_ADD_CONSTANT = 88, /* INT -- INT */
    KRL_UNLESS_EQ_INT = 89, /* INT INT -- */
    KRL_UNLESS_NE_INT = 90, /* INT INT -- */
    KRL_UNLESS_LT_INT = 91, /* INT INT -- */
    KRL_UNLESS_GT_INT = 92, /* INT INT -- */
    KRL_UNLESS_LE_INT = 93, /* INT INT -- */
    KRL_UNLESS_GE_INT = 94, /* INT INT -- */
    KRL_UNLESS_LT_REAL = 95, /* REAL REAL -- */
    KRL_UNLESS_GT_REAL = 96, /* REAL REAL -- */
    KRL_UNLESS_LE_REAL = 97, /* REAL REAL -- */
    KRL_UNLESS_GE_REAL = 98, /* REAL REAL -- */
    KRL_FOR_LOCAL = 99, /* -- */
    KRL_FOR_DATA = 100, /* -- */
    KRL_TELL_LOCAL = 101, /* -- */
    KRL_TELL_DATA = 102, /* -- */
    KRL_TELL_REF = 103, /* -- */
    KRL_TELL = 104, /* -- */
    KRL_TELL_BRANCH = 105, /* -- */
    KRL_PASS_LOCAL = 106, /* -- cell? */
    KRL_OPCODE_COUNT = 107
};

/* Whether execution never continues with the next instruction. */
static inline int krl_ends(uint32_t op)
{
    return op == KRL_JUMP || op == KRL_RETURN || op == KRL_RETURN_VALUE || op == KRL_FAIL || op == KRL_UNLINKED;
}

/* The catalogue of faults. */
enum krl_fault {
    KRL_FAULT_DIVISION_BY_ZERO = 0,
    KRL_FAULT_OVERFLOW = 1,
    KRL_FAULT_DOMAIN = 2,
    KRL_FAULT_INDEX = 3,
    KRL_FAULT_UNINITIALISED = 4,
    KRL_FAULT_STACK = 5,
    KRL_FAULT_NESTING = 6,
    KRL_FAULT_INVALID = 7,
    KRL_FAULT_INADMISSIBLE = 8,
    KRL_FAULT_READ_ONLY = 9,
    KRL_FAULT_OPERAND = 10,
    KRL_FAULT_ARGUMENT = 11,
    KRL_FAULT_NO_RESULT = 12,
    KRL_FAULT_COUNT = 13
};

/* As how many statements functions count. */
enum krl_weight {
    KRL_WEIGHT_COMPOSE = 64,
    KRL_WEIGHT_FRAND = 30,
    KRL_WEIGHT_INV_POS = 138,
    KRL_WEIGHT_SREAD = 160,
    KRL_WEIGHT_STRADD = 52,
    KRL_WEIGHT_STRCLEAR = 32,
    KRL_WEIGHT_STRCOMP = 52,
    KRL_WEIGHT_STRCOPY = 68,
    KRL_WEIGHT_STRDECLLEN = 26,
    KRL_WEIGHT_STRFIND = 62,
    KRL_WEIGHT_STRLEN = 40,
    KRL_WEIGHT_STRTOAXIS = 82,
    KRL_WEIGHT_STRTOBOOL = 24,
    KRL_WEIGHT_STRTOE3AXIS = 102,
    KRL_WEIGHT_STRTOE3POS = 124,
    KRL_WEIGHT_STRTOE6AXIS = 120,
    KRL_WEIGHT_STRTOE6POS = 124,
    KRL_WEIGHT_STRTOFRAME = 84,
    KRL_WEIGHT_STRTOINT = 24,
    KRL_WEIGHT_STRTOPOS = 92,
    KRL_WEIGHT_STRTOREAL = 28,
    KRL_WEIGHT_STRTOSTRING = 40,
    KRL_WEIGHT_SWRITE = 210,
    KRL_WEIGHT_VARSTATE = 28,
    KRL_WEIGHT_VARTYPE = 38,
};

#endif
