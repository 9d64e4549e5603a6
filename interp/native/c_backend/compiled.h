/* Macros and functions for the C code of a program that compiled.py generates: a function for each
 * routine, with a label for each step.
 *
 * A step has the same effect as in the interpreter (steps.h), but its operands are constants. The
 * function works on copies of its frame's cells, which the C compiler keeps in processor registers.
 * It executes the common cases only. After a fault, at a request, at the end of the statement
 * budget and in all other cases the interpreter continues: the function stores the state that the
 * interpreter needs (`OUT`), sets the step to continue at, and returns, as do all its callers, each
 * recording its call. The interpreter executes the step again. It may restart at an earlier step;
 * register_flow.py (`restarts`) ensures that since then only stack registers have changed that were
 * not live.
 */
#ifndef KRL_COMPILED_H
#define KRL_COMPILED_H

/* These passes would derive constants from the overflow flag of an addition, and so force the flag
 * into a register each time. */
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

/* A register as three variables, of which the C compiler keeps those that are used. */
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
/* The tag is 1 if the step that uses the result detects its overflow: see `deferred` in
 * register_flow.py. */
#define MUST_BE_FINITE (pc->tag == 0)

/* Conversions from and to cells of a type, or of ANY. */
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

/* Loads the halves of a cell separately: that needs no shift, and the C compiler drops a half that
 * is not used. */
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

/* Only a trace of assignments needs the address. REMEMBER_LOCAL and REMEMBER_DATA exist only then. */
#define REMEMBER(address) (void)((KRL_TRACED & KRL_TRACED_ASSIGN) && (machine->last = (address)))

#include "vm/steps.h"

/* ---------------------------------------------------------------------------- routines */

/* The maximum depth of native calls. */
enum { MOST_NESTED = 200 };

/* The result of a native call: the statements left, or 0 if the interpreter has to continue in it;
 * and the value that the routine returns, as bits. */
typedef struct {
    int32_t left;
    uint64_t result;
} krl_ended;

/* `left` and `open` replace the fields of the machine, which are valid only while the interpreter
 * runs. `entry` is the step at which the interpreter enters, or CALLED. */
#define PARAMETERS struct krl_machine *machine, krl_cell *const fp, int32_t left, int32_t open
enum { CALLED = -1 };

/* The body of a routine has two callers: one function for calls from native code, which pass its
 * first cells as arguments, and one for the interpreter. If the body is INLINED, with a constant
 * `entry`, the C compiler removes from each what only the other one needs. */
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
/* GET and PUT copy a cell from and to the frame, by its type or ANY. TAKE stores an argument of a
 * native call in a register, TAKE_CELL in the frame. */
#define GET(number, type) registers[number] = krl_register_of_##type(fp[number]);
#define PUT(number, type) fp[number] = krl_cell_of_##type(registers[number]);
#define TAKE(number, type) registers[number] = krl_register_of_##type(p##number);
#define TAKE_CELL(number, type) fp[number] = p##number;
/* The same for parameters that have a value in every call: they are passed as C numbers, without a
 * tag. */
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
/* Loads a cell, at a loop head where the interpreter enters, that has a value on every path: no
 * step checks it again. If it has none, the interpreter continues. */
#define GET_VALUE(number, type)                                                                    \
    GET(number, type)                                                                              \
    if (UNLIKELY(!HAS_VALUE(registers[number]))) {                                                 \
        krl_stay(machine, at);                                                                     \
        return (krl_ended){0};                                                                     \
    }
/* Tells the C compiler, at a target, the tag of a register that has a value on every path. */
#define KNOWN(number, type) registers[number].tag = KRL_TAG_##type;
/* The check of GET_VALUE for a parameter, where the interpreter enters. */
#define NEED_VALUE(number, type)                                                                   \
    if (UNLIKELY(fp[number] == KRL_NOTHING)) {                                                     \
        krl_stay(machine, at);                                                                     \
        return;                                                                                    \
    }
/* Lets the interpreter execute the step at which it has entered. */
static inline void krl_stay(struct krl_machine *machine, int32_t at)
{
    machine->at = at;
    machine->is_begun = 0;
}

/* ---------------------------------------------------------------------------- steps */

/* BEGIN counts the statements of a basic block together, as only a fault can come between them.
 * STATEMENT begins each of them. */
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
/* Executes all CASE steps from this one on that compare the same register, as one switch. */
#define SWITCH(number, out)                                                                        \
    if (UNLIKELY(!HAS_VALUE(registers[steps[number].b])))                                          \
        goto out_##out;                                                                            \
    switch (INT(registers[steps[number].b]))
/* `prepare` stores arguments in the callee's frame. `save` stores the registers that are needed
 * only if the interpreter continues in the call. `put` stores the result. */
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

/* The interpreter continues: with WAIT before `count` statements, which BEGIN has counted; with OUT
 * at a step whose statement has begun, where `later` statements of the block have been counted but
 * have not begun. `save` stores the operand stack in the frame. */
#define WAIT(number, count, save) wait_##number: save left += count; at = 4 * number; goto leave;
#define OUT(number, later, save) out_##number: save left += later; at = 4 * number + 2; goto leave;
/* `at` is 4 times the step, plus 2 if the statement has begun. Not 1: the C compiler would derive
 * that from the overflow flag of an addition, and force the flag into a register each time. */
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

/* Returns how many calls may be open while native code runs: as many as there are cells for if each
 * has the `largest` frame of all compiled routines, and at most MOST_NESTED more than now. */
static inline int32_t krl_most_nested(const struct krl_machine *machine, int32_t largest)
{
    int32_t cells = KRL_MAX_CELLS - machine->extent - machine->routines[machine->code].frame;
    int32_t room = cells / (largest > 0 ? largest : 1);
    int32_t most = machine->open + (room < MOST_NESTED ? room : MOST_NESTED);
    return most < machine->most_calls ? most : machine->most_calls;
}

/* The symbols that the module looks up here: the function that enters native code, and the layout.
 * Calls that native code has recorded get their `extent` here. */
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
