/* The interpreter of register code.
 *
 * It is one long function: only within one function can steps jump directly to each other and keep
 * the variables that all of them use in processor registers. register_code.h describes the operands
 * of steps, steps.h the effects of most of them; those that call and leave are in this file.
 * dispatch.h has the jumps from one to the next.
 */
#include "dispatch.h"

static const void *krl_handler(enum krl_stop why);

static struct krl_stopped interpret(struct krl_machine *machine, int32_t step, int is_begun,
                                    const void *const **handlers)
{
    struct krl_stopped stopped = {KRL_STOP_STEP, 0};
#if KRL_THREADED
#define LABELS(name) &&do_##name, &&begin_##name,
    static const void *const labels[] = {KRL_STEPS(LABELS) &&enter, &&broken};
    if (handlers != NULL) {
        *handlers = labels;
        return stopped;
    }
#else
    (void)handlers;
#endif
    krl_cell *const cells = machine->cells;
    krl_cell *fp = cells + machine->fp;
    const struct krl_step *pc = &machine->steps[step];
    int32_t left = machine->left, statement = machine->statement;
    int fault = KRL_FINE;

    if (machine->break_count && !is_begun && pc->handler == krl_handler(KRL_STOP_BREAK))
        goto broken;
#if KRL_THREADED
    goto *labels[2 * pc->op + (pc->statement >= 0 && !is_begun)];
    {
        {
#else
    int number_of_case = 2 * pc->op + (pc->statement >= 0 && !is_begun);
    for (;;) {
        switch (number_of_case) {
#endif
    KRL_ORDINARY_STEPS(ORDINARY)

    /* ---- calls */
    STEP(CALL) { goto calling; }
    STEP(CALL_COPY)
    {
    calling:;
        krl_cell *frame = krl_enter(machine, cells, fp, pc, (int32_t)(pc - machine->steps), statement);
        if (UNLIKELY(frame == NULL)) {
            fault = KRL_FAULT_STACK;
            goto failed;
        }
        fp = frame;
        statement = -1;
        pc = machine->routines[machine->code].entry;
        GO();
    }
    STEP(RETURN_VALUE)
    {
        krl_cell result = B;
        if (UNLIKELY(result == KRL_NOTHING)) {
            fault = KRL_FAULT_UNINITIALISED;
            goto failed;
        }
        if (machine->open > 0)
            krl_give(machine, cells, result);
        goto returning;
    }
    STEP(RETURN)
    {
    returning:
        if (machine->open == 0)
            goto finished;
        const struct krl_call *call = krl_return(machine);
        fp = cells + call->fp;
        statement = call->statement;
        if (UNLIKELY(call->step < 0)) {
            stopped.why = KRL_STOP_LEFT;
            goto stop;
        }
        pc = &machine->steps[call->step];
        GO();
    }
    STEP(END_ACTION)
    {
        stopped.why = KRL_STOP_ACTION;
        goto stop;
    }

    /* ---- other steps */
    STEP(SWITCH)
    {
        krl_cell number = B;
        if (UNLIKELY(number == KRL_NOTHING)) {
            fault = KRL_FAULT_UNINITIALISED;
            goto failed;
        }
        uint32_t entry = (uint32_t)krl_int_in(number) - (uint32_t)pc->c;
        if (entry < (uint32_t)pc->a) {
            pc += entry + 1;
            JUMP();
        }
        pc += pc->a;
        NEXT();
    }
    STEP(AT)
    {
        statement = pc->b;
        NEXT();
    }
    STEP(STOP)
    {
        if (LIKELY(krl_passes_stop(machine, &left)))
            NEXT();
        goto outside;
    }
    STEP(PYTHON)
    {
    outside:
        machine->top = (int32_t)(&A - cells);
        stopped.at = (int32_t)(pc - machine->steps);
        goto stop;
    }
#if !KRL_THREADED
    default:
        goto finished; /* there is no such step */
    dispatch:
        if (pc->handler == krl_handler(KRL_STOP_BREAK)) {
            if (!krl_passes_break(machine, fp, (int32_t)(pc - machine->steps)))
                goto broken;
        } else if (pc->handler != NULL)
            goto enter;
        number_of_case = 2 * pc->op + (pc->statement >= 0);
        continue;
#endif
    }
    }

enter:
    stopped.why = KRL_STOP_COMPILED;
    stopped.at = (int32_t)(pc - machine->steps);
    goto stop;

finished:
    stopped.why = KRL_STOP_END;
    goto stop;
broken: /* at the beginning of a statement the operand stack is empty */
#if KRL_THREADED
    if (krl_passes_break(machine, fp, (int32_t)(pc - machine->steps)))
        goto *labels[2 * pc->op + 1];
#endif
    stopped.why = KRL_STOP_BREAK;
    goto before;
wait:
    stopped.why = KRL_STOP_LINE;
before:
    stopped.at = (int32_t)(pc - machine->steps);
    goto bare;
failed: /* a statement that fails drops its operands */
    stopped.why = KRL_STOP_FAULT;
    stopped.at = fault;
bare:
    machine->top = (int32_t)(fp - cells) + machine->routines[machine->code].frame;
stop:
    machine->fp = (int32_t)(fp - cells);
    machine->left = left;
    machine->statement = statement;
    return stopped;
}

/* Returns the handler of a step before which the machine stops: to enter native code, or at a
 * breakpoint. */
static const void *krl_handler(enum krl_stop why)
{
    int is_break = why == KRL_STOP_BREAK;
#if KRL_THREADED
    const void *const *labels;
    interpret(NULL, 0, 0, &labels);
    return labels[2 * KRL_STEP_COUNT + is_break];
#else
    static const char places[2];
    return &places[is_break];
#endif
}

struct krl_stopped krl_run(struct krl_machine *machine, int32_t step, int is_begun)
{
    struct krl_stopped stopped = interpret(machine, step, is_begun, NULL);
    while (stopped.why == KRL_STOP_COMPILED) {
        machine->compiled(machine, stopped.at);
        stopped = interpret(machine, machine->at, machine->is_begun, NULL);
    }
    return stopped;
}

void krl_thread(struct krl_step *steps, int32_t count)
{
#if KRL_THREADED
    const void *const *labels;
    interpret(NULL, 0, 0, &labels);
    for (int32_t i = 0; i < count; i++)
        steps[i].handler = labels[2 * steps[i].op + (steps[i].statement >= 0)];
#else
    for (int32_t i = 0; i < count; i++)
        steps[i].handler = NULL;
#endif
}

void krl_stop_at(struct krl_step *step, enum krl_stop why)
{
    step->handler = krl_handler(why);
}
