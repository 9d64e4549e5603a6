/* The effects of all steps that neither call nor leave (KRL_ORDINARY_STEPS), for the interpreter
 * (run.c) and for native code (compiled.h), where the step is a constant.
 *
 * A step is a function that is always inlined. It returns KRL_GO_NEXT, KRL_GO_JUMP, or the code of
 * a fault.
 */
#ifndef KRL_STEPS_H
#define KRL_STEPS_H

#include "array_operations.h"
#include "register_code.h"

#if defined(__GNUC__)
#define LIKELY(condition) __builtin_expect(!!(condition), 1)
#define UNLIKELY(condition) __builtin_expect(!!(condition), 0)
#define KRL_UNUSED __attribute__((unused))
#define KRL_INLINE static inline __attribute__((always_inline, unused))
#else
#define LIKELY(condition) (condition)
#define UNLIKELY(condition) (condition)
#define KRL_UNUSED
#define KRL_INLINE static __forceinline
#endif

/* Where execution continues after a step that does not fault. Codes of faults are not negative. */
enum { KRL_GO_NEXT = -1, KRL_GO_JUMP = -2 };

/* A register is a cell, unless compiled.h defines it otherwise. */
#ifndef KRL_REGISTERS
typedef krl_cell krl_register;
#define REGISTER_OF(cell) (cell)
#define REGISTER_AT(place) (place)
#define MUST_BE_FINITE 1
#define CELL_OF(register) (register)
#define HAS_VALUE(register) ((register) != KRL_NOTHING)
#define INT(register) krl_int_in(register)
#define REAL(register) krl_real_in(register)
#define OF_INT krl_of_int
#define OF_BOOL krl_of_bool
#define OF_REAL krl_of_real
#endif

/* Stores the address of an assignment through a reference, for the trace. */
#ifndef REMEMBER
#define REMEMBER(address) machine->last = (address)
#endif

#ifndef KRL_ARRAY
#define KRL_ARRAY(number) (&machine->arrays[number])
#endif

/* Arguments: all `cells`, the frame `fp`, its `registers` (the same cells, or copies of them), the
 * step `pc`. */
#define STEP(name)                                                                                 \
    KRL_INLINE int krl_step_##name(KRL_UNUSED struct krl_machine *machine,                         \
                                   KRL_UNUSED krl_cell *const cells, KRL_UNUSED krl_cell *const fp, \
                                   KRL_UNUSED krl_register *const registers,                       \
                                   KRL_UNUSED const struct krl_step *const pc)
#define NEXT() return KRL_GO_NEXT
#define JUMP() return KRL_GO_JUMP

#define REGISTER(number) registers[number]
#define CELL(number) fp[number]
#define A REGISTER(pc->a)
#define B REGISTER(pc->b)
#define C REGISTER(pc->c)
#define D REGISTER(pc->d)

#define FAULT(name) return KRL_FAULT_##name
#define FAULT_IF(condition, name)                                                                  \
    do {                                                                                           \
        if (UNLIKELY(condition))                                                                   \
            FAULT(name);                                                                           \
    } while (0)
/* Counts a function that has been computed. */
#define CHARGE(name)                                                                               \
    do {                                                                                           \
        if (UNLIKELY((machine->functions -= KRL_WEIGHT_##name) < 0))                               \
            return KRL_OVERRUN;                                                                    \
    } while (0)
/* Faults if what is read has no value [TYP-13]. In native code the C compiler drops the check where it knows
 * the tag. */
#define READ(name, place)                                                                          \
    krl_register name = (place);                                                                   \
    FAULT_IF(!HAS_VALUE(name), UNINITIALISED)
#define READ_CELL(name, cell) READ(name, REGISTER_AT(cell))

/* ---------------------------------------------------------------------------- arithmetic */

/* What an INT cannot hold is a fault [ARI-12]. */
#if defined(__GNUC__)
#define adds(a, b, result) __builtin_add_overflow(a, b, result)
#define subtracts(a, b, result) __builtin_sub_overflow(a, b, result)
#define multiplies(a, b, result) __builtin_mul_overflow(a, b, result)
#else
static inline int overflows(int64_t wide, int32_t *result)
{
    *result = (int32_t)wide;
    return wide != *result;
}
#define adds(a, b, result) overflows((int64_t)(a) + (b), result)
#define subtracts(a, b, result) overflows((int64_t)(a) - (b), result)
#define multiplies(a, b, result) overflows((int64_t)(a) * (b), result)
#endif

/* Rounds to the nearest INT, halves away from zero [ARI-03]. Returns 1 if that is out of range. The
 * half is added in double precision, because the sum in single precision would be rounded. */
static inline int rounds(float number, int32_t *result)
{
    double wide = number >= 0 ? (double)number + 0.5 : (double)number - 0.5;
    if (wide >= 2147483648.0 || wide <= -2147483649.0)
        return 1;
    *result = (int32_t)wide; /* truncates */
    return 0;
}

#define REAL_RESULT(expression)                                                                    \
    do {                                                                                           \
        float result = (expression);                                                               \
        FAULT_IF(MUST_BE_FINITE && !krl_is_finite(result), OVERFLOW);                              \
        A = OF_REAL(result);                                                                       \
        NEXT();                                                                                    \
    } while (0)
#define INT_RESULT(operation, left_operand, right_operand)                                         \
    do {                                                                                           \
        int32_t result;                                                                            \
        FAULT_IF(operation(left_operand, right_operand, &result), OVERFLOW);                       \
        A = OF_INT(result);                                                                        \
        NEXT();                                                                                    \
    } while (0)

/* ---------------------------------------------------------------------------- shared forms */

#define READ_BOTH                                                                                  \
    READ(b, B);                                                                                    \
    READ(c, C)
#define FOR_STEP(name, get, put, operator)                                                         \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(counter, get);                                                                        \
        READ(limit, B);                                                                            \
        int32_t result;                                                                            \
        FAULT_IF(adds(INT(counter), pc->c, &result), OVERFLOW);                                    \
        put(OF_INT(result));                                                                       \
        if (result operator INT(limit))                                                            \
            JUMP();                                                                                \
        NEXT();                                                                                    \
    }
#define INT_STEP(name, operation)                                                                  \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ_BOTH;                                                                                 \
        INT_RESULT(operation, INT(b), INT(c));                                                     \
    }
#define INT_STEP_K(name, operation)                                                                \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        INT_RESULT(operation, INT(b), pc->c);                                                      \
    }
#define REAL_STEP(name, operator)                                                                  \
    STEP(name##_REAL)                                                                              \
    {                                                                                              \
        READ_BOTH;                                                                                 \
        REAL_RESULT(REAL(b) operator REAL(c));                                                     \
    }                                                                                              \
    STEP(name##_REAL_K)                                                                            \
    {                                                                                              \
        READ(b, B);                                                                                \
        REAL_RESULT(REAL(b) operator krl_real_of_bits((uint32_t)pc->c));                           \
    }
/* The comparison that stores a BOOL, and the jump unless it holds. */
#define RELATION_STEP(name, read, holds)                                                           \
    STEP(name)                                                                                     \
    {                                                                                              \
        read;                                                                                      \
        A = OF_BOOL(holds);                                                                        \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name)                                                                            \
    {                                                                                              \
        read;                                                                                      \
        if (holds)                                                                                 \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }
#define RELATION_STEPS(name, operator)                                                             \
    RELATION_STEP(name##_INT, READ_BOTH, INT(b) operator INT(c))                                   \
    RELATION_STEP(name##_INT_K, READ(b, B), INT(b) operator pc->c)                                 \
    RELATION_STEP(name##_REAL, READ_BOTH, REAL(b) operator REAL(c))                                \
    RELATION_STEP(name##_REAL_K, READ(b, B),                                                       \
                  REAL(b) operator krl_real_of_bits((uint32_t)pc->c))
/* Operates on all 32 bits of two operands, both INT or both BOOL. */
#define BIT_STEP(name, make, operator)                                                             \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ_BOTH;                                                                                 \
        A = make(INT(b) operator INT(c));                                                          \
        NEXT();                                                                                    \
    }

/* Steps on the element that `find` locates: compute its address, read it, write it. */
#define ACCESS_STEPS(suffix, base, find)                                                           \
    STEP(INDEX_##suffix)                                                                           \
    {                                                                                              \
        find;                                                                                      \
        A = OF_INT((int32_t)((base) - cells) + (int32_t)place);                                    \
        NEXT();                                                                                    \
    }
#define ELEMENT_STEPS(get, put, base, find)                                                        \
    STEP(get)                                                                                      \
    {                                                                                              \
        find;                                                                                      \
        READ_CELL(found, (base)[place]);                                                           \
        A = found;                                                                                 \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(put)                                                                                      \
    {                                                                                              \
        find;                                                                                      \
        READ(value, A);                                                                            \
        (base)[place] = CELL_OF(value);                                                            \
        NEXT();                                                                                    \
    }
#define VIEW_STEPS(suffix, find)                                                                   \
    STEP(INDEX_##suffix)                                                                           \
    {                                                                                              \
        find;                                                                                      \
        A = OF_INT(place);                                                                         \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(GET_##suffix)                                                                             \
    {                                                                                              \
        find;                                                                                      \
        READ_CELL(found, cells[(uint32_t)place]);                                                  \
        A = found;                                                                                 \
        NEXT();                                                                                    \
    }
/* Indices count from 1 [TYP-09]. One unsigned comparison also excludes 0 and negative indices. */
#define FIND_ONE                                                                                   \
    READ(index, B);                                                                                \
    uint32_t number = (uint32_t)INT(index) - 1;                                                    \
    FAULT_IF(number >= (uint32_t)pc->d, INDEX);                                                    \
    uint32_t place = (uint32_t)pc->c + number
#define FIND_WIDE                                                                                  \
    const struct krl_array *array = KRL_ARRAY(pc->c);                                              \
    READ(index, B);                                                                                \
    uint32_t number = (uint32_t)INT(index) - 1;                                                    \
    FAULT_IF(number >= (uint32_t)array->sizes[0], INDEX);                                          \
    uint32_t place = (uint32_t)array->base + number * (uint32_t)array->width
#define FIND_TWO                                                                                   \
    const struct krl_array *array = KRL_ARRAY(pc->c);                                              \
    READ(index, B);                                                                                \
    READ(other, D);                                                                                \
    uint32_t number = (uint32_t)INT(index) - 1, behind = (uint32_t)INT(other) - 1;                 \
    FAULT_IF(number >= (uint32_t)array->sizes[0] || behind >= (uint32_t)array->sizes[1], INDEX);   \
    uint32_t row = number * (uint32_t)array->sizes[1] + behind;                                    \
    uint32_t place = (uint32_t)array->base + row * (uint32_t)array->width

#define FIND_THREE                                                                                 \
    const struct krl_array *array = KRL_ARRAY(pc->c);                                              \
    READ(first, B);                                                                                \
    READ(second, D);                                                                               \
    READ(third, REGISTER(array->third));                                                           \
    uint32_t number = (uint32_t)INT(first) - 1, behind = (uint32_t)INT(second) - 1, last = (uint32_t)INT(third) - 1; \
    FAULT_IF(number >= (uint32_t)array->sizes[0] || behind >= (uint32_t)array->sizes[1] ||         \
                 last >= (uint32_t)array->sizes[2],                                                \
             INDEX);                                                                               \
    uint32_t row = number * (uint32_t)array->sizes[1] + behind;                                    \
    uint32_t place = (uint32_t)array->base + (row * (uint32_t)array->sizes[2] + last) * (uint32_t)array->width

/* Locates an element of a view by its address. */
#define FIND_IN_VIEW                                                                               \
    READ(index, B);                                                                                \
    READ(base, C);                                                                                 \
    uint32_t number = (uint32_t)INT(index) - 1;                                                    \
    FAULT_IF(number >= (uint32_t)INT(REGISTER(pc->c + 1)), INDEX);                                 \
    int32_t place = INT(base) + (int32_t)number * pc->d
#define FIND_TWO_IN_VIEW                                                                           \
    READ(index, B);                                                                                \
    READ(other, D);                                                                                \
    READ(base, C);                                                                                 \
    uint32_t number = (uint32_t)INT(index) - 1, behind = (uint32_t)INT(other) - 1;                 \
    uint32_t columns = (uint32_t)INT(REGISTER(pc->c + 2));                                         \
    FAULT_IF(number >= (uint32_t)INT(REGISTER(pc->c + 1)) || behind >= columns, INDEX);            \
    int32_t place = INT(base) + (int32_t)(number * columns + behind) * pc->tag

/* ---- control flow */
STEP(JUMP)
{
    JUMP();
}

STEP(JUMP_IF)
{
    READ(b, B);
    if (INT(b))
        JUMP();
    NEXT();
}

STEP(JUMP_UNLESS)
{
    READ(b, B);
    if (INT(b))
        NEXT();
    JUMP();
}

STEP(CASE)
{
    READ(b, B);
    if (INT(b) == pc->c)
        JUMP();
    NEXT();
}
#define SET_A(value) A = value
#define SET_DATA(value) cells[pc->a] = CELL_OF(value)
FOR_STEP(FOR_UP, A, SET_A, <=)
FOR_STEP(FOR_DOWN, A, SET_A, >=)
FOR_STEP(FOR_DATA_UP, REGISTER_AT(cells[pc->a]), SET_DATA, <=)
FOR_STEP(FOR_DATA_DOWN, REGISTER_AT(cells[pc->a]), SET_DATA, >=)
KRL_COMPARISONS(RELATION_STEPS)

/* ---- data movement */
STEP(NOP)
{
    NEXT();
}

STEP(MOVE)
{
    READ(b, B);
    A = b;
    NEXT();
}

STEP(PASS)
{
    A = B;
    NEXT();
}

STEP(SET_K)
{
    A = REGISTER_OF(krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b));
    NEXT();
}

STEP(GET_DATA)
{
    READ_CELL(b, cells[pc->b]);
    A = b;
    NEXT();
}

STEP(PUT_DATA)
{
    READ(b, B);
    cells[pc->a] = CELL_OF(b);
    NEXT();
}

STEP(PUT_DATA_K)
{
    cells[pc->a] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
    NEXT();
}

STEP(REFER)
{
    A = OF_INT((int32_t)(fp + pc->b - cells));
    NEXT();
}

STEP(OFFSET)
{
    READ(b, B);
    A = OF_INT(INT(b) + pc->c);
    NEXT();
}

STEP(LOAD)
{
    READ(b, B);
    READ_CELL(found, cells[(uint32_t)INT(b)]);
    A = found;
    NEXT();
}

STEP(STORE)
{
    READ(address, A);
    READ(value, B);
    REMEMBER(INT(address));
    cells[(uint32_t)INT(address)] = CELL_OF(value);
    NEXT();
}

STEP(STORE_K)
{
    READ(address, A);
    REMEMBER(INT(address));
    cells[(uint32_t)INT(address)] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
    NEXT();
}

/* ---- elements */
ACCESS_STEPS(LOCAL, fp, FIND_ONE)
ACCESS_STEPS(DATA, cells, FIND_ONE)
ACCESS_STEPS(WIDE_LOCAL, fp, FIND_WIDE)
ACCESS_STEPS(WIDE_DATA, cells, FIND_WIDE)
ACCESS_STEPS(TWO_LOCAL, fp, FIND_TWO)
ACCESS_STEPS(TWO_DATA, cells, FIND_TWO)
ACCESS_STEPS(THREE_LOCAL, fp, FIND_THREE)
ACCESS_STEPS(THREE_DATA, cells, FIND_THREE)
ELEMENT_STEPS(GET_LOCAL, PUT_LOCAL, fp, FIND_ONE)
ELEMENT_STEPS(GET_ELEMENT_DATA, PUT_ELEMENT_DATA, cells, FIND_ONE)
ELEMENT_STEPS(GET_WIDE_LOCAL, PUT_WIDE_LOCAL, fp, FIND_WIDE)
ELEMENT_STEPS(GET_WIDE_DATA, PUT_WIDE_DATA, cells, FIND_WIDE)
ELEMENT_STEPS(GET_TWO_LOCAL, PUT_TWO_LOCAL, fp, FIND_TWO)
ELEMENT_STEPS(GET_TWO_DATA, PUT_TWO_DATA, cells, FIND_TWO)
ELEMENT_STEPS(GET_THREE_LOCAL, PUT_THREE_LOCAL, fp, FIND_THREE)
ELEMENT_STEPS(GET_THREE_DATA, PUT_THREE_DATA, cells, FIND_THREE)
STEP(PUT_LOCAL_K)
{
    FIND_ONE;
    fp[place] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->a);
    NEXT();
}

STEP(PUT_ELEMENT_DATA_K)
{
    FIND_ONE;
    cells[place] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->a);
    NEXT();
}

VIEW_STEPS(VIEW, FIND_IN_VIEW)
VIEW_STEPS(VIEW_TWO, FIND_TWO_IN_VIEW)

STEP(ROW)
{
    const struct krl_array *array = KRL_ARRAY(pc->c);
    int32_t place = krl_flat_place(array->sizes, pc->b, &CELL(pc->a) + 1), width = array->width;
    FAULT_IF(place < 0, INDEX);
    for (int32_t i = pc->b; i < array->dimensions; i++)
        width *= array->sizes[i];
    CELL(pc->a) = krl_of_int(krl_int_in(CELL(pc->a)) + place * width);
    for (int32_t i = pc->b; i < array->dimensions; i++)
        (&CELL(pc->a))[1 + i - pc->b] = krl_of_int(array->sizes[i]);
    NEXT();
}

STEP(ROW_VIEW)
{
    int32_t sizes[KRL_MOST_DIMENSIONS], width = pc->d;
    krl_cell base = CELL(pc->c);
    FAULT_IF(base == KRL_NOTHING, UNINITIALISED);
    krl_view_sizes(&CELL(pc->c), pc->tag, sizes);
    for (int32_t i = pc->b; i < pc->tag; i++)
        width *= sizes[i];
    int32_t place = krl_flat_place(sizes, pc->b, &CELL(pc->a));
    FAULT_IF(place < 0, INDEX);
    CELL(pc->a) = krl_of_int(krl_int_in(base) + place * width);
    for (int32_t i = pc->b; i < pc->tag; i++)
        (&CELL(pc->a))[1 + i - pc->b] = krl_of_int(sizes[i]);
    NEXT();
}

/* ---- blocks of cells; references on the operand stack have values */
STEP(COPY)
{
    REMEMBER(INT(A));
    krl_copy_cells(cells + INT(A), cells + INT(B), pc->c);
    NEXT();
}

STEP(CLEAR)
{
    krl_blank_cells(cells + INT(A), pc->c);
    NEXT();
}

STEP(FILL_POSE)
{
    krl_cell *target = cells + INT(A);
    REMEMBER(INT(A));
    krl_copy_cells(target, cells + INT(B), pc->d);
    krl_blank_cells(target + pc->d, pc->c - pc->d);
    NEXT();
}

STEP(FILL_ARRAY)
{
    int fault = krl_fill_array(cells, &CELL(pc->a), &CELL(pc->b), pc->c, pc->d);
    if (UNLIKELY(fault != KRL_FINE))
        return fault;
    REMEMBER(krl_int_in(CELL(pc->a)));
    NEXT();
}

STEP(COPY_VIEW)
{
    int32_t length = pc->d;
    for (int32_t i = 1; i <= pc->tag; i++)
        length *= krl_int_in((&CELL(pc->a))[i]);
    FAULT_IF(length > pc->c, STACK);
    krl_copy_cells(&CELL(pc->b), cells + krl_int_in(CELL(pc->a)), length);
    CELL(pc->a) = krl_of_int((int32_t)(fp + pc->b - cells));
    NEXT();
}

STEP(SET_TEXT)
{
    REMEMBER(krl_int_in(CELL(pc->a)));
    krl_set_text(cells + krl_int_in(CELL(pc->a)), krl_int_in((&CELL(pc->a))[1]), &machine->program.texts[pc->b]);
    NEXT();
}

STEP(COMPOSE)
{
    int fault = krl_compose(cells + INT(A), cells + INT(B), cells + INT(C), pc->d);
    if (UNLIKELY(fault != KRL_FINE))
        return fault;
    CHARGE(COMPOSE);
    NEXT();
}

STEP(INVERT)
{
    int fault = krl_invert(cells + INT(B), cells + INT(A), pc->c);
    if (UNLIKELY(fault != KRL_FINE))
        return fault;
    CHARGE(INV_POS);
    NEXT();
}

/* ---- arithmetic */
INT_STEP(ADD_INT, adds)
INT_STEP(SUB_INT, subtracts)
INT_STEP(MUL_INT, multiplies)
INT_STEP_K(ADD_INT_K, adds)
INT_STEP_K(MUL_INT_K, multiplies)
STEP(DIV_INT) /* the fraction is dropped [ARI-02] */
{
    READ_BOTH;
    int32_t divisor = INT(c);
    FAULT_IF(divisor == 0, DIVISION_BY_ZERO);
    if (UNLIKELY(divisor == -1))
        INT_RESULT(subtracts, 0, INT(b));
    A = OF_INT(INT(b) / divisor);
    NEXT();
}

STEP(DIV_INT_K) /* the divisor is neither 0 nor -1 */
{
    READ(b, B);
    A = OF_INT(INT(b) / pc->c);
    NEXT();
}

STEP(NEG_INT)
{
    READ(b, B);
    INT_RESULT(subtracts, 0, INT(b));
}

STEP(NOT_BITS)
{
    READ(b, B);
    A = OF_INT(~INT(b));
    NEXT();
}
BIT_STEP(AND_BITS, OF_INT, &)
BIT_STEP(OR_BITS, OF_INT, |)
BIT_STEP(EXOR_BITS, OF_INT, ^)
BIT_STEP(AND_BOOL, OF_BOOL, &)
BIT_STEP(OR_BOOL, OF_BOOL, |)
BIT_STEP(EXOR_BOOL, OF_BOOL, ^)
STEP(AND_BITS_K)
{
    READ(b, B);
    A = OF_INT(INT(b) & pc->c);
    NEXT();
}

STEP(NOT_BOOL)
{
    READ(b, B);
    A = OF_BOOL(!INT(b));
    NEXT();
}
REAL_STEP(ADD, +)
REAL_STEP(SUB, -)
REAL_STEP(MUL, *)
STEP(DIV_REAL)
{
    READ_BOTH;
    FAULT_IF(REAL(c) == 0, DIVISION_BY_ZERO);
    REAL_RESULT(REAL(b) / REAL(c));
}

STEP(DIV_REAL_K) /* the divisor is not zero */
{
    READ(b, B);
    REAL_RESULT(REAL(b) / krl_real_of_bits((uint32_t)pc->c));
}

STEP(NEG_REAL)
{
    READ(b, B);
    A = OF_REAL(-REAL(b));
    NEXT();
}

STEP(INT_TO_REAL)
{
    READ(b, B);
    A = OF_REAL((float)INT(b));
    NEXT();
}

STEP(REAL_TO_INT)
{
    READ(b, B);
    int32_t result;
    FAULT_IF(rounds(REAL(b), &result), OVERFLOW);
    A = OF_INT(result);
    NEXT();
}

STEP(INT_TO_CHAR)
{
    READ(b, B);
    if (UNLIKELY((uint32_t)INT(b) > 255))
        FAULT(INADMISSIBLE);
    A = b;
    NEXT();
}

STEP(FUNCTION)
{
    float result, other = 0;
    READ(b, B);
    if (pc->tag == KRL_ATAN2) {
        READ(c, C);
        other = REAL(c);
    }
    /* ABS is exact, and the root is rounded once: single precision gives the same result as
     * rounding that of double precision. */
    if (pc->tag == KRL_ABS || pc->tag == KRL_SQRT) {
        FAULT_IF(pc->tag == KRL_SQRT && REAL(b) < 0, DOMAIN);
        A = OF_REAL(pc->tag == KRL_ABS ? fabsf(REAL(b)) : sqrtf(REAL(b)));
        NEXT();
    }
    int fault = krl_compute((enum krl_function)pc->tag, REAL(b), other, &result);
    if (UNLIKELY(fault != KRL_FINE))
        return fault;
    A = OF_REAL(result);
    NEXT();
}

STEP(TEXT)
{
    if (LIKELY(krl_call_text(machine, (enum krl_text_function)pc->tag, &machine->program.builtins[pc->b],
                             &CELL(pc->a))))
        JUMP();
    NEXT();
}

/* ---- other steps */
STEP(CHECK_CALL)
{
    FAULT_IF(machine->open >= machine->most_calls ||
                 machine->routines[pc->b].frame > KRL_MAX_CELLS - (machine->extent + pc->c),
             STACK);
    NEXT();
}

STEP(FAIL)
{
    return pc->b;
}

STEP(REMEMBER_LOCAL)
{
    machine->last = (int32_t)(fp + pc->a - cells);
    NEXT();
}

STEP(REMEMBER_DATA)
{
    machine->last = pc->a;
    NEXT();
}

/* ---------------------------------------------------------------------------- calls */

/* Returns the call to record for a CALL step: the frame to return to. */
KRL_INLINE struct krl_call krl_call_of(krl_cell *const cells, krl_cell *const fp, const struct krl_step *const pc,
                                       int32_t step, int32_t code, int32_t extent, int32_t statement,
                                       int32_t serial)
{
    return (struct krl_call){step + 1,  code, (int32_t)(fp - cells), extent, statement, serial,
                             (int32_t)(fp + pc->a - cells), 0};
}

/* Opens the call of a step and records the frame to return to. Returns the frame of the callee,
 * with its arguments, or NULL if there are too many calls or cells. */
KRL_INLINE krl_cell *krl_enter(struct krl_machine *machine, krl_cell *const cells, krl_cell *const fp,
                               const struct krl_step *const pc, int32_t step, int32_t statement)
{
    const struct krl_routine *callee = &machine->routines[pc->b];
    int32_t extent = machine->extent + pc->c;
    if (UNLIKELY(machine->open >= machine->most_calls || callee->frame > KRL_MAX_CELLS - extent))
        return NULL;
    machine->calls[machine->open++] =
        krl_call_of(cells, fp, pc, step, machine->code, machine->extent, statement, machine->serial);
    machine->code = pc->b;
    machine->extent = extent;
    machine->serial = callee->is_owner ? ++machine->serials : 0;
    if (pc->op == KRL_STEP_CALL) {
        for (int32_t i = callee->received; i < callee->frame; i++)
            (fp + pc->a)[i] = KRL_NOTHING;
        return fp + pc->a;
    }
    krl_receive(machine, callee, fp + pc->d, fp + pc->a);
    return fp + pc->d;
}

/* Closes the last call and returns it. The caller of this function restores `fp` and the statement. */
KRL_INLINE const struct krl_call *krl_return(struct krl_machine *machine)
{
    const struct krl_call *call = &machine->calls[--machine->open];
    machine->code = call->code;
    machine->extent = call->extent;
    machine->serial = call->serial;
    return call;
}

/* Stores a result in the cell that the call has for it. */
KRL_INLINE void krl_give(struct krl_machine *machine, krl_cell *const cells, krl_cell value)
{
    machine->top = machine->calls[machine->open - 1].result;
    cells[machine->top++] = value;
}

/* ---------------------------------------------------------------------------- slices */

/* Whether a StopAdvance needs no request, as in Counter.passes_stop. If so, a slice begins. */
KRL_INLINE int krl_passes_stop(struct krl_machine *machine, int32_t *left)
{
    if (machine->stops == 0)
        return 0;
    machine->stops--;
    machine->quota += machine->whole - *left;
    *left = machine->whole;
    return 1;
}

#undef STEP
#undef NEXT
#undef JUMP
#undef A
#undef B
#undef C
#undef D

#endif
