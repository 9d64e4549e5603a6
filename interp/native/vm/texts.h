/* Texts that are arguments of functions, and numbers in texts. */
#ifndef KRL_TEXTS_H
#define KRL_TEXTS_H

#include "machine.h"

/* A call of a text function: its entry, and its inputs on the stack. */
struct krl_text_call {
    struct krl_machine *machine;
    const struct krl_entry *entry;
    krl_cell *inputs;
};

/* krl_array_letters returns all letters of an array argument, krl_cells_of the cells to write to. */
struct krl_letters krl_array_letters(const struct krl_text_call *call, int32_t argument);
krl_cell *krl_cells_of(const struct krl_text_call *call, struct krl_letters array);

/* krl_used returns the letters before the first one that has no value or the code 0.
 * krl_text_argument returns these of an argument, an array or a constant text. */
struct krl_letters krl_used(struct krl_letters all);
struct krl_letters krl_text_argument(const struct krl_text_call *call, int32_t argument);

static inline int krl_is_value(const struct krl_part *part)
{
    return part->kind == KRL_PART_INPUT && part->passed.mode == KRL_BY_VALUE;
}

/* Returns the cells that a reference refers to. */
static inline krl_cell *krl_referred(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    return call->machine->cells + krl_int_in(call->inputs[part->place]);
}

/* Whether an argument is an array of CHAR with one dimension, by reference or as a view. */
int krl_is_text_array(const struct krl_program *program, const struct krl_part *part);

/* Returns the code to compare. If case does not matter, a to z become A to Z; other letters stay. */
static inline uint32_t krl_cased(krl_cell letter, int is_sensitive)
{
    uint32_t code = (uint32_t)letter;
    return !is_sensitive && code >= 'a' && code <= 'z' ? code - 'a' + 'A' : code;
}

static inline int krl_is_one_of(struct krl_letters text, int32_t place, char one, char other)
{
    return place >= 0 && place < text.count &&
           ((uint32_t)text.cells[place] == (uint32_t)one || (uint32_t)text.cells[place] == (uint32_t)other);
}

/* Stores a text after the first `behind` letters of an array, whose other cells lose their values.
 * Returns 0, with nothing done, if it does not fit. */
int krl_put_text(const struct krl_text_call *call, struct krl_letters array, int32_t behind,
                 struct krl_letters text);

/* Returns the index of a constant of an enumeration, or -1. */
int32_t krl_constant_named(const struct krl_type *type, const char *name);

/* Read all of a text as a BOOL, INT or REAL. Return 0 if it is none, or out of range. */
int krl_read_bool(struct krl_letters text, krl_cell *value);
int krl_read_int(struct krl_letters text, krl_cell *value);
int krl_read_real(struct krl_letters text, krl_cell *value);

/* Return how many letters from a place on are an INT, or a REAL; 0 for none. */
int32_t krl_int_length(struct krl_letters text, int32_t place);
int32_t krl_real_length(struct krl_letters text, int32_t place);

/* Replaces the decimal point of the locale, which C has written, by a dot. */
void krl_show_point(char *digits);

#endif
