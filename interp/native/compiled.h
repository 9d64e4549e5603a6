/* What programs are written with that were made from register code (compiled.py): a function for each
 * code object, a label for each step. A step is done as by the interpreter (steps.h), but is constant.
 *
 * A call is one in C, up to a depth. What stops leaves everything as the interpreter does, and returns through
 * all of them; to go on, `krl_go` enters the routine that runs, and when it ends the one it was called by.
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

/* How a function ends: its routine has, the machine stops, the routine that runs now was not called in C,
 * there is no way in at the step. */
enum { RETURNED, STOPPED, DEEPER, NOWHERE };
enum { MOST_NESTED = 200 };

typedef int krl_function_of_code(struct krl_machine *machine, krl_cell *const cells, krl_cell *const fp,
                                 int is_begun, int nested, struct krl_stopped *stopped);

#define CODE(number)                                                                               \
    static int code_##number(struct krl_machine *machine, krl_cell *const cells, krl_cell *const fp, \
                             int is_begun, int nested, struct krl_stopped *stopped)
#define ENTER(first, count)                                                                        \
    int32_t left = machine->left, statement = machine->statement, at = stopped->at;                \
    int fault;                                                                                     \
    krl_cell registers[count];                                                                     \
    if (at == first && !is_begun && statement < 0)                                                 \
        goto start;
#define ENTRIES() switch (2 * at + (is_begun != 0))
/* Between the frame and the copies of its cells that steps work on. */
#define GET(number) registers[number] = fp[number];
#define PUT(number) fp[number] = registers[number];
#define BLANK(number) registers[number] = KRL_NOTHING;
/* The labels before a step and before the statement that begins with it. */
#define WAY_IN(number, begin)                                                                      \
    case 2 * number:                                                                               \
        goto begin;                                                                                \
    case 2 * number + 1:                                                                           \
        goto do_##number;
#define BEGIN(number)                                                                              \
    begin_##number : if (UNLIKELY(left <= 1))                                                      \
    {                                                                                              \
        at = number;                                                                               \
        goto wait;                                                                                 \
    }                                                                                              \
    left--;                                                                                        \
    statement = steps[number].statement;
#define LABEL(number) do_##number:;
#define DO(name, number, put)                                                                      \
    fault = krl_step_##name(machine, cells, fp, registers, &steps[number]);                        \
    put if (UNLIKELY(fault >= 0))                                                                      \
        goto failed;
/* With the cells themselves, where a step needs them one behind the other. */
#define DO_IN_FRAME(name, number)                                                                  \
    fault = krl_step_##name(machine, cells, fp, fp, &steps[number]);                               \
    if (UNLIKELY(fault >= 0))                                                                      \
        goto failed_in_frame;
#define BRANCH(name, number, put, target)                                                          \
    DO(name, number, put)                                                                          \
    if (fault == KRL_GO_JUMP)                                                                      \
        goto target;
/* `save` puts back what nobody looks at unless the machine stops within the call. */
#define CALL(number, callee, entry, save)                                                          \
    {                                                                                              \
        krl_cell *frame = krl_enter(machine, cells, fp, &steps[number], number, statement);        \
        fault = KRL_FAULT_STACK;                                                                   \
        if (UNLIKELY(frame == NULL))                                                               \
            goto failed_in_frame;                                                                        \
        machine->left = left;                                                                      \
        machine->statement = -1;                                                                   \
        stopped->at = entry;                                                                       \
        if (UNLIKELY(nested >= MOST_NESTED)) {                                                     \
            save machine->fp = (int32_t)(frame - cells);                                           \
            return DEEPER;                                                                         \
        }                                                                                          \
        int how = code_##callee(machine, cells, frame, 0, nested + 1, stopped);                    \
        if (UNLIKELY(how != RETURNED)) {                                                           \
            save return how;                                                                       \
        }                                                                            \
        left = machine->left;                                                                      \
    }
#define RETURN_VALUE(number)                                                                       \
    {                                                                                              \
        krl_cell result = registers[steps[number].b];                                                     \
        fault = KRL_FAULT_UNINITIALISED;                                                           \
        if (UNLIKELY(result == KRL_NOTHING))                                                       \
            goto failed;                                                                           \
        if (machine->open > 0)                                                                     \
            krl_give(machine, cells, result);                                                      \
        goto returning;                                                                            \
    }
#define RETURN(number) goto returning;
#define END_ACTION(number)                                                                         \
    stopped->why = KRL_STOP_ACTION;                                                 \
    stopped->at = 0;                                                                               \
    goto stop;
#define AT(number) statement = steps[number].b;
#define PYTHON(number)                                                                             \
    machine->top = (int32_t)(fp + steps[number].a - cells);                          \
    stopped->why = KRL_STOP_STEP;                                                                  \
    stopped->at = number;                                                                          \
    goto stop;
#define LEAVE()                                                                                    \
    returning:                                                                                     \
    if (UNLIKELY(machine->open == 0)) {                                                            \
        stopped->why = KRL_STOP_END;                                                               \
        stopped->at = 0;                                                                           \
        goto stop;                                                                                 \
    }                                                                                              \
    const struct krl_call *call = krl_return(machine);                                             \
    machine->left = left;                                                                          \
    if (nested > 0)                                                                                \
        return RETURNED;                                                                           \
    machine->fp = call->fp;                                                                        \
    machine->statement = call->statement;                                                          \
    stopped->why = KRL_STOP_LEFT;                                                                  \
    stopped->at = call->step < 0 ? 0 : call->step;                                                 \
    return call->step < 0 ? STOPPED : RETURNED;                                                    \
    wait:                                                                                          \
    stopped->why = KRL_STOP_LINE;                                                                  \
    stopped->at = at;                                                                              \
    goto stop;                                                                                     \
    failed_in_frame:                                                                               \
    stopped->why = KRL_STOP_FAULT;                                                                 \
    stopped->at = fault;                                                                           \
    goto stop_in_frame;                                                                            \
    failed:                                                                                        \
    stopped->why = KRL_STOP_FAULT;                                                                 \
    stopped->at = fault;                                                                           \
    stop:
#define STOP()                                                                                     \
    stop_in_frame:                                                                                 \
    machine->fp = (int32_t)(fp - cells);                                                           \
    machine->left = left;                                                                          \
    machine->statement = statement;                                                                \
    return STOPPED

/* Runs from the step that `stopped` has; 0 where there is no way in there. */
#define PROGRAM(...)                                                                               \
    int krl_go(struct krl_machine *machine, int *is_begun, struct krl_stopped *stopped)            \
    {                                                                                              \
        static krl_function_of_code *const codes[] = {__VA_ARGS__};                                \
        for (int how = DEEPER; how != STOPPED; *is_begun = 0) {                                     \
            how = codes[machine->code](machine, machine->cells, machine->cells + machine->fp,      \
                                       *is_begun, 0, stopped);                                     \
            if (how == NOWHERE)                                                                    \
                return 0;                                                                          \
        }                                                                                          \
        return 1;                                                                                  \
    }                                                                                              \
    const uint32_t krl_layout = KRL_LAYOUT;

#endif
