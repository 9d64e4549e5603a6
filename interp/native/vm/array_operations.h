/* Blocks of cells: elements, views, arrays, texts. Inline, as run.c does this within its steps. */
#ifndef KRL_ARRAY_OPERATIONS_H
#define KRL_ARRAY_OPERATIONS_H

#include "machine.h"

/* The place of the element that indices lead to, or -1. They have been looked at: all have values. */
static inline int32_t krl_flat_place(const int32_t *sizes, int32_t dimensions,
                                     const krl_cell *indices)
{
    int32_t place = 0;
    for (int32_t i = 0; i < dimensions; i++) {
        int32_t index = krl_int_in(indices[i]);
        if (index < 1 || index > sizes[i])
            return -1;
        place = place * sizes[i] + index - 1;
    }
    return place;
}

/* The sizes of a view, which lie behind its address. */
static inline void krl_view_sizes(const krl_cell *view, int32_t dimensions, int32_t *sizes)
{
    for (int32_t i = 0; i < dimensions; i++)
        sizes[i] = krl_int_in(view[1 + i]);
}

/* They may overlap. */
static inline void krl_copy_cells(krl_cell *target, const krl_cell *source, int32_t count)
{
    memmove(target, source, (size_t)count * sizeof *target);
}

static inline void krl_blank_cells(krl_cell *target, int32_t count)
{
    memset(target, 0, (size_t)count * sizeof *target);
}

/* As interp.values.values.fill does it with arrays; gives a fault. */
static inline int krl_fill_array(krl_cell *cells, const krl_cell *target, const krl_cell *source,
                                 int32_t width, int32_t dimensions)
{
    int32_t length = width, given = width;
    for (int32_t i = 1; i <= dimensions; i++) {
        length *= krl_int_in(target[i]);
        given *= krl_int_in(source[i]);
        if (dimensions > 1 && target[i] != source[i])
            return KRL_FAULT_INADMISSIBLE;
    }
    int32_t count = given < length ? given : length;
    krl_cell *to = cells + krl_int_in(target[0]);
    krl_copy_cells(to, cells + krl_int_in(source[0]), count);
    krl_blank_cells(to + count, length - count);
    return KRL_FINE;
}

/* The text, as much of it as there is room for; the rest loses its values. */
static inline void krl_set_text(krl_cell *target, int32_t length, const struct krl_letters *text)
{
    int32_t count = text->count < length ? text->count : length;
    krl_copy_cells(target, text->cells, count);
    krl_blank_cells(target + count, length - count);
}

/* Puts arguments, of which structures are references, into a frame, and takes the rest's values away. */
static inline void krl_receive(struct krl_machine *machine, const struct krl_routine *callee,
                               krl_cell *frame, const krl_cell *arguments)
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

#endif
