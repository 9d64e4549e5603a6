/* What the C of a program is written with (compiled.py): a function for each routine, a label for each step.
 *
 * A step does what the interpreter does (steps.h), but its operands are constants. The function works on copies of
 * the cells of its frame, which the C compiler keeps in registers of the processor. Interpreter and function take
 * turns: a fault, a request, the end of the budget, all that is out of the ordinary is left to the interpreter. The
 * function puts back what the interpreter needs (`OUT`), says where to go on, and ends, and so do all that have
 * called it, each noting its call. The interpreter does the step again; that nothing but operands has changed since
 * the place where it goes on is what register_flow.py sees to.
 */
#ifndef KRL_COMPILED_H
#define KRL_COMPILED_H

/* Here they would take constants from what says that a sum is too large, which then has to be a number each time. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-dominator-opts")
#endif

#include "vm/machine.h"

#define KRL_ARRAY(number) (&arrays[number])
#define krl_compute machine->outside->compute
#define krl_compose machine->outside->compose
#define krl_invert machine->outside->invert
#define krl_call_text machine->outside->call_text
#define krl_is_plain machine->outside->is_plain
static const struct krl_array arrays[];

/* ---------------------------------------------------------------------------- registers */

/* A register in three parts, of which the C compiler keeps what is used. */
typedef struct {
    enum krl_tag tag;
    int32_t bits; /* 0 for a REAL */
    float real;   /* 0 for all others */
} krl_register;
#define KRL_REGISTERS
#define REGISTER_OF(cell) krl_register_of_ANY(cell)
#define REGISTER_AT(place) krl_register_at(&(place))
#define CELL_OF(register) krl_cell_of_ANY(register)
#define HAS_VALUE(register) ((register).tag != KRL_TAG_NONE)
#define INT(register) (register).bits
#define REAL(register) (register).real
#define OF_INT(value) ((krl_register){KRL_TAG_INT, (value), 0})
#define OF_BOOL(value) ((krl_register){KRL_TAG_BOOL, (value) != 0, 0})
#define OF_REAL(value) ((krl_register){KRL_TAG_REAL, 0, (value)})
/* The step that takes this result finds it too: see `deferred` in register_flow.py. */
#define MUST_BE_FINITE (pc->tag == 0)

/* Of and to cells of a type. */
#define krl_register_of_INT(cell) ((krl_register){krl_tag_of(cell) ? KRL_TAG_INT : KRL_TAG_NONE, krl_int_in(cell), 0})
#define krl_register_of_BOOL(cell) ((krl_register){krl_tag_of(cell) ? KRL_TAG_BOOL : KRL_TAG_NONE, krl_int_in(cell), 0})
#define krl_register_of_REAL(cell) ((krl_register){krl_tag_of(cell) ? KRL_TAG_REAL : KRL_TAG_NONE, 0, krl_real_in(cell)})
#define krl_register_of_ANY(cell) ((krl_register){krl_tag_of(cell), krl_int_in(cell), krl_real_in(cell)})
#define krl_cell_of_INT(value) (HAS_VALUE(value) ? krl_of_int((value).bits) : KRL_NOTHING)
#define krl_cell_of_BOOL(value) (HAS_VALUE(value) ? krl_of_bool((value).bits) : KRL_NOTHING)
#define krl_cell_of_REAL(value) (HAS_VALUE(value) ? krl_of_real((value).real) : KRL_NOTHING)
static inline krl_cell krl_cell_of_ANY(krl_register value)
{
    return value.tag == KRL_TAG_REAL ? krl_of_real(value.real) : krl_tagged(value.tag, (uint32_t)value.bits);
}

/* The halves of a cell in memory are read one by one: no shifting, and only what is used. */
static inline krl_register krl_register_at(const krl_cell *cell)
{
    static const uint16_t one = 1;
    const char *bytes = (const char *)cell;
    int low = *(const char *)&one ? 0 : 4;
    uint32_t bits, tag;
    memcpy(&bits, bytes + low, sizeof bits);
    memcpy(&tag, bytes + (4 - low), sizeof tag);
    return (krl_register){(enum krl_tag)tag, (int32_t)bits, krl_real_of_bits(bits)};
}

/* REMEMBER_LOCAL and REMEMBER_DATA are there only where assignments are traced. */
#define REMEMBER(address) (void)((KRL_TRACED & KRL_TRACED_ASSIGN) && (machine->last = (address)))

#include "vm/steps.h"

/* ---------------------------------------------------------------------------- routines */

/* Calls in C that are open at once. */
enum { MOST_NESTED = 200 };

/* How a call ends: the statements left, or 0 where the interpreter goes on within it; and the bits of its result. */
typedef struct {
    int32_t left;
    uint64_t result;
} krl_ended;

/* `entry` is the step to go on at where the interpreter has come, or CALLED. `left` and `open` stand for the fields of
 * the machine, which have their values only while the interpreter runs. */
#define PARAMETERS struct krl_machine *machine, krl_cell *const fp, int32_t left, int32_t open
enum { CALLED = -1 };

/* A routine once for calls from compiled code, which hand over its first cells, and once for the interpreter. Where
 * both are this one INLINED, with a constant `entry`, the C compiler leaves out of each what only the other needs. */
#define INLINED static inline __attribute__((always_inline))
#define BODY(kind, number, ...)                                                                          \
    kind krl_ended body_##number(PARAMETERS, const int32_t entry, int32_t at, ##__VA_ARGS__)
#define ENTER(number, count, is_owner)                                                             \
    enum { CODE = number };                                                                        \
    krl_cell *const cells = machine->cells;                                                        \
    krl_register registers[count];                                                                 \
    int32_t statement = -1, serial = 0;                                                            \
    if (entry == CALLED) {                                                                         \
        if (is_owner)                                                                              \
            serial = ++machine->serials;                                                           \
        goto start;                                                                                \
    }                                                                                              \
    statement = machine->statement;                                                                \
    serial = machine->serial;                                                                      \
    switch (at)
/* Between the frame and the copies of its cells: of a type, or ANY; and from what a call hands over. */
#define GET(number, type) registers[number] = krl_register_of_##type(fp[number]);
#define PUT(number, type) fp[number] = krl_cell_of_##type(registers[number]);
#define TAKE(number, type) registers[number] = krl_register_of_##type(p##number);
#define TAKE_CELL(number, type) fp[number] = p##number;
/* The same of parameters that have a value in all calls: they are handed over as what C computes with. */
#define TAKE_VALUE(number, type) registers[number] = krl_register_of_##type(krl_cell_with_##type(p##number));
#define TAKE_VALUE_CELL(number, type) fp[number] = krl_cell_with_##type(p##number);
#define VALUE_INT INT
#define VALUE_BOOL INT
#define VALUE_REAL REAL
#define krl_cell_with_INT krl_of_int
#define krl_cell_with_BOOL krl_of_bool
#define krl_cell_with_REAL krl_of_real
#define BLANK(number, type) registers[number] = (krl_register){0};
#define BLANK_CELLS(first, end)                                                                    \
    for (int32_t i = first; i < end; i++)                                                          \
        fp[i] = KRL_NOTHING;
/* A cell that has a value wherever the program comes from: no step need look again. */
#define GET_VALUE(number, type)                                                                    \
    GET(number, type)                                                                              \
    if (UNLIKELY(!HAS_VALUE(registers[number]))) {                                                 \
        krl_stay(machine, at);                                                                     \
        return (krl_ended){0};                                                                     \
    }
/* The same where ways meet, for the C compiler, which need not look what it was on each of them. */
#define KNOWN(number, type) registers[number].tag = KRL_TAG_##type;
/* And of a parameter. */
#define NEED_VALUE(number, type)                                                                   \
    if (UNLIKELY(fp[number] == KRL_NOTHING)) {                                                     \
        krl_stay(machine, at);                                                                     \
        return;                                                                                    \
    }
/* The interpreter does itself what begins where it has come. */
static inline void krl_stay(struct krl_machine *machine, int32_t at)
{
    machine->at = at;
    machine->is_begun = 0;
}

/* ---------------------------------------------------------------------------- steps */

/* The beginning of statements of which only a fault can come between; and of each. */
#define BEGIN(number, count)                                                                       \
    if (UNLIKELY((left -= count) <= 0))                                                            \
        goto wait_##number;
#define STATEMENT(number) statement = steps[number].statement;
#define DO(name, number, out, put, otherwise)                                                      \
    {                                                                                              \
        int way = krl_step_##name(machine, cells, fp, registers, &steps[number]);                  \
        if (UNLIKELY(way >= 0))                                                                    \
            goto out_##out;                                                                        \
        put otherwise                                                                              \
    }
#define STOP(out)                                                                                  \
    if (UNLIKELY(!krl_passes_stop(machine, &left)))                                                \
        goto out_##out;
#define JUMP_TO(target)                                                                            \
    if (way == KRL_GO_JUMP)                                                                        \
        goto target;
/* The CASE steps from this one on that compare the same register. */
#define SWITCH(number, out)                                                                        \
    if (UNLIKELY(!HAS_VALUE(registers[steps[number].b])))                                          \
        goto out_##out;                                                                            \
    switch (INT(registers[steps[number].b]))
/* `prepare` makes the frame of the call; `save` puts back what is not read unless the interpreter goes on within it. */
#define CALL(number, out, function, frame, prepare, save, put, ...)                                \
    {                                                                                              \
        if (UNLIKELY(open >= machine->most_nested))                                                \
            goto out_##out;                                                                        \
        prepare krl_ended ended = function(machine, frame, left, open + 1, ##__VA_ARGS__);         \
        left = ended.left;                                                                         \
        if (UNLIKELY(left == 0)) {                                                                 \
            machine->calls[open] = krl_call_of(machine->cells, fp, &steps[number], number, CODE, 0, \
                                               statement, serial);                                 \
            save return ended;                                                                     \
        }                                                                                          \
        put                                                                                        \
    }
#define RECEIVE(number)                                                                            \
    krl_receive(machine, &machine->routines[steps[number].b], fp + steps[number].d, fp + steps[number].a);
#define RESULT(number, type)                                                                       \
    registers[number] = (krl_register){KRL_TAG_##type, krl_int_in(ended.result), krl_real_in(ended.result)};
#define RETURN(number)                                                                             \
    if (entry != CALLED)                                                                           \
        goto out_##number;                                                                         \
    return (krl_ended){left, 0};
#define RETURN_VALUE(number, out, type)                                                            \
    if (UNLIKELY(!HAS_VALUE(registers[steps[number].b])) || entry != CALLED)                       \
        goto out_##out;                                                                            \
    return (krl_ended){left, (uint32_t)krl_cell_with_##type(VALUE_##type(registers[steps[number].b]))};

/* ---------------------------------------------------------------------------- leaving */

/* Where the interpreter goes on: before statements that were counted here; or at a step whose statement has begun,
 * where `later` were counted that have not. `save` puts back what lies on the stack of operands. */
#define WAIT(number, count, save) wait_##number: save left += count; at = 4 * number; goto leave;
#define OUT(number, later, save) out_##number: save left += later; at = 4 * number + 2; goto leave;
/* `at` is four times the step, and two more where the statement has begun: with one more, the C compiler would take
 * it from what says that a sum is too large, and would work that out as a number each time. */
#define LEAVE()                                                                                    \
    machine->at = at >> 2;                                                                         \
    machine->is_begun = at & 2;                                                                    \
    machine->fp = (int32_t)(fp - machine->cells);                                                  \
    machine->left = left;                                                                          \
    machine->statement = statement;                                                                \
    machine->open = open;                                                                          \
    machine->code = CODE;                                                                          \
    machine->serial = serial;                                                                      \
    return (krl_ended){0}

/* How many calls may be open within a function that is entered: as many as there are cells for, where each has the
 * `largest` frame of all that are called. */
static inline int32_t krl_most_nested(const struct krl_machine *machine, int32_t largest)
{
    int32_t cells = KRL_MAX_CELLS - machine->extent - machine->routines[machine->code].frame;
    int32_t room = cells / (largest > 0 ? largest : 1);
    int32_t most = machine->open + (room < MOST_NESTED ? room : MOST_NESTED);
    return most < machine->most_calls ? most : machine->most_calls;
}

/* What the module looks for: a function, and what both have to agree on. */
typedef void krl_entry_from_interpreter(PARAMETERS, int32_t at);
#define PROGRAM(largest, ...)                                                                      \
    void krl_go(struct krl_machine *machine, int32_t at)                                           \
    {                                                                                              \
        static krl_entry_from_interpreter *const codes[] = {__VA_ARGS__};                          \
        int32_t before = machine->open;                                                            \
        machine->most_nested = krl_most_nested(machine, largest);                                  \
        codes[machine->code](machine, machine->cells + machine->fp, machine->left, before, at);    \
        for (int32_t i = before; i < machine->open; i++) {                                         \
            machine->calls[i].extent = machine->extent;                                            \
            machine->extent += steps[machine->calls[i].step - 1].c;                                \
        }                                                                                          \
    }                                                                                              \
    const uint32_t krl_layout = KRL_LAYOUT;

#endif
