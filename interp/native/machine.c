/* The machine's memory and frames. */
#include "machine.h"

#include <stdlib.h>

int krl_load(struct krl_machine *machine, const uint8_t *image, size_t length, int is_told,
             struct krl_refusal *why)
{
    memset(machine, 0, sizeof *machine);
    machine->is_told = is_told;
    machine->left = 1;
    if (!krl_read_image(&machine->program, image, length, why))
        return 0;
    if (!krl_verify(&machine->program, why) || !krl_translate(machine, why)) {
        krl_unload(machine);
        return 0;
    }
    for (int32_t number = 0; number < machine->program.code_count; number++) {
        const struct krl_routine *routine = &machine->routines[number];
        int32_t stack = routine->whole - routine->frame;
        machine->most_whole = routine->whole > machine->most_whole ? routine->whole : machine->most_whole;
        machine->most_stack = stack > machine->most_stack ? stack : machine->most_stack;
    }
    return 1;
}

void krl_unload(struct krl_machine *machine)
{
    free(machine->steps);
    free(machine->arrays);
    free(machine->cells);
    free(machine->calls);
    krl_free_program(&machine->program);
    memset(machine, 0, sizeof *machine);
}

/* Frames begin within the one before, behind its variables: together they have no more cells than
 * KRL_MAX_CELLS and all their places on the stack, nor than so many of the largest. */
int krl_reserve(struct krl_machine *machine)
{
    int64_t frames = (machine->most_calls > machine->open ? machine->most_calls : machine->open) + 2;
    int64_t sparse = KRL_MAX_CELLS + frames * machine->most_stack;
    int64_t dense = frames * machine->most_whole;
    int64_t cells = machine->program.data_cells + (dense < sparse ? dense : sparse) + 1;
    if (frames > KRL_MOST_CALLS + 2 || cells > INT32_MAX / (int64_t)sizeof(krl_cell))
        return 0;
    if (frames > machine->call_capacity) {
        struct krl_call *calls = realloc(machine->calls, (size_t)frames * sizeof *calls);
        if (calls == NULL)
            return 0;
        machine->calls = calls;
        machine->call_capacity = (int32_t)frames;
    }
    if (cells > machine->cell_count) {
        /* Zeros that nobody has looked at cost no memory: what is there is copied, and no more. */
        krl_cell *found = calloc((size_t)cells, sizeof *found);
        if (found == NULL)
            return 0;
        if (machine->cells != NULL)
            memcpy(found, machine->cells,
                   (size_t)(machine->fp + machine->routines[machine->code].whole) * sizeof *found);
        free(machine->cells);
        machine->cells = found;
        machine->cell_count = (int32_t)cells;
    }
    return 1;
}

void krl_begin(struct krl_machine *machine, int32_t code)
{
    const struct krl_program *program = &machine->program;
    memset(machine->cells, 0, (size_t)(program->data_cells + machine->routines[code].whole) * sizeof(krl_cell));
    for (int32_t i = 0; i < program->initial_count; i++)
        machine->cells[program->initial[i].address] = program->initial[i].cell;
    machine->code = code;
    machine->fp = machine->extent = program->data_cells;
    machine->statement = -1;
    machine->serial = machine->serials = 1;
    machine->open = 0;
    machine->last = 0;
    machine->top = machine->fp + machine->routines[code].frame;
}

int krl_open(struct krl_machine *machine, int32_t code)
{
    const struct krl_routine *caller = &machine->routines[machine->code], *callee = &machine->routines[code];
    int32_t extent = machine->extent + caller->frame;
    if (callee->frame > KRL_MAX_CELLS - extent || !krl_reserve(machine))
        return 0;
    machine->calls[machine->open++] =
        (struct krl_call){-1,
                          machine->code,
                          machine->fp,
                          machine->extent,
                          machine->statement,
                          machine->serial,
                          machine->fp + caller->whole,
                          machine->top};
    machine->code = code;
    machine->fp += caller->whole;
    machine->extent = extent;
    machine->statement = -1;
    machine->serial = 0;
    memset(machine->cells + machine->fp, 0, (size_t)callee->whole * sizeof(krl_cell));
    return 1;
}

void krl_close(struct krl_machine *machine)
{
    const struct krl_call *call = &machine->calls[--machine->open];
    machine->code = call->code;
    machine->fp = call->fp;
    machine->extent = call->extent;
    machine->statement = call->statement;
    machine->serial = call->serial;
    machine->top = call->step < 0 ? call->top : machine->fp + machine->routines[machine->code].frame;
}
