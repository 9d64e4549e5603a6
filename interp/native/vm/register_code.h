/* The register code that code objects are translated into.
 *
 * The comments describe each step. `a`, `b`, `c` and `d` are registers where nothing else is said;
 * `*a` is the cell at the address in `a`. A step whose name ends in K has a constant instead of its
 * last operand: a number, or the bits of a cell with its tag in `tag`. "own frame" is the size of
 * the caller's variables, "array" an index in the table of arrays.
 */
#ifndef KRL_REGISTER_CODE_H
#define KRL_REGISTER_CODE_H

#define KRL_COMPARISONS(X) X(EQ, ==) X(NE, !=) X(LT, <) X(GT, >) X(LE, <=) X(GE, >=)

/* Jumps: steps that may continue at the target d. */
#define KRL_JUMPS(X)                                                                               \
    X(JUMP) X(JUMP_IF) X(JUMP_UNLESS) /* JUMP_IF and JUMP_UNLESS: the BOOL b */                    \
    X(CASE) /* if b equals the constant c */                                                       \
    X(UNLESS_EQ_INT) X(UNLESS_NE_INT) X(UNLESS_LT_INT) X(UNLESS_GT_INT)                            \
    X(UNLESS_LE_INT) X(UNLESS_GE_INT) X(UNLESS_EQ_INT_K) X(UNLESS_NE_INT_K)                        \
    X(UNLESS_LT_INT_K) X(UNLESS_GT_INT_K) X(UNLESS_LE_INT_K) X(UNLESS_GE_INT_K)                    \
    X(UNLESS_EQ_REAL) X(UNLESS_NE_REAL) X(UNLESS_LT_REAL) X(UNLESS_GT_REAL)                        \
    X(UNLESS_LE_REAL) X(UNLESS_GE_REAL) X(UNLESS_EQ_REAL_K) X(UNLESS_NE_REAL_K)                    \
    X(UNLESS_LT_REAL_K) X(UNLESS_GT_REAL_K) X(UNLESS_LE_REAL_K) X(UNLESS_GE_REAL_K)                \
    X(FOR_UP) X(FOR_DOWN)             /* counter a, limit b, constant step c */                    \
    X(FOR_DATA_UP) X(FOR_DATA_DOWN)   /* the counter is cell a of the data lists */                \
    X(TEXT)                           /* function tag, inputs from a on, entry b; skips the step for Python */

/* Comparisons of b and c, which store a BOOL in a; in the order of the UNLESS steps. */
#define KRL_RELATIONS(X)                                                                           \
    X(EQ_INT) X(NE_INT) X(LT_INT) X(GT_INT) X(LE_INT) X(GE_INT)                                    \
    X(EQ_INT_K) X(NE_INT_K) X(LT_INT_K) X(GT_INT_K) X(LE_INT_K) X(GE_INT_K)                        \
    X(EQ_REAL) X(NE_REAL) X(LT_REAL) X(GT_REAL) X(LE_REAL) X(GE_REAL)                              \
    X(EQ_REAL_K) X(NE_REAL_K) X(LT_REAL_K) X(GT_REAL_K) X(LE_REAL_K) X(GE_REAL_K)

/* Steps that neither call nor leave. */
#define KRL_ORDINARY_STEPS(X)                                                                               \
    KRL_JUMPS(X)                                                                                   \
    KRL_RELATIONS(X)                                                                               \
    X(NOP)                                                                                         \
    X(MOVE) X(SET_K)                     /* a = b; a = the bits b */                               \
    X(PASS)                              /* a = b, which may have no value */                      \
    X(GET_DATA) X(PUT_DATA) X(PUT_DATA_K) /* a = cell b; cell a = b; cell a = the bits b */        \
    X(REFER)                             /* a = the address of b */                                \
    X(OFFSET)                            /* a = the address b, plus c cells */                     \
    X(LOAD) X(STORE) X(STORE_K)          /* a = *b; *a = b; *a = the bits b */                     \
    X(INDEX_LOCAL) X(INDEX_DATA)         /* a = the address of element b of d, from cell c on */   \
    X(GET_LOCAL) X(GET_ELEMENT_DATA)     /* a = the element */                                     \
    X(PUT_LOCAL) X(PUT_ELEMENT_DATA)     /* the element = a */                                     \
    X(PUT_LOCAL_K) X(PUT_ELEMENT_DATA_K)                                                           \
    X(INDEX_WIDE_LOCAL) X(INDEX_WIDE_DATA) /* the same in array c, with elements of several cells */ \
    X(GET_WIDE_LOCAL) X(GET_WIDE_DATA)                                                             \
    X(PUT_WIDE_LOCAL) X(PUT_WIDE_DATA)                                                             \
    X(INDEX_TWO_LOCAL) X(INDEX_TWO_DATA) /* the same in array c, with indices b and d */           \
    X(GET_TWO_LOCAL) X(GET_TWO_DATA)                                                               \
    X(PUT_TWO_LOCAL) X(PUT_TWO_DATA)                                                               \
    X(INDEX_THREE_LOCAL) X(INDEX_THREE_DATA) /* the same in array c, with a third index in a register that c names */ \
    X(GET_THREE_LOCAL) X(GET_THREE_DATA)                                                           \
    X(PUT_THREE_LOCAL) X(PUT_THREE_DATA)                                                           \
    X(INDEX_VIEW)     /* a = the address of element b of view c, d cells each */                   \
    X(INDEX_VIEW_TWO) /* the same with indices b and d, tag cells each */                          \
    X(GET_VIEW) X(GET_VIEW_TWO) /* a = the element */                                              \
    X(ROW)            /* row of array c at address a, by b indices after it: a view from a on */   \
    X(ROW_VIEW)       /* row of view c, by b indices from a on; d cells each, tag dimensions */    \
    X(COPY) X(CLEAR)  /* *a = *b, c cells; *a loses its value, c cells */                          \
    X(FILL_POSE)      /* *a = *b, c cells; d of them in common, the others lose their values */    \
    X(FILL_ARRAY)     /* view a = view b, c cells each, d dimensions */                            \
    X(COPY_VIEW)      /* copies view a to b on, c cells at most, and refers to that; d cells each, tag dimensions */ \
    X(SET_TEXT)       /* view a = text b */                                                        \
    X(COMPOSE)        /* *a = *b:*c, d cells */                                                    \
    X(INVERT)         /* *b = the inverse of *a, c cells */                                        \
    X(ADD_INT) X(SUB_INT) X(MUL_INT) X(DIV_INT) X(ADD_INT_K) X(MUL_INT_K) X(DIV_INT_K)             \
    X(NEG_INT) X(NOT_BITS) X(AND_BITS) X(OR_BITS) X(EXOR_BITS) X(AND_BITS_K)                       \
    X(ADD_REAL) X(SUB_REAL) X(MUL_REAL) X(DIV_REAL)                                                \
    X(ADD_REAL_K) X(SUB_REAL_K) X(MUL_REAL_K) X(DIV_REAL_K) X(NEG_REAL)                            \
    X(NOT_BOOL) X(AND_BOOL) X(OR_BOOL) X(EXOR_BOOL)                                                \
    X(INT_TO_REAL) X(REAL_TO_INT) X(INT_TO_CHAR) /* a = b, converted */                            \
    X(FUNCTION)          /* a = function tag of b and c */                                         \
    X(CHECK_CALL)        /* faults where a call of routine b would; own frame c */                 \
    X(FAIL)              /* faults with code b */                                                  \
    X(REMEMBER_LOCAL) X(REMEMBER_DATA) /* the last assignment was to register a; to cell a */

#define KRL_STEPS(X)                                                                               \
    KRL_ORDINARY_STEPS(X)                                                                          \
    X(CALL) X(CALL_COPY) /* routine b, arguments from a on, own frame c; CALL_COPY: its frame from d on */ \
    X(RETURN) X(RETURN_VALUE) /* b */                                                              \
    X(END_ACTION)                                                                                  \
    X(SWITCH)            /* goes to the CASE step for b among the next a, which are for c and up */ \
    X(AT)                /* the statement is that of instruction b */                              \
    X(PYTHON)            /* Python handles matter tag of instruction b; stack up to a */           \
    X(STOP)              /* the same, unless a StopAdvance needs no request */

enum krl_step_op {
#define KRL_STEP_NUMBER(name) KRL_STEP_##name,
    KRL_STEPS(KRL_STEP_NUMBER)
#undef KRL_STEP_NUMBER
    KRL_STEP_COUNT
};

/* The distance between a step that computes the address of an element and the one that reads it:
 * for elements with two or three indices, and of views. */
enum { KRL_GET_BEHIND_INDEX = KRL_STEP_GET_VIEW - KRL_STEP_INDEX_VIEW };

#define KRL_IS_THREE(op) ((op) >= KRL_STEP_INDEX_THREE_LOCAL && (op) <= KRL_STEP_PUT_THREE_DATA)
#define KRL_IS_JUMP(op) ((op) <= KRL_STEP_TEXT)
#define KRL_IS_RELATION(op) ((op) >= KRL_STEP_EQ_INT && (op) <= KRL_STEP_GE_REAL_K)

#endif
