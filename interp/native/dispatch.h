/* What the steps of the interpreter are written with; for run.c alone.
 *
 * Where the compiler has labels as values, each step goes straight to the next one; else, or with
 * KRL_SWITCH, there is one switch. Each step is there twice: as it is, and with the beginning of a
 * statement before it.
 *
 * The macros use the variables and labels of the function in run.c: the step `pc`, the frame `fp`,
 * all `cells`, `left`, `statement`, `fault`.
 */
#ifndef KRL_DISPATCH_H
#define KRL_DISPATCH_H

#include "machine.h"
#include "register_code.h"

#if defined(__GNUC__) && !defined(KRL_SWITCH)
#define KRL_THREADED 1
#define UNLIKELY(condition) __builtin_expect(!!(condition), 0)
#else
#define KRL_THREADED 0
#define UNLIKELY(condition) (condition)
#endif

/* ---------------------------------------------------------------------------- from step to step */

#define REGISTER(number) fp[number]
#define A REGISTER(pc->a)
#define B REGISTER(pc->b)
#define C REGISTER(pc->c)
#define D REGISTER(pc->d)

#define FAULT(name)                                                                                \
    do {                                                                                           \
        fault = KRL_FAULT_##name;                                                                  \
        goto failed;                                                                               \
    } while (0)
#define FAULT_IF(condition, name)                                                                  \
    do {                                                                                           \
        if (UNLIKELY(condition))                                                                   \
            goto name;                                                                             \
    } while (0)
/* What is read may have no value, unless it is known to come from another step. */
#define READ(name, cell)                                                                           \
    krl_cell name = (cell);                                                                        \
    FAULT_IF(name == KRL_NOTHING, uninitialised)

#define BEGIN_STATEMENT()                                                                          \
    do {                                                                                           \
        if (UNLIKELY(left <= 1))                                                                   \
            goto wait;                                                                             \
        left--;                                                                                    \
        statement = pc->statement;                                                                 \
    } while (0)

#if KRL_THREADED
#define STEP(name)                                                                                 \
    begin_##name : BEGIN_STATEMENT();                                                              \
    do_##name:
#define GO() goto *pc->handler
#else
#define STEP(name)                                                                                 \
    case 2 * KRL_STEP_##name + 1:                                                                  \
        BEGIN_STATEMENT();                                                                         \
        /* fall through */                                                                         \
    case 2 * KRL_STEP_##name:
#define GO() goto dispatch
#endif
#define NEXT()                                                                                     \
    do {                                                                                           \
        pc++;                                                                                      \
        GO();                                                                                      \
    } while (0)
#define JUMP()                                                                                     \
    do {                                                                                           \
        pc = (const struct krl_step *)((const char *)pc + pc->d);                                  \
        GO();                                                                                      \
    } while (0)

/* ---------------------------------------------------------------------------- arithmetic */

#if KRL_THREADED
#define adds(a, b, result) __builtin_add_overflow(a, b, result)
#define subtracts(a, b, result) __builtin_sub_overflow(a, b, result)
#define multiplies(a, b, result) __builtin_mul_overflow(a, b, result)
#else
static inline int fits(int64_t wide, int32_t *result)
{
    *result = (int32_t)wide;
    return wide != *result;
}
#define adds(a, b, result) fits((int64_t)(a) + (b), result)
#define subtracts(a, b, result) fits((int64_t)(a) - (b), result)
#define multiplies(a, b, result) fits((int64_t)(a) * (b), result)
#endif

/* The nearest INT, halves away from zero; not 0 where there is none. The sum with a half is that of
 * doubles: that of singles would round. */
static inline int rounds(float number, int32_t *result)
{
    double wide = number >= 0 ? (double)number + 0.5 : (double)number - 0.5;
    if (wide >= 2147483648.0 || wide <= -2147483649.0)
        return 1;
    *result = (int32_t)wide; /* towards zero */
    return 0;
}

#define REAL_RESULT(expression)                                                                    \
    do {                                                                                           \
        float result = (expression);                                                               \
        FAULT_IF(!krl_is_finite(result), overflow);                                                \
        A = krl_of_real(result);                                                                   \
        NEXT();                                                                                    \
    } while (0)
#define INT_RESULT(operation, left_operand, right_operand)                                         \
    do {                                                                                           \
        int32_t result;                                                                            \
        FAULT_IF(operation(left_operand, right_operand, &result), overflow);                       \
        A = krl_of_int(result);                                                                    \
        NEXT();                                                                                    \
    } while (0)

/* ---------------------------------------------------------------------------- calls */

/* Notes the frame to return to; the result and the new frame are left to the step. */
#define OPEN_CALL()                                                                                \
    const struct krl_routine *callee = &machine->routines[pc->b];                                  \
    int32_t extent = machine->extent + pc->c;                                                      \
    FAULT_IF(machine->open >= machine->most_calls || callee->frame > KRL_MAX_CELLS - extent,       \
             stack);                                                                               \
    struct krl_call *call = &machine->calls[machine->open++];                                      \
    call->step = (int32_t)(pc + 1 - machine->steps);                                               \
    call->code = machine->code;                                                                    \
    call->fp = (int32_t)(fp - cells);                                                              \
    call->extent = machine->extent;                                                                \
    call->statement = statement;                                                                   \
    call->serial = machine->serial
/* Goes on in the routine that is called. */
#define ENTER()                                                                                    \
    do {                                                                                           \
        machine->code = pc->b;                                                                     \
        machine->extent = extent;                                                                  \
        machine->serial = callee->is_owner ? ++machine->serials : 0;                               \
        statement = -1;                                                                            \
        pc = callee->entry;                                                                        \
        GO();                                                                                      \
    } while (0)

/* ---------------------------------------------------------------------------- shared forms */

#define FOR_STEP(name, cell, operator)                                                             \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(counter, cell);                                                                       \
        READ(limit, B);                                                                            \
        int32_t result;                                                                            \
        FAULT_IF(adds(krl_int_in(counter), pc->c, &result), overflow);                             \
        cell = krl_of_int(result);                                                                 \
        if (result operator krl_int_in(limit))                                                     \
            JUMP();                                                                                \
        NEXT();                                                                                    \
    }
#define INT_STEP(name, operation)                                                                  \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        INT_RESULT(operation, krl_int_in(b), krl_int_in(c));                                       \
    }
#define INT_STEP_K(name, operation)                                                                \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        INT_RESULT(operation, krl_int_in(b), pc->c);                                               \
    }
#define REAL_STEP(name, operator)                                                                  \
    STEP(name##_REAL)                                                                              \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        REAL_RESULT(krl_real_in(b) operator krl_real_in(c));                                       \
    }                                                                                              \
    STEP(name##_REAL_K)                                                                            \
    {                                                                                              \
        READ(b, B);                                                                                \
        REAL_RESULT(krl_real_in(b) operator krl_real_of_bits((uint32_t)pc->c));                    \
    }
#define RELATION_STEPS(name, operator)                                                             \
    STEP(name##_INT)                                                                               \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        A = krl_of_bool(krl_int_in(b) operator krl_int_in(c));                                     \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(name##_INT_K)                                                                             \
    {                                                                                              \
        READ(b, B);                                                                                \
        A = krl_of_bool(krl_int_in(b) operator pc->c);                                             \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(name##_REAL)                                                                              \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        A = krl_of_bool(krl_real_in(b) operator krl_real_in(c));                                   \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(name##_REAL_K)                                                                            \
    {                                                                                              \
        READ(b, B);                                                                                \
        A = krl_of_bool(krl_real_in(b) operator krl_real_of_bits((uint32_t)pc->c));                \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_INT)                                                                      \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        if (krl_int_in(b) operator krl_int_in(c))                                                  \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_INT_K)                                                                    \
    {                                                                                              \
        READ(b, B);                                                                                \
        if (krl_int_in(b) operator pc->c)                                                          \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_REAL)                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        if (krl_real_in(b) operator krl_real_in(c))                                                \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_REAL_K)                                                                   \
    {                                                                                              \
        READ(b, B);                                                                                \
        if (krl_real_in(b) operator krl_real_of_bits((uint32_t)pc->c))                             \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }
/* Two operands that are looked at as numbers of 32 bits; both BOOL, or both INT. */
#define BIT_STEP(name, make, operator)                                                             \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        A = make(krl_int_in(b) operator krl_int_in(c));                                            \
        NEXT();                                                                                    \
    }

/* The element at an address: its address, its value, or the place for one. */
#define ACCESS_STEPS(suffix, base, find)                                                           \
    STEP(INDEX_##suffix)                                                                           \
    {                                                                                              \
        find;                                                                                      \
        A = krl_of_int((int32_t)((base) + place - cells));                                         \
        NEXT();                                                                                    \
    }
#define ELEMENT_STEPS(get, put, base, find)                                                        \
    STEP(get)                                                                                      \
    {                                                                                              \
        find;                                                                                      \
        READ(found, (base)[place]);                                                                \
        A = found;                                                                                 \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(put)                                                                                      \
    {                                                                                              \
        find;                                                                                      \
        READ(value, A);                                                                            \
        (base)[place] = value;                                                                     \
        NEXT();                                                                                    \
    }
/* Indices count from 1; as numbers without sign, 0 and negative ones are too large. */
#define FIND_ONE                                                                                   \
    READ(index, B);                                                                                \
    uint32_t number = (uint32_t)index - 1;                                                         \
    FAULT_IF(number >= (uint32_t)pc->d, index_);                                                   \
    int32_t place = pc->c + (int32_t)number
#define FIND_WIDE                                                                                  \
    const struct krl_array *array = &machine->arrays[pc->c];                                       \
    READ(index, B);                                                                                \
    uint32_t number = (uint32_t)index - 1;                                                         \
    FAULT_IF(number >= (uint32_t)array->sizes[0], index_);                                         \
    int32_t place = array->base + (int32_t)number * array->width
#define FIND_TWO                                                                                   \
    const struct krl_array *array = &machine->arrays[pc->c];                                       \
    READ(index, B);                                                                                \
    READ(other, D);                                                                                \
    uint32_t number = (uint32_t)index - 1, behind = (uint32_t)other - 1;                           \
    FAULT_IF(number >= (uint32_t)array->sizes[0] || behind >= (uint32_t)array->sizes[1], index_);  \
    int32_t place = array->base + ((int32_t)number * array->sizes[1] + (int32_t)behind) * array->width

#endif
