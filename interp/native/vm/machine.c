/* The machine's memory and frames. */
#include "machine.h"

#include <stdlib.h>

void krl_unload(struct krl_machine *machine)
{
    free(machine->steps);
    free(machine->breaks);
    free(machine->arrays);
    free(machine->calls);
    if (machine->memory != NULL && --machine->memory->users == 0) {
        free(machine->memory->cells);
        free(machine->memory);
    }
    krl_free_program(&machine->program);
    memset(machine, 0, sizeof *machine);
}

/* Returns how many cells a number of frames can need. A frame begins in the one before, behind the
 * variables. So together they have at most KRL_MAX_CELLS and all operand stacks; and at most the
 * cells of the largest frame, so many times. */
static int64_t frames_need(const struct krl_machine *machine, int64_t frames)
{
    int64_t sparse = KRL_MAX_CELLS + frames * machine->most_stack;
    int64_t dense = frames * machine->most_whole;
    return (dense < sparse ? dense : sparse) + 1;
}

/* Makes the memory larger; returns 0 if there is not enough. With calloc, pages that are never
 * touched cost nothing. */
static int extend(struct krl_memory *memory, int64_t count)
{
    krl_cell *cells = NULL;
    if (count <= INT32_MAX / (int64_t)sizeof *cells)
        cells = calloc((size_t)count, sizeof *cells);
    if (cells == NULL)
        return 0;
    if (memory->cells != NULL)
        memcpy(cells, memory->cells, (size_t)memory->count * sizeof *cells);
    free(memory->cells);
    memory->cells = cells;
    memory->count = (int32_t)count;
    return 1;
}

static void fill_data(struct krl_machine *machine)
{
    const struct krl_program *program = &machine->program;
    for (int32_t i = 0; i < program->initial_count; i++)
        machine->memory->cells[program->initial[i].address] = program->initial[i].cell;
}

int krl_give_memory(struct krl_machine *machine, int32_t most_calls, struct krl_machine *beside)
{
    int64_t frames = (int64_t)most_calls + KRL_MOST_ENTERED + 2;
    if (most_calls < 0 || most_calls > KRL_MOST_CALLS)
        return 0;
    if (beside != NULL && beside->checksum != machine->checksum)
        return 0;
    machine->most_calls = most_calls;
    machine->calls = calloc((size_t)frames, sizeof *machine->calls);
    machine->memory = beside != NULL ? beside->memory : calloc(1, sizeof *machine->memory);
    if (machine->memory == NULL)
        return 0;
    machine->memory->users++; /* krl_unload releases it, also if the next allocation has failed */
    if (machine->calls == NULL)
        return 0;
    machine->call_capacity = (int32_t)frames;
    machine->first = beside != NULL ? machine->memory->count : machine->program.data_cells;
    if (!extend(machine->memory, machine->first + frames_need(machine, frames)))
        return 0;
    machine->end = machine->memory->count;
    if (beside == NULL)
        fill_data(machine);
    return 1;
}

int krl_ready(struct krl_machine *machine)
{
    machine->cells = machine->memory->cells;
    return machine->most_calls < machine->call_capacity && machine->open < machine->call_capacity &&
           machine->fp >= machine->first &&
           machine->fp + machine->routines[machine->code].whole <= machine->end;
}

void krl_begin(struct krl_machine *machine, int32_t code)
{
    memset(machine->cells + machine->first, 0, (size_t)machine->routines[code].whole * sizeof(krl_cell));
    machine->code = code;
    machine->fp = machine->first;
    machine->extent = machine->program.data_cells;
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
    if (callee->frame > KRL_MAX_CELLS - extent || machine->open >= machine->call_capacity - 1)
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

int krl_passes_break(const struct krl_machine *machine, const krl_cell *fp, int32_t step)
{
    const struct krl_break *found = machine->breaks, *end = found + machine->break_count;
    while (found < end && found->step != step)
        found++;
    if (found == end || found->relation < 0)
        return 0;
    const krl_cell *place = (found->is_of_frame ? fp : machine->cells) + found->cell;
    if (place >= machine->cells + machine->memory->count || krl_tag_of(*place) != krl_tag_of(found->right))
        return 0;
    int32_t left = krl_int_in(*place), right = krl_int_in(found->right);
    const int holds[] = {left == right, left != right, left < right, left > right, left <= right, left >= right};
    return !holds[found->relation];
}
