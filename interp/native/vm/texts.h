/* Texts among the inputs of a call, and the numbers in them. */
#ifndef KRL_TEXTS_H
#define KRL_TEXTS_H

#include "machine.h"

/* A call of a function on texts: its entry, and what lay on the stack for it. */
struct krl_text_call {
    struct krl_machine *machine;
    const struct krl_entry *entry;
    krl_cell *inputs;
};

/* All of an array; what is written goes to `krl_cells_of` it. */
struct krl_letters krl_array_letters(const struct krl_text_call *call, int32_t argument);
krl_cell *krl_cells_of(const struct krl_text_call *call, struct krl_letters array);

/* The used part of letters, and that of an array or a text: it ends before the first letter that is none, or has the
 * code 0. */
struct krl_letters krl_used(struct krl_letters all);
struct krl_letters krl_text_argument(const struct krl_text_call *call, int32_t argument);

static inline int krl_is_value(const struct krl_part *part)
{
    return part->kind == KRL_PART_INPUT && part->handed.mode == KRL_BY_VALUE;
}

/* What a reference leads to. */
static inline krl_cell *krl_referred(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    return call->machine->cells + krl_int_in(call->inputs[part->place]);
}

/* Whether it is an array of CHAR with one dimension, by reference or as a view. */
int krl_is_text_array(const struct krl_program *program, const struct krl_part *part);

/* The letter to compare: the case of A to Z only. */
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

/* Puts a text behind the first letters of an array, whose rest has no value then; 0 where it does
 * not fit. */
int krl_put_text(const struct krl_text_call *call, struct krl_letters array, int32_t behind,
                 struct krl_letters text);

/* The place of a constant of an enumeration; -1 where there is none. */
int32_t krl_constant_named(const struct krl_type *type, const char *name);

/* A BOOL, INT or REAL as texts have it: 0 for none, or one that is too large. The letters have no codes
 * above 127. */
int krl_read_bool(struct krl_letters text, krl_cell *value);
int krl_read_int(struct krl_letters text, krl_cell *value);
int krl_read_real(struct krl_letters text, krl_cell *value);

/* How many letters from a place on are a number as INT, or as REAL, has it. */
int32_t krl_int_length(struct krl_letters text, int32_t place);
int32_t krl_real_length(struct krl_letters text, int32_t place);

/* Makes a dot of the decimal point that C has written, which is that of the locale. */
void krl_show_point(char *digits);

#endif
