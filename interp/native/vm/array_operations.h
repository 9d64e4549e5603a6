/* Operations on blocks of cells: elements, views, arrays, texts. They are inline because the steps
 * of run.c use them. */
#ifndef KRL_ARRAY_OPERATIONS_H
#define KRL_ARRAY_OPERATIONS_H

#include "machine.h"

/* Returns the offset of an element in row-major order, in elements, or -1 if an index is out of
 * range [TYP-09]. The indices must have values. */
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

/* Reads the sizes of a view, which follow its address. */
static inline void krl_view_sizes(const krl_cell *view, int32_t dimensions, int32_t *sizes)
{
    for (int32_t i = 0; i < dimensions; i++)
        sizes[i] = krl_int_in(view[1 + i]);
}

/* Source and target may overlap. */
static inline void krl_copy_cells(krl_cell *target, const krl_cell *source, int32_t count)
{
    memmove(target, source, (size_t)count * sizeof *target);
}

static inline void krl_blank_cells(krl_cell *target, int32_t count)
{
    memset(target, 0, (size_t)count * sizeof *target);
}

/* Fills an array with another one, each given by a view, as interp.values.values.fill does. Returns
 * a fault or KRL_FINE. */
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

/* Stores as much of a text as fits [TYP-11]. The cells after it lose their values. */
static inline void krl_set_text(krl_cell *target, int32_t length, const struct krl_letters *text)
{
    int32_t count = text->count < length ? text->count : length;
    krl_copy_cells(target, text->cells, count);
    krl_blank_cells(target + count, length - count);
}

/* Stores arguments in a frame, whose other cells lose their values. A structure is copied: its
 * argument is a reference. */
static inline void krl_receive(struct krl_machine *machine, const struct krl_routine *callee,
                               krl_cell *frame, const krl_cell *arguments)
{
    const struct krl_code *code = callee->code;
    for (int32_t i = 0; i < code->parameter_count; i++) {
        const struct krl_slot *slot = &code->slots[i];
        int is_copied = slot->passed.mode == KRL_BY_VALUE &&
                        !krl_is_plain(&machine->program, slot->passed.type);
        const krl_cell *given = is_copied ? machine->cells + krl_int_in(*arguments) : arguments;
        krl_copy_cells(frame + slot->offset, given, slot->cells);
        arguments += krl_stack_cells(&slot->passed);
    }
    krl_blank_cells(frame + callee->received, callee->frame - callee->received);
}

#endif
