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
static const struct krl_array arrays[];

#include "steps.h"

/* Calls in C that are open at once. */
enum { MOST_NESTED = 200 };

/* Runs from the step `at` on, or from the beginning where it is called in C, which is CALLED; `open` calls and
 * `extent` are what the machine has them for while it is not running. Gives the statements left when the
 * routine returns to a call in C, or 0 where the interpreter goes on. */
typedef int32_t krl_routine_in_c(struct krl_machine *machine, krl_cell *const fp, int32_t at, int32_t left,
                                 int32_t open, int32_t extent);
enum { CALLED = -1 };

#define CODE(number)                                                                               \
    static int32_t code_##number(struct krl_machine *machine, krl_cell *const fp, int32_t at,      \
                                 int32_t left, int32_t open, int32_t extent)
#define ENTER(number, count, is_owner)                                                             \
    enum { CODE = number };                                                                        \
    krl_cell *const cells = machine->cells;                                                        \
    krl_cell registers[count];                                                                     \
    int32_t statement = -1, serial = 0;                                                            \
    if (LIKELY(at == CALLED)) {                                                                    \
        if (is_owner)                                                                              \
            serial = ++machine->serials;                                                           \
        goto start;                                                                                \
    }                                                                                              \
    statement = machine->statement;                                                                \
    serial = machine->serial;                                                                      \
    switch (at)
/* Between the frame and the copies of its cells that steps work on. */
#define GET(number) registers[number] = fp[number];
#define PUT(number) fp[number] = registers[number];
#define BLANK(number) registers[number] = KRL_NOTHING;
#define BLANK_CELLS(first, end)                                                                    \
    for (int32_t i = first; i < end; i++)                                                          \
        fp[i] = KRL_NOTHING;
/* A cell that has a value wherever the program comes from: no step need look again. */
#define GET_VALUE(number)                                                                          \
    GET(number)                                                                                    \
    if (UNLIKELY(registers[number] == KRL_NOTHING)) {                                              \
        machine->at = at;                                                                          \
        machine->is_begun = 0;                                                                     \
        return 0;                                                                                  \
    }
/* The beginning of statements of which only a fault can come between; and of each. */
#define BEGIN(number, count)                                                                       \
    if (UNLIKELY(left <= count)) {                                                                 \
        at = 2 * number;                                                                           \
        goto leave;                                                                                \
    }                                                                                              \
    left -= count;
#define STATEMENT(number) statement = steps[number].statement;
/* A step for the interpreter, before which `later` statements were counted that have not begun. */
#define INTERPRET(number, later)                                                                   \
    {                                                                                              \
        left += later;                                                                             \
        at = 2 * number + 1;                                                                       \
        goto leave;                                                                                \
    }
#define DO(name, number, later, put, otherwise)                                                    \
    {                                                                                              \
        int way = krl_step_##name(machine, cells, fp, registers, &steps[number]);                  \
        if (UNLIKELY(way >= 0))                                                                    \
            INTERPRET(number, later)                                                               \
        put otherwise                                                                              \
    }
#define JUMP_TO(target)                                                                            \
    if (way == KRL_GO_JUMP)                                                                        \
        goto target;
/* With the cells themselves, where a step needs them one behind the other. */
#define DO_IN_FRAME(name, number, later)                                                           \
    if (UNLIKELY(krl_step_##name(machine, cells, fp, fp, &steps[number]) >= 0))                    \
        INTERPRET(number, later)
/* A frame of so many cells at `frame`, as `prepare` makes it; `save` puts back what nobody looks at unless
 * the interpreter goes on within the call. */
#define CALL(number, callee, size, frame, prepare, save)                                           \
    {                                                                                              \
        const int32_t behind = extent + steps[number].c;                                           \
        if (UNLIKELY(open >= machine->most_nested || size > KRL_MAX_CELLS - behind))               \
            INTERPRET(number, 0)                                                                   \
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
#define RETURN(number)                                                                             \
    if (UNLIKELY(open == machine->open))                                                           \
        INTERPRET(number, 0)                                                                       \
    return left;
#define RETURN_VALUE(number)                                                                       \
    if (UNLIKELY(registers[steps[number].b] == KRL_NOTHING || open == machine->open))              \
        INTERPRET(number, 0)                                                                       \
    fp[0] = registers[steps[number].b];                                                            \
    return left;
/* `at` is twice the step, and one more where the statement has begun. */
#define LEFT()                                                                                     \
    machine->at = at >> 1;                                                                         \
    machine->is_begun = at & 1;                                                                    \
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
