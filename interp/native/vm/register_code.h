/* The register code that code objects are translated into: its steps. Operands are registers, unless it
 * says so.
 *
 * A step whose name ends in K has a constant instead of its last operand: a word, for a cell with
 * its tag in `tag`. Places of arrays are a first cell and a size; `array` is one of the table.
 */
#ifndef KRL_REGISTER_CODE_H
#define KRL_REGISTER_CODE_H

#define KRL_COMPARISONS(X) X(EQ, ==) X(NE, !=) X(LT, <) X(GT, >) X(LE, <=) X(GE, >=)

/* What decides where to go on; d is the target. */
#define KRL_JUMPS(X)                                                                               \
    X(JUMP) X(JUMP_IF) X(JUMP_UNLESS) /* b */                                                      \
    X(CASE) /* b, constant c */                                                                    \
    X(UNLESS_EQ_INT) X(UNLESS_NE_INT) X(UNLESS_LT_INT) X(UNLESS_GT_INT)                            \
    X(UNLESS_LE_INT) X(UNLESS_GE_INT) X(UNLESS_EQ_INT_K) X(UNLESS_NE_INT_K)                        \
    X(UNLESS_LT_INT_K) X(UNLESS_GT_INT_K) X(UNLESS_LE_INT_K) X(UNLESS_GE_INT_K)                    \
    X(UNLESS_EQ_REAL) X(UNLESS_NE_REAL) X(UNLESS_LT_REAL) X(UNLESS_GT_REAL)                        \
    X(UNLESS_LE_REAL) X(UNLESS_GE_REAL) X(UNLESS_EQ_REAL_K) X(UNLESS_NE_REAL_K)                    \
    X(UNLESS_LT_REAL_K) X(UNLESS_GT_REAL_K) X(UNLESS_LE_REAL_K) X(UNLESS_GE_REAL_K)                \
    X(FOR_UP) X(FOR_DOWN)             /* counter a, limit b, step c */                             \
    X(FOR_DATA_UP) X(FOR_DATA_DOWN)   /* the counter is a cell of the data lists */                \
    X(TEXT)                           /* inputs from a on, entry b, function tag; past the step for Python */

/* What gives a BOOL in a from b and c; in the order of the UNLESS steps. */
#define KRL_RELATIONS(X)                                                                           \
    X(EQ_INT) X(NE_INT) X(LT_INT) X(GT_INT) X(LE_INT) X(GE_INT)                                    \
    X(EQ_INT_K) X(NE_INT_K) X(LT_INT_K) X(GT_INT_K) X(LE_INT_K) X(GE_INT_K)                        \
    X(EQ_REAL) X(NE_REAL) X(LT_REAL) X(GT_REAL) X(LE_REAL) X(GE_REAL)                              \
    X(EQ_REAL_K) X(NE_REAL_K) X(LT_REAL_K) X(GT_REAL_K) X(LE_REAL_K) X(GE_REAL_K)

/* What neither calls nor leaves. */
#define KRL_ORDINARY_STEPS(X)                                                                               \
    KRL_JUMPS(X)                                                                                   \
    KRL_RELATIONS(X)                                                                               \
    X(NOP)                                                                                         \
    X(MOVE) X(SET_K)                     /* a from b; from the bits b */                           \
    X(PASS)                              /* a from b, which may have no value */                   \
    X(GET_DATA) X(PUT_DATA) X(PUT_DATA_K) /* a from cell b; cell a from b, from the bits b */      \
    X(REFER)                             /* a the address of b */                                  \
    X(OFFSET)                            /* a the address b and c more */                          \
    X(LOAD) X(STORE) X(STORE_K)          /* a from where b leads; where a leads from b */          \
    X(INDEX_LOCAL) X(INDEX_DATA)         /* a the address of element b of c, d elements */         \
    X(GET_LOCAL) X(GET_ELEMENT_DATA)     /* a from the element */                                  \
    X(PUT_LOCAL) X(PUT_ELEMENT_DATA)     /* the element from a */                                  \
    X(PUT_LOCAL_K) X(PUT_ELEMENT_DATA_K)                                                           \
    X(INDEX_WIDE_LOCAL) X(INDEX_WIDE_DATA) /* the same with array c, whose elements are large */   \
    X(GET_WIDE_LOCAL) X(GET_WIDE_DATA)                                                             \
    X(PUT_WIDE_LOCAL) X(PUT_WIDE_DATA)                                                             \
    X(INDEX_TWO_LOCAL) X(INDEX_TWO_DATA) /* the same with two indices, b and d, array c */         \
    X(GET_TWO_LOCAL) X(GET_TWO_DATA)                                                               \
    X(PUT_TWO_LOCAL) X(PUT_TWO_DATA)                                                               \
    X(INDEX_THREE_LOCAL) X(INDEX_THREE_DATA) /* the same with three, the third in a register that array c names */ \
    X(GET_THREE_LOCAL) X(GET_THREE_DATA)                                                           \
    X(PUT_THREE_LOCAL) X(PUT_THREE_DATA)                                                           \
    X(INDEX_VIEW)     /* a the address of element b of view c, d cells each */                     \
    X(INDEX_VIEW_TWO) /* the same with two indices, b and d, tag cells each */                     \
    X(GET_VIEW) X(GET_VIEW_TWO) /* a from the element */                                           \
    X(ROW)            /* the address a, then b indices, array c */                                 \
    X(ROW_VIEW)       /* a and its b indices, view c, d cells each, tag dimensions */              \
    X(COPY) X(CLEAR)  /* to a from b, c cells; from a on, c cells */                               \
    X(FILL_POSE)      /* to a from b, c cells, d of them in common */                              \
    X(FILL_ARRAY)     /* view a from view b, c cells each, d dimensions */                         \
    X(COPY_VIEW)      /* view a into b on, where c cells are; d cells each, tag dimensions */      \
    X(SET_TEXT)       /* view a, text b */                                                         \
    X(COMPOSE)        /* where a leads from b and c, d cells */                                    \
    X(INVERT)         /* where b leads from a, c cells */                                          \
    X(ADD_INT) X(SUB_INT) X(MUL_INT) X(DIV_INT) X(ADD_INT_K) X(MUL_INT_K) X(DIV_INT_K)             \
    X(NEG_INT) X(NOT_BITS) X(AND_BITS) X(OR_BITS) X(EXOR_BITS) X(AND_BITS_K)                       \
    X(ADD_REAL) X(SUB_REAL) X(MUL_REAL) X(DIV_REAL)                                                \
    X(ADD_REAL_K) X(SUB_REAL_K) X(MUL_REAL_K) X(DIV_REAL_K) X(NEG_REAL)                            \
    X(NOT_BOOL) X(AND_BOOL) X(OR_BOOL) X(EXOR_BOOL)                                                \
    X(INT_TO_REAL) X(REAL_TO_INT) X(INT_TO_CHAR) /* a from b */                                    \
    X(FUNCTION)          /* a from b and c, function tag */                                        \
    X(CHECK_CALL)        /* faults where the call would: routine b, own frame c */                 \
    X(FAIL)              /* fault b */                                                             \
    X(REMEMBER_LOCAL) X(REMEMBER_DATA) /* the address a was written last */

#define KRL_STEPS(X)                                                                               \
    KRL_ORDINARY_STEPS(X)                                                                          \
    X(CALL) X(CALL_COPY) /* arguments from a on, routine b, own frame c; and behind it d cells */  \
    X(RETURN) X(RETURN_VALUE) /* b */                                                              \
    X(END_ACTION)                                                                                  \
    X(SWITCH)            /* the one of the a CASE steps behind it that compares b; the first one with c */ \
    X(AT)                /* the statement is that of place b */                                    \
    X(PYTHON)            /* for Python: matter tag of the instruction at place b; stack up to a */ \
    X(STOP)              /* the same, unless it may pass without a request to stop the advance run */

enum krl_step_op {
#define KRL_STEP_NUMBER(name) KRL_STEP_##name,
    KRL_STEPS(KRL_STEP_NUMBER)
#undef KRL_STEP_NUMBER
    KRL_STEP_COUNT
};

/* Of elements with two or three indices, and of views. */
enum { KRL_GET_BEHIND_INDEX = KRL_STEP_GET_VIEW - KRL_STEP_INDEX_VIEW };

#define KRL_IS_THREE(op) ((op) >= KRL_STEP_INDEX_THREE_LOCAL && (op) <= KRL_STEP_PUT_THREE_DATA)
#define KRL_IS_JUMP(op) ((op) <= KRL_STEP_TEXT)
#define KRL_IS_RELATION(op) ((op) >= KRL_STEP_EQ_INT && (op) <= KRL_STEP_GE_REAL_K)

#endif
