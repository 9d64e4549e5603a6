/* The interpreter: what each step does.
 *
 * It is one long function: only within one can steps go straight to one another and keep what they
 * all use in registers. register_code.h says what their operands are. What they are written with stands in
 * dispatch.h, what they do with arrays in array_operations.h.
 */
#include "array_operations.h"
#include "dispatch.h"

/* Puts arguments, of which structures are references, into a frame, and takes the rest's values away. */
static void receive(struct krl_machine *machine, const struct krl_routine *callee, krl_cell *frame,
                    const krl_cell *arguments)
{
    const struct krl_code *code = callee->code;
    for (int32_t i = 0; i < code->parameter_count; i++) {
        const struct krl_slot *slot = &code->slots[i];
        int is_copied = slot->handed.mode == KRL_BY_VALUE &&
                        !krl_is_plain(&machine->program, slot->handed.type);
        const krl_cell *given = is_copied ? machine->cells + krl_int_in(*arguments) : arguments;
        krl_copy_cells(frame + slot->offset, given, slot->cells);
        arguments += krl_stack_cells(&slot->handed);
    }
    krl_blank_cells(frame + callee->received, callee->frame - callee->received);
}

static struct krl_stopped interpret(struct krl_machine *machine, int32_t step, int is_begun,
                                    const void *const **handlers)
{
    struct krl_stopped stopped = {KRL_STOP_STEP, 0};
#if KRL_THREADED
#define LABELS(name) &&do_##name, &&begin_##name,
    static const void *const labels[] = {KRL_STEPS(LABELS)};
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

#if KRL_THREADED
    goto *labels[2 * pc->op + (pc->statement >= 0 && !is_begun)];
    {
        {
#else
    int number_of_case = 2 * pc->op + (pc->statement >= 0 && !is_begun);
    for (;;) {
        switch (number_of_case) {
#endif
    /* ---- where to go on */
    STEP(JUMP) { JUMP(); }
    STEP(JUMP_IF)
    {
        READ(b, B);
        if (krl_int_in(b))
            JUMP();
        NEXT();
    }
    STEP(JUMP_UNLESS)
    {
        READ(b, B);
        if (krl_int_in(b))
            NEXT();
        JUMP();
    }
    STEP(CASE)
    {
        READ(b, B);
        if (krl_int_in(b) == pc->c)
            JUMP();
        NEXT();
    }
    FOR_STEP(FOR_UP, A, <=)
    FOR_STEP(FOR_DOWN, A, >=)
    FOR_STEP(FOR_DATA_UP, cells[pc->a], <=)
    FOR_STEP(FOR_DATA_DOWN, cells[pc->a], >=)
#define RELATION_STEPS_(name, operator) RELATION_STEPS(name, operator)
    KRL_COMPARISONS(RELATION_STEPS_)

    /* ---- moving */
    STEP(NOP) { NEXT(); }
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
        A = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
        NEXT();
    }
    STEP(GET_DATA)
    {
        READ(b, cells[pc->b]);
        A = b;
        NEXT();
    }
    STEP(PUT_DATA)
    {
        READ(b, B);
        cells[pc->a] = b;
        NEXT();
    }
    STEP(PUT_DATA_K)
    {
        cells[pc->a] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
        NEXT();
    }
    STEP(REFER)
    {
        A = krl_of_int((int32_t)(&B - cells));
        NEXT();
    }
    STEP(OFFSET)
    {
        READ(b, B);
        A = krl_of_int(krl_int_in(b) + pc->c);
        NEXT();
    }
    STEP(LOAD)
    {
        READ(b, B);
        READ(found, cells[krl_int_in(b)]);
        A = found;
        NEXT();
    }
    STEP(STORE)
    {
        READ(address, A);
        READ(value, B);
        machine->last = krl_int_in(address);
        cells[krl_int_in(address)] = value;
        NEXT();
    }
    STEP(STORE_K)
    {
        READ(address, A);
        machine->last = krl_int_in(address);
        cells[krl_int_in(address)] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
        NEXT();
    }

    /* ---- elements */
    ACCESS_STEPS(LOCAL, fp, FIND_ONE)
    ACCESS_STEPS(DATA, cells, FIND_ONE)
    ACCESS_STEPS(WIDE_LOCAL, fp, FIND_WIDE)
    ACCESS_STEPS(WIDE_DATA, cells, FIND_WIDE)
    ACCESS_STEPS(TWO_LOCAL, fp, FIND_TWO)
    ACCESS_STEPS(TWO_DATA, cells, FIND_TWO)
    ELEMENT_STEPS(GET_LOCAL, PUT_LOCAL, fp, FIND_ONE)
    ELEMENT_STEPS(GET_ELEMENT_DATA, PUT_ELEMENT_DATA, cells, FIND_ONE)
    ELEMENT_STEPS(GET_WIDE_LOCAL, PUT_WIDE_LOCAL, fp, FIND_WIDE)
    ELEMENT_STEPS(GET_WIDE_DATA, PUT_WIDE_DATA, cells, FIND_WIDE)
    ELEMENT_STEPS(GET_TWO_LOCAL, PUT_TWO_LOCAL, fp, FIND_TWO)
    ELEMENT_STEPS(GET_TWO_DATA, PUT_TWO_DATA, cells, FIND_TWO)
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
    STEP(INDEX_ANY)
    {
        const struct krl_array *array = &machine->arrays[pc->c];
        int32_t place = krl_flat_place(array->sizes, array->dimensions, &B);
        FAULT_IF(place < 0, index_);
        int32_t base = pc->tag == 0   ? krl_int_in(A)
                       : pc->tag == 1 ? (int32_t)(fp - cells) + array->base
                                      : array->base;
        A = krl_of_int(base + place * array->width);
        NEXT();
    }
    STEP(INDEX_VIEW)
    {
        READ(index, B);
        READ(base, C);
        uint32_t number = (uint32_t)index - 1;
        FAULT_IF(number >= (uint32_t)krl_int_in(fp[pc->c + 1]), index_);
        A = krl_of_int(krl_int_in(base) + (int32_t)number * pc->d);
        NEXT();
    }
    STEP(INDEX_VIEW_ANY)
    {
        int32_t sizes[KRL_MOST_DIMENSIONS];
        READ(base, C);
        krl_view_sizes(&C, pc->tag, sizes);
        int32_t place = krl_flat_place(sizes, pc->tag, &A);
        FAULT_IF(place < 0, index_);
        A = krl_of_int(krl_int_in(base) + place * pc->d);
        NEXT();
    }
    STEP(ROW)
    {
        const struct krl_array *array = &machine->arrays[pc->c];
        int32_t place = krl_flat_place(array->sizes, pc->b, &A + 1), width = array->width;
        FAULT_IF(place < 0, index_);
        for (int32_t i = pc->b; i < array->dimensions; i++)
            width *= array->sizes[i];
        A = krl_of_int(krl_int_in(A) + place * width);
        for (int32_t i = pc->b; i < array->dimensions; i++)
            (&A)[1 + i - pc->b] = krl_of_int(array->sizes[i]);
        NEXT();
    }
    STEP(ROW_VIEW)
    {
        int32_t sizes[KRL_MOST_DIMENSIONS], width = pc->d;
        READ(base, C);
        krl_view_sizes(&C, pc->tag, sizes);
        for (int32_t i = pc->b; i < pc->tag; i++)
            width *= sizes[i];
        int32_t place = krl_flat_place(sizes, pc->b, &A);
        FAULT_IF(place < 0, index_);
        A = krl_of_int(krl_int_in(base) + place * width);
        for (int32_t i = pc->b; i < pc->tag; i++)
            (&A)[1 + i - pc->b] = krl_of_int(sizes[i]);
        NEXT();
    }

    /* ---- blocks of cells; references in place always have values */
    STEP(COPY)
    {
        machine->last = krl_int_in(A);
        krl_copy_cells(cells + krl_int_in(A), cells + krl_int_in(B), pc->c);
        NEXT();
    }
    STEP(CLEAR)
    {
        krl_blank_cells(cells + krl_int_in(A), pc->c);
        NEXT();
    }
    STEP(FILL_POSE)
    {
        krl_cell *target = cells + krl_int_in(A);
        machine->last = krl_int_in(A);
        krl_copy_cells(target, cells + krl_int_in(B), pc->d);
        krl_blank_cells(target + pc->d, pc->c - pc->d);
        NEXT();
    }
    STEP(FILL_ARRAY)
    {
        fault = krl_fill_array(cells, &A, &B, pc->c, pc->d);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        machine->last = krl_int_in(A);
        NEXT();
    }
    STEP(COPY_VIEW)
    {
        int32_t length = pc->d;
        for (int32_t i = 1; i <= pc->tag; i++)
            length *= krl_int_in((&A)[i]);
        FAULT_IF(length > pc->c, stack);
        krl_copy_cells(&B, cells + krl_int_in(A), length);
        A = krl_of_int((int32_t)(&B - cells));
        NEXT();
    }
    STEP(SET_TEXT)
    {
        machine->last = krl_int_in(A);
        krl_set_text(cells + krl_int_in(A), krl_int_in((&A)[1]), &machine->program.texts[pc->b]);
        NEXT();
    }
    STEP(COMPOSE)
    {
        fault = krl_compose(cells + krl_int_in(A), cells + krl_int_in(B), cells + krl_int_in(C), pc->d);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        NEXT();
    }
    STEP(INVERT)
    {
        fault = krl_invert(cells + krl_int_in(B), cells + krl_int_in(A), pc->c);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        NEXT();
    }

    /* ---- computing */
    INT_STEP(ADD_INT, adds)
    INT_STEP(SUB_INT, subtracts)
    INT_STEP(MUL_INT, multiplies)
    INT_STEP_K(ADD_INT_K, adds)
    INT_STEP_K(MUL_INT_K, multiplies)
    STEP(DIV_INT)
    {
        READ(b, B);
        READ(c, C);
        int32_t divisor = krl_int_in(c);
        FAULT_IF(divisor == 0, division_by_zero);
        if (UNLIKELY(divisor == -1))
            INT_RESULT(subtracts, 0, krl_int_in(b));
        A = krl_of_int(krl_int_in(b) / divisor);
        NEXT();
    }
    STEP(DIV_INT_K) /* neither 0 nor -1 */
    {
        READ(b, B);
        A = krl_of_int(krl_int_in(b) / pc->c);
        NEXT();
    }
    STEP(NEG_INT)
    {
        READ(b, B);
        INT_RESULT(subtracts, 0, krl_int_in(b));
    }
    STEP(NOT_BITS)
    {
        READ(b, B);
        A = krl_of_int(~krl_int_in(b));
        NEXT();
    }
    BIT_STEP(AND_BITS, krl_of_int, &)
    BIT_STEP(OR_BITS, krl_of_int, |)
    BIT_STEP(EXOR_BITS, krl_of_int, ^)
    BIT_STEP(AND_BOOL, krl_of_bool, &)
    BIT_STEP(OR_BOOL, krl_of_bool, |)
    BIT_STEP(EXOR_BOOL, krl_of_bool, ^)
    STEP(AND_BITS_K)
    {
        READ(b, B);
        A = krl_of_int(krl_int_in(b) & pc->c);
        NEXT();
    }
    STEP(NOT_BOOL)
    {
        READ(b, B);
        A = krl_of_bool(!krl_int_in(b));
        NEXT();
    }
    REAL_STEP(ADD, +)
    REAL_STEP(SUB, -)
    REAL_STEP(MUL, *)
    STEP(DIV_REAL)
    {
        READ(b, B);
        READ(c, C);
        FAULT_IF(krl_real_in(c) == 0, division_by_zero);
        REAL_RESULT(krl_real_in(b) / krl_real_in(c));
    }
    STEP(DIV_REAL_K) /* not zero */
    {
        READ(b, B);
        REAL_RESULT(krl_real_in(b) / krl_real_of_bits((uint32_t)pc->c));
    }
    STEP(NEG_REAL)
    {
        READ(b, B);
        A = krl_of_real(-krl_real_in(b));
        NEXT();
    }
    STEP(INT_TO_REAL)
    {
        READ(b, B);
        A = krl_of_real((float)krl_int_in(b));
        NEXT();
    }
    STEP(REAL_TO_INT)
    {
        READ(b, B);
        int32_t result;
        FAULT_IF(rounds(krl_real_in(b), &result), overflow);
        A = krl_of_int(result);
        NEXT();
    }
    STEP(INT_TO_CHAR)
    {
        READ(b, B);
        if (UNLIKELY((uint32_t)krl_int_in(b) > 255))
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
            other = krl_real_in(c);
        }
        fault = krl_compute((enum krl_function)pc->tag, krl_real_in(b), other, &result);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        A = krl_of_real(result);
        NEXT();
    }
    STEP(TEXT)
    {
        krl_call_text(machine, (enum krl_text_function)pc->tag, &machine->program.builtins[pc->b], &A);
        NEXT();
    }

    /* ---- calls */
    STEP(CALL)
    {
        OPEN_CALL();
        fp = &A;
        call->result = (int32_t)(fp - cells);
        for (int32_t i = callee->received; i < callee->frame; i++)
            fp[i] = KRL_NOTHING;
        ENTER();
    }
    STEP(CALL_COPY)
    {
        OPEN_CALL();
        call->result = (int32_t)(&A - cells);
        receive(machine, callee, fp + pc->d, &A);
        fp += pc->d;
        ENTER();
    }
    STEP(CHECK_CALL)
    {
        FAULT_IF(machine->open >= machine->most_calls ||
                     machine->routines[pc->b].frame > KRL_MAX_CELLS - (machine->extent + pc->c),
                 stack);
        NEXT();
    }
    STEP(RETURN_VALUE)
    {
        READ(b, B);
        if (machine->open == 0)
            goto finished;
        machine->top = machine->calls[machine->open - 1].result;
        cells[machine->top++] = b;
        goto returning;
    }
    STEP(RETURN)
    {
        if (machine->open == 0)
            goto finished;
    returning:;
        const struct krl_call *call = &machine->calls[--machine->open];
        machine->code = call->code;
        fp = cells + call->fp;
        machine->extent = call->extent;
        statement = call->statement;
        machine->serial = call->serial;
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

    /* ---- the rest */
    STEP(AT)
    {
        statement = pc->b;
        NEXT();
    }
    STEP(FAIL)
    {
        fault = pc->b;
        goto failed;
    }
    STEP(REMEMBER_LOCAL)
    {
        machine->last = (int32_t)(&A - cells);
        NEXT();
    }
    STEP(REMEMBER_DATA)
    {
        machine->last = pc->a;
        NEXT();
    }
    STEP(PYTHON)
    {
        machine->top = (int32_t)(&A - cells);
        stopped.at = (int32_t)(pc - machine->steps);
        goto stop;
    }
#if !KRL_THREADED
    default:
        goto finished; /* there is no such step */
    dispatch:
        number_of_case = 2 * pc->op + (pc->statement >= 0);
        continue;
#endif
    }
    }

finished:
    stopped.why = KRL_STOP_END;
    goto stop;
wait:
    stopped.why = KRL_STOP_LINE;
    stopped.at = (int32_t)(pc - machine->steps);
    goto stop;
uninitialised:
    FAULT(UNINITIALISED);
overflow:
    FAULT(OVERFLOW);
division_by_zero:
    FAULT(DIVISION_BY_ZERO);
index_:
    FAULT(INDEX);
stack:
    FAULT(STACK);
failed:
    stopped.why = KRL_STOP_FAULT;
    stopped.at = fault;
stop:
    machine->fp = (int32_t)(fp - cells);
    machine->left = left;
    machine->statement = statement;
    return stopped;
}

struct krl_stopped krl_run(struct krl_machine *machine, int32_t step, int is_begun)
{
    return interpret(machine, step, is_begun, NULL);
}

void krl_thread(struct krl_step *steps, int32_t count)
{
#if KRL_THREADED
    const void *const *labels;
    interpret(NULL, 0, 0, &labels);
    for (int32_t i = 0; i < count; i++)
        steps[i].handler = labels[2 * steps[i].op + (steps[i].statement >= 0)];
#else
    (void)steps;
    (void)count;
#endif
}
