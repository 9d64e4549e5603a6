/* The functions on texts that programs call in loops, as interp/values/texts.py has them; the others are
 * carried out in Python. */
#include "machine.h"

struct known {
    const char *name;
    /* T a text, C an array that may change, D one that does not, N an INT, M a mode */
    const char *parameters;
    int32_t result;
};

static const struct known known[KRL_TEXT_FUNCTIONS] = {
    [KRL_STRLEN] = {"STRLEN", "T", KRL_TYPE_INT},
    [KRL_STRDECLLEN] = {"STRDECLLEN", "D", KRL_TYPE_INT},
    [KRL_STRCLEAR] = {"STRCLEAR", "C", KRL_TYPE_BOOL},
    [KRL_STRADD] = {"STRADD", "CT", KRL_TYPE_INT},
    [KRL_STRCOPY] = {"STRCOPY", "CT", KRL_TYPE_BOOL},
    [KRL_STRCOMP] = {"STRCOMP", "TTM", KRL_TYPE_BOOL},
    [KRL_STRFIND] = {"STRFIND", "NTTM", KRL_TYPE_INT},
};

/* ---------------------------------------------------------------------------- which it is */

/* Whether the part is an array of CHAR with one dimension, by reference or as a view. */
static int is_array(const struct krl_program *program, const struct krl_part *part)
{
    const struct krl_type *type = &program->types[part->handed.type];
    if (part->handed.mode == KRL_BY_VIEW)
        return part->handed.dimensions == 1 && part->handed.type == KRL_TYPE_CHAR;
    return part->handed.mode == KRL_BY_REFERENCE && type->form == KRL_ARRAY && type->count == 1 &&
           type->element == KRL_TYPE_CHAR;
}

/* The place of the constant that distinguishes letters by their case; -1 where there is none. */
static int32_t sensitive(const struct krl_program *program, int32_t type)
{
    static const char name[] = "CASE_SENS";
    const struct krl_type *mode = &program->types[type];
    for (int32_t i = 0; mode->form == KRL_ENUMERATION && i < mode->count; i++)
        if (mode->constants[i].length == sizeof name - 1 &&
            memcmp(mode->constants[i].bytes, name, sizeof name - 1) == 0)
            return i;
    return -1;
}

static int fits(const struct krl_program *program, const struct krl_part *part, char parameter)
{
    switch (parameter) {
    case 'T':
        return part->kind == KRL_PART_STRING || (part->kind == KRL_PART_INPUT && is_array(program, part));
    case 'D':
        return part->kind == KRL_PART_INPUT && is_array(program, part);
    case 'C':
        return part->kind == KRL_PART_CHANGED && !part->has_path && is_array(program, part);
    case 'N':
        return part->kind == KRL_PART_INPUT && part->handed.mode == KRL_BY_VALUE &&
               part->handed.type == KRL_TYPE_INT;
    default:
        return (part->kind == KRL_PART_CHOICE ||
                (part->kind == KRL_PART_INPUT && part->handed.mode == KRL_BY_VALUE)) &&
               sensitive(program, part->handed.type) >= 0;
    }
}

enum krl_text_function krl_text_function_of(const struct krl_program *program,
                                            const struct krl_entry *entry)
{
    for (int function = 0; function < KRL_TEXT_FUNCTIONS; function++) {
        const struct known *one = &known[function];
        if (entry->name.length != strlen(one->name) ||
            memcmp(entry->name.bytes, one->name, entry->name.length) != 0)
            continue;
        if (entry->result != one->result || (size_t)entry->part_count != strlen(one->parameters))
            break;
        for (int32_t i = 0; i < entry->part_count; i++)
            if (!fits(program, &entry->parts[i], one->parameters[i]))
                return KRL_TEXT_FUNCTIONS;
        return (enum krl_text_function)function;
    }
    return KRL_TEXT_FUNCTIONS;
}

/* ---------------------------------------------------------------------------- what it does */

/* The used part of a text: it ends before the first letter that is none, or has the code 0. */
static struct krl_letters used(struct krl_letters all)
{
    struct krl_letters found = {all.cells, 0};
    while (found.count < all.count && (uint32_t)all.cells[found.count] != 0)
        found.count++;
    return found;
}

/* All of an array. */
static struct krl_letters whole(const struct krl_machine *machine, const struct krl_part *part,
                                const krl_cell *inputs)
{
    const krl_cell *given = inputs + part->place;
    const struct krl_type *type = &machine->program.types[part->handed.type];
    int32_t count = part->handed.mode == KRL_BY_VIEW ? krl_int_in(given[1]) : type->sizes[0];
    return (struct krl_letters){machine->cells + krl_int_in(given[0]), count};
}

static struct krl_letters text_of(const struct krl_machine *machine, const struct krl_part *part,
                                  const krl_cell *inputs)
{
    return used(part->kind == KRL_PART_STRING ? part->letters : whole(machine, part, inputs));
}

/* The letter to compare: the case of A to Z only. */
static uint32_t cased(krl_cell letter, int is_sensitive)
{
    uint32_t code = (uint32_t)letter;
    return !is_sensitive && code >= 'a' && code <= 'z' ? code - 'a' + 'A' : code;
}

static int begins_with(const krl_cell *text, struct krl_letters what, int is_sensitive)
{
    for (int32_t i = 0; i < what.count; i++)
        if (cased(text[i], is_sensitive) != cased(what.cells[i], is_sensitive))
            return 0;
    return 1;
}

static int32_t find(int32_t start, struct krl_letters text, struct krl_letters what, int is_sensitive)
{
    if (start < 1 || what.count == 0)
        return 0;
    for (int32_t place = start - 1; place <= text.count - what.count; place++)
        if (begins_with(text.cells + place, what, is_sensitive))
            return place + 1;
    return 0;
}

/* Puts a text behind the first letters of an array, whose rest has no value then; 0 where it does
 * not fit. */
static int put(struct krl_machine *machine, struct krl_letters array, int32_t behind,
               struct krl_letters text)
{
    krl_cell *target = machine->cells + (array.cells - machine->cells);
    int32_t count = behind + text.count;
    if (count > array.count)
        return 0;
    memmove(target + behind, text.cells, (size_t)text.count * sizeof *target);
    memset(target + count, 0, (size_t)(array.count - count) * sizeof *target);
    return 1;
}

static int is_sensitive(const struct krl_machine *machine, const struct krl_part *part,
                        const krl_cell *inputs)
{
    int32_t place = part->kind == KRL_PART_CHOICE ? part->place : krl_int_in(inputs[part->place]);
    return place == sensitive(&machine->program, part->handed.type);
}

void krl_call_text(struct krl_machine *machine, enum krl_text_function function,
                   const struct krl_entry *entry, krl_cell *inputs)
{
    const struct krl_part *parts = entry->parts;
    struct krl_letters array = {machine->cells, 0}, text, other;
    krl_cell result = KRL_NOTHING;
    if (parts[0].handed.mode != KRL_BY_VALUE)
        array = whole(machine, &parts[0], inputs);
    switch (function) {
    case KRL_STRLEN:
        result = krl_of_int(text_of(machine, &parts[0], inputs).count);
        break;
    case KRL_STRDECLLEN:
        result = krl_of_int(array.count);
        break;
    case KRL_STRCLEAR:
        result = krl_of_bool(put(machine, array, 0, (struct krl_letters){array.cells, 0}));
        break;
    case KRL_STRADD:
        text = used(array);
        other = text_of(machine, &parts[1], inputs);
        result = krl_of_int(put(machine, array, text.count, other) ? text.count + other.count : 0);
        break;
    case KRL_STRCOPY:
        result = krl_of_bool(put(machine, array, 0, text_of(machine, &parts[1], inputs)));
        break;
    case KRL_STRCOMP:
        text = text_of(machine, &parts[0], inputs);
        other = text_of(machine, &parts[1], inputs);
        result = krl_of_bool(text.count == other.count &&
                             begins_with(text.cells, other, is_sensitive(machine, &parts[2], inputs)));
        break;
    case KRL_STRFIND:
        text = text_of(machine, &parts[1], inputs);
        other = text_of(machine, &parts[2], inputs);
        result = krl_of_int(find(krl_int_in(inputs[parts[0].place]), text, other,
                                 is_sensitive(machine, &parts[3], inputs)));
        break;
    case KRL_TEXT_FUNCTIONS:
        break;
    }
    inputs[0] = result;
}
