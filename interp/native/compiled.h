/* What programs are written with that were made from register code (compiled.py): a function for each
 * routine, a label for each step. A step is done as by the interpreter (steps.h), but is constant.
 *
 * It is entered where a routine or a loop begins. Whatever is out of the ordinary, a fault, a request, the end of
 * the budget, is left to the interpreter: the function puts everything back as the interpreter has it, says at which
 * step, and returns, and so do all that called it, each noting its call. No step has done anything when it faults,
 * so that the interpreter can do it again.
 */
#ifndef KRL_COMPILED_H
#define KRL_COMPILED_H

#include "machine.h"

#define KRL_ARRAY(number) (&arrays[number])
#define krl_compute machine->outside->compute
#define krl_compose machine->outside->compose
#define krl_invert machine->outside->invert
#define krl_call_text machine->outside->call_text
#define krl_is_plain machine->outside->is_plain
static const struct krl_array arrays[];

/* A register in three parts, of which the C compiler keeps what is used. */
typedef struct {
    enum krl_tag tag;
    int32_t bits; /* 0 for a REAL */
    float real;   /* 0 for all others */
} krl_register;
#define KRL_REGISTERS
#define REGISTER_OF(cell) krl_register_of_ANY(cell)
#define CELL_OF(register) krl_cell_of_ANY(register)
#define HAS_VALUE(register) ((register).tag != KRL_TAG_NONE)
#define INT(register) (register).bits
#define REAL(register) (register).real
#define OF_INT(value) ((krl_register){KRL_TAG_INT, (value), 0})
#define OF_BOOL(value) ((krl_register){KRL_TAG_BOOL, (value) != 0, 0})
#define OF_REAL(value) ((krl_register){KRL_TAG_REAL, 0, (value)})

static inline krl_register krl_register_of_INT(krl_cell cell)
{
    return cell == KRL_NOTHING ? (krl_register){0} : OF_INT(krl_int_in(cell));
}
static inline krl_register krl_register_of_BOOL(krl_cell cell)
{
    return cell == KRL_NOTHING ? (krl_register){0} : OF_BOOL(krl_int_in(cell));
}
static inline krl_register krl_register_of_REAL(krl_cell cell)
{
    return cell == KRL_NOTHING ? (krl_register){0} : OF_REAL(krl_real_in(cell));
}
static inline krl_register krl_register_of_ANY(krl_cell cell)
{
    return (krl_register){krl_tag_of(cell), krl_int_in(cell), krl_real_in(cell)};
}
static inline krl_cell krl_cell_of_INT(krl_register value)
{
    return HAS_VALUE(value) ? krl_of_int(value.bits) : KRL_NOTHING;
}
static inline krl_cell krl_cell_of_BOOL(krl_register value)
{
    return HAS_VALUE(value) ? krl_of_bool(value.bits) : KRL_NOTHING;
}
static inline krl_cell krl_cell_of_REAL(krl_register value)
{
    return HAS_VALUE(value) ? krl_of_real(value.real) : KRL_NOTHING;
}
static inline krl_cell krl_cell_of_ANY(krl_register value)
{
    return value.tag == KRL_TAG_REAL ? krl_of_real(value.real) : krl_tagged(value.tag, (uint32_t)value.bits);
}

#include "steps.h"

/* Calls in C that are open at once. */
enum { MOST_NESTED = 200 };

/* Runs from the step `at` on, or from the beginning if `at` is CALLED: then compiled code has called it. `left`,
 * `open` and `extent` stand for the fields of the machine, which have their values only while the interpreter runs.
 * Gives the statements left when the routine returns to compiled code, or 0 where the interpreter goes on. */
typedef int32_t krl_routine_in_c(struct krl_machine *machine, krl_cell *const fp, int32_t at, int32_t left,
                                 int32_t open, int32_t extent);
enum { CALLED = -1 };

#define CODE(number)                                                                               \
    static int32_t code_##number(struct krl_machine *machine, krl_cell *const fp, int32_t at,      \
                                 int32_t left, int32_t open, int32_t extent)
#define ENTER(number, count, is_owner)                                                             \
    enum { CODE = number };                                                                        \
    krl_cell *const cells = machine->cells;                                                        \
    krl_register registers[count];                                                                 \
    int32_t statement = -1, serial = 0;                                                            \
    if (LIKELY(at == CALLED)) {                                                                    \
        if (is_owner)                                                                              \
            serial = ++machine->serials;                                                           \
        goto start;                                                                                \
    }                                                                                              \
    statement = machine->statement;                                                                \
    serial = machine->serial;                                                                      \
    switch (at)
/* Between the frame and the copies of its cells that steps work on: of a type, or ANY. */
#define GET(number, type) registers[number] = krl_register_of_##type(fp[number]);
#define PUT(number, type) fp[number] = krl_cell_of_##type(registers[number]);
#define BLANK(number, type) registers[number] = (krl_register){0};
#define BLANK_CELLS(first, end)                                                                    \
    for (int32_t i = first; i < end; i++)                                                          \
        fp[i] = KRL_NOTHING;
/* A cell that has a value wherever the program comes from: no step need look again. */
#define GET_VALUE(number, type)                                                                    \
    GET(number, type)                                                                              \
    if (UNLIKELY(!HAS_VALUE(registers[number]))) {                                                 \
        machine->at = at;                                                                          \
        machine->is_begun = 0;                                                                     \
        return 0;                                                                                  \
    }
/* The beginning of statements of which only a fault can come between; and of each. */
#define BEGIN(number, count, save)                                                                 \
    if (UNLIKELY(left <= count)) {                                                                 \
        save                                                                                       \
        at = 4 * number;                                                                           \
        goto leave;                                                                                \
    }                                                                                              \
    left -= count;
#define STATEMENT(number) statement = steps[number].statement;
/* A step for the interpreter, before which `later` statements were counted that have not begun; `save` puts
 * back what lies on the stack of operands. */
#define INTERPRET(number, later, save)                                                             \
    {                                                                                              \
        save                                                                                       \
        left += later;                                                                             \
        at = 4 * number + 2;                                                                       \
        goto leave;                                                                                \
    }
#define DO(name, number, later, save, put, otherwise)                                              \
    {                                                                                              \
        int way = krl_step_##name(machine, cells, fp, registers, &steps[number]);                  \
        if (UNLIKELY(way >= 0))                                                                    \
            INTERPRET(number, later, save)                                                         \
        put otherwise                                                                              \
    }
#define JUMP_TO(target)                                                                            \
    if (way == KRL_GO_JUMP)                                                                        \
        goto target;
/* With the cells themselves, where a step needs them one behind the other. */
#define DO_IN_FRAME(name, number, later, save)                                                     \
    if (UNLIKELY(krl_step_##name(machine, cells, fp, registers, &steps[number]) >= 0))             \
        INTERPRET(number, later, save)
/* A frame of so many cells at `frame`, as `prepare` makes it; `save` puts back what nobody looks at unless
 * the interpreter goes on within the call. */
#define CALL(number, callee, size, frame, prepare, save)                                           \
    {                                                                                              \
        const int32_t behind = extent + steps[number].c;                                           \
        if (UNLIKELY(open >= machine->most_nested || size > KRL_MAX_CELLS - behind))               \
            INTERPRET(number, 0, save)                                                             \
        prepare left = code_##callee(machine, frame, CALLED, left, open + 1, behind);              \
        if (UNLIKELY(left == 0)) {                                                                 \
            machine->calls[open] = krl_call_of(cells, fp, &steps[number], number, CODE, extent,    \
                                               statement, serial);                                 \
            save return 0;                                                                         \
        }                                                                                          \
    }
#define RECEIVE(number)                                                                            \
    krl_receive(machine, &machine->routines[steps[number].b], fp + steps[number].d, fp + steps[number].a);
/* A call in C finds the result in the first cell of the frame. */
#define RETURN(number, save)                                                                       \
    if (UNLIKELY(open == machine->open))                                                           \
        INTERPRET(number, 0, save)                                                                 \
    return left;
#define RETURN_VALUE(number, save)                                                                 \
    if (UNLIKELY(!HAS_VALUE(registers[steps[number].b]) || open == machine->open))                 \
        INTERPRET(number, 0, save)                                                                 \
    fp[0] = CELL_OF(registers[steps[number].b]);                                                   \
    return left;
/* `at` is four times the step, and two more where the statement has begun: with one more, the C compiler would take
 * it from what says that a sum is too large, and would work that out as a number each time. */
#define LEAVE()                                                                                    \
    machine->at = at >> 2;                                                                         \
    machine->is_begun = at & 2;                                                                    \
    machine->fp = (int32_t)(fp - cells);                                                           \
    machine->left = left;                                                                          \
    machine->statement = statement;                                                                \
    machine->open = open;                                                                          \
    machine->code = CODE;                                                                          \
    machine->extent = extent;                                                                      \
    machine->serial = serial;                                                                      \
    return 0

/* What the module looks for: a function, and what both have to agree on. */
#define PROGRAM(...)                                                                               \
    void krl_go(struct krl_machine *machine, int32_t at)                                           \
    {                                                                                              \
        static krl_routine_in_c *const codes[] = {__VA_ARGS__};                                    \
        int32_t most = machine->open + MOST_NESTED;                                                \
        machine->most_nested = most < machine->most_calls ? most : machine->most_calls;            \
        codes[machine->code](machine, machine->cells + machine->fp, at, machine->left,             \
                             machine->open, machine->extent);                                      \
    }                                                                                              \
    const uint32_t krl_layout = KRL_LAYOUT;

#endif
