/* The functions on texts, as interp/values/texts.py has them; what gives structures is carried out in
 * Python. */
#include "texts.h"

#include <locale.h>
#include <stdlib.h>

struct known {
    const char *name;
    /* T a text, C an array that may change, D one that does not, N an INT, M a mode, I, R, B an INT, REAL
     * or BOOL that changes, S a STATE_T; + what SWRITE writes, * what SREAD changes, each any number */
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
    [KRL_STRTOBOOL] = {"STRTOBOOL", "TB", KRL_TYPE_BOOL},
    [KRL_STRTOINT] = {"STRTOINT", "TI", KRL_TYPE_BOOL},
    [KRL_STRTOREAL] = {"STRTOREAL", "TR", KRL_TYPE_BOOL},
    [KRL_STRTOSTRING] = {"STRTOSTRING", "TC", KRL_TYPE_BOOL},
    [KRL_SWRITE] = {"SWRITE", "CSIT+", -1},
    [KRL_SREAD] = {"SREAD", "TSIT*", -1},
};

/* ---------------------------------------------------------------------------- which it is */

int krl_is_text_array(const struct krl_program *program, const struct krl_part *part)
{
    const struct krl_type *type = &program->types[part->handed.type];
    if (part->handed.mode == KRL_BY_VIEW)
        return part->handed.dimensions == 1 && part->handed.type == KRL_TYPE_CHAR;
    return part->handed.mode == KRL_BY_REFERENCE && type->form == KRL_ARRAY && type->count == 1 &&
           type->element == KRL_TYPE_CHAR;
}

int32_t krl_constant_named(const struct krl_type *type, const char *name)
{
    for (int32_t i = 0; type->form == KRL_ENUMERATION && i < type->count; i++)
        if (type->constants[i].length == strlen(name) &&
            memcmp(type->constants[i].bytes, name, strlen(name)) == 0)
            return i;
    return -1;
}

/* The place of the constant that distinguishes letters by their case; -1 where there is none. */
static int32_t sensitive(const struct krl_program *program, int32_t type)
{
    return krl_constant_named(&program->types[type], "CASE_SENS");
}

static int is_changed(const struct krl_part *part, int32_t type)
{
    return part->kind == KRL_PART_CHANGED && !part->has_path && part->handed.mode == KRL_BY_REFERENCE &&
           part->handed.type == type;
}

static int fits(const struct krl_program *program, const struct krl_part *part, char parameter)
{
    switch (parameter) {
    case 'T':
        return part->kind == KRL_PART_STRING ||
               (part->kind == KRL_PART_INPUT && krl_is_text_array(program, part));
    case 'D':
        return part->kind == KRL_PART_INPUT && krl_is_text_array(program, part);
    case 'C':
        return part->kind == KRL_PART_CHANGED && !part->has_path && krl_is_text_array(program, part);
    case 'N':
        return krl_is_value(part) && part->handed.type == KRL_TYPE_INT;
    case 'B':
        return is_changed(part, KRL_TYPE_BOOL);
    case 'I':
        return is_changed(part, KRL_TYPE_INT);
    case 'R':
        return is_changed(part, KRL_TYPE_REAL);
    case 'S':
        return krl_is_state(program, part);
    case '+':
        return krl_can_format(program, part);
    case '*':
        return krl_can_scan(program, part);
    default:
        return (part->kind == KRL_PART_CHOICE || krl_is_value(part)) && sensitive(program, part->handed.type) >= 0;
    }
}

enum krl_text_function krl_text_function_of(const struct krl_program *program,
                                            const struct krl_entry *entry)
{
    for (int function = 0; function < KRL_TEXT_FUNCTIONS; function++) {
        const struct known *one = &known[function];
        const char *parameter = one->parameters;
        if (entry->name.length != strlen(one->name) ||
            memcmp(entry->name.bytes, one->name, entry->name.length) != 0)
            continue;
        if (entry->result != one->result)
            break;
        for (int32_t i = 0; i < entry->part_count; i++) {
            if (*parameter == 0 || !fits(program, &entry->parts[i], *parameter))
                return KRL_TEXT_FUNCTIONS;
            parameter += *parameter != '+' && *parameter != '*';
        }
        if (*parameter == 0 || *parameter == '+' || *parameter == '*')
            return (enum krl_text_function)function;
        break;
    }
    return KRL_TEXT_FUNCTIONS;
}

/* ---------------------------------------------------------------------------- texts */

static struct krl_letters used(struct krl_letters all)
{
    struct krl_letters found = {all.cells, 0};
    while (found.count < all.count && (uint32_t)all.cells[found.count] != 0)
        found.count++;
    return found;
}

struct krl_letters krl_array_letters(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    const krl_cell *given = call->inputs + part->place;
    const struct krl_type *type = &call->machine->program.types[part->handed.type];
    int32_t count = part->handed.mode == KRL_BY_VIEW ? krl_int_in(given[1]) : type->sizes[0];
    return (struct krl_letters){krl_referred(call, argument), count};
}

krl_cell *krl_cells_of(const struct krl_text_call *call, struct krl_letters array)
{
    return call->machine->cells + (array.cells - call->machine->cells);
}

struct krl_letters krl_text_argument(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    return used(part->kind == KRL_PART_STRING ? part->letters : krl_array_letters(call, argument));
}

int krl_put_text(const struct krl_text_call *call, struct krl_letters array, int32_t behind,
                 struct krl_letters text)
{
    krl_cell *target = krl_cells_of(call, array);
    int32_t count = behind + text.count;
    if (count > array.count)
        return 0;
    memmove(target + behind, text.cells, (size_t)text.count * sizeof *target);
    memset(target + count, 0, (size_t)(array.count - count) * sizeof *target);
    return 1;
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

static int is_sensitive(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    int32_t place = part->kind == KRL_PART_CHOICE ? part->place : krl_int_in(call->inputs[part->place]);
    return place == sensitive(&call->machine->program, part->handed.type);
}

/* ---------------------------------------------------------------------------- numbers */

/* Longer ones are refused, as by interp/values/texts.py. */
enum { MOST_DIGITS = 64 };

static int is_digit(struct krl_letters text, int32_t place)
{
    return place < text.count && (uint32_t)text.cells[place] - '0' < 10;
}

static int is_one_of(struct krl_letters text, int32_t place, char one, char other)
{
    return place >= 0 && place < text.count &&
           ((uint32_t)text.cells[place] == (uint32_t)one || (uint32_t)text.cells[place] == (uint32_t)other);
}

static int32_t behind_digits(struct krl_letters text, int32_t place)
{
    while (is_digit(text, place))
        place++;
    return place;
}

int32_t krl_int_length(struct krl_letters text, int32_t place)
{
    int32_t first = place + is_one_of(text, place, '+', '-');
    int32_t end = behind_digits(text, first);
    return end > first ? end - place : 0;
}

int32_t krl_real_length(struct krl_letters text, int32_t place)
{
    int32_t first = place + is_one_of(text, place, '+', '-');
    int32_t point = behind_digits(text, first), end = point;
    if (is_one_of(text, point, '.', '.'))
        end = point > first || is_digit(text, point + 1) ? behind_digits(text, point + 1) : first;
    if (end == first)
        return 0;
    int32_t exponent = is_one_of(text, end, 'e', 'E') ? krl_int_length(text, end + 1) : 0;
    return end - place + (exponent > 0 ? 1 + exponent : 0);
}

int krl_read_bool(struct krl_letters text, krl_cell *value)
{
    static const char *const words[] = {"FALSE", "TRUE"};
    for (int truth = 0; truth < 2; truth++) {
        int32_t i = 0;
        while (i < text.count && words[truth][i] != 0 &&
               cased(text.cells[i], 0) == (uint32_t)words[truth][i])
            i++;
        if (i == text.count && words[truth][i] == 0) {
            *value = krl_of_bool(truth);
            return 1;
        }
    }
    return 0;
}

int krl_read_int(struct krl_letters text, krl_cell *value)
{
    int64_t number = 0;
    if (text.count > MOST_DIGITS || text.count == 0 || krl_int_length(text, 0) != text.count)
        return 0;
    int is_negative = is_one_of(text, 0, '-', '-');
    for (int32_t i = is_one_of(text, 0, '+', '-'); i < text.count; i++) {
        number = number * 10 + (int64_t)((uint32_t)text.cells[i] - '0');
        if (number > (int64_t)INT32_MAX + is_negative)
            return 0;
    }
    *value = krl_of_int((int32_t)(is_negative ? -number : number));
    return 1;
}

int krl_read_real(struct krl_letters text, krl_cell *value)
{
    char digits[MOST_DIGITS + 1];
    if (text.count > MOST_DIGITS || text.count == 0 || krl_real_length(text, 0) != text.count)
        return 0;
    for (int32_t i = 0; i < text.count; i++) {
        digits[i] = (char)(uint32_t)text.cells[i];
        if (digits[i] == '.')
            digits[i] = *localeconv()->decimal_point;
    }
    digits[text.count] = 0;
    float number = (float)strtod(digits, NULL);
    *value = krl_of_real(number);
    return krl_is_finite(number);
}

/* Reads a value, blanks around it left out, into the second argument; whether there was one. */
static krl_cell taken(const struct krl_text_call *call, int (*read)(struct krl_letters, krl_cell *))
{
    struct krl_letters text = krl_text_argument(call, 0);
    krl_cell value;
    for (; is_one_of(text, 0, ' ', ' '); text.count--)
        text.cells++;
    while (is_one_of(text, text.count - 1, ' ', ' '))
        text.count--;
    if (!read(text, &value))
        return krl_of_bool(0);
    *krl_referred(call, 1) = value;
    return krl_of_bool(1);
}

/* ---------------------------------------------------------------------------- what it does */

int krl_call_text(struct krl_machine *machine, enum krl_text_function function,
                  const struct krl_entry *entry, krl_cell *inputs)
{
    struct krl_text_call call = {machine, entry, inputs};
    struct krl_letters array = {machine->cells, 0}, text, other;
    if (entry->parts[0].handed.mode != KRL_BY_VALUE)
        array = krl_array_letters(&call, 0);
    switch (function) {
    case KRL_STRLEN:
        inputs[0] = krl_of_int(krl_text_argument(&call, 0).count);
        break;
    case KRL_STRDECLLEN:
        inputs[0] = krl_of_int(array.count);
        break;
    case KRL_STRCLEAR:
        inputs[0] = krl_of_bool(krl_put_text(&call, array, 0, (struct krl_letters){array.cells, 0}));
        break;
    case KRL_STRADD:
        text = used(array);
        other = krl_text_argument(&call, 1);
        inputs[0] = krl_of_int(krl_put_text(&call, array, text.count, other) ? text.count + other.count : 0);
        break;
    case KRL_STRCOPY:
        inputs[0] = krl_of_bool(krl_put_text(&call, array, 0, krl_text_argument(&call, 1)));
        break;
    case KRL_STRCOMP:
        text = krl_text_argument(&call, 0);
        other = krl_text_argument(&call, 1);
        inputs[0] = krl_of_bool(text.count == other.count &&
                                begins_with(text.cells, other, is_sensitive(&call, 2)));
        break;
    case KRL_STRFIND:
        text = krl_text_argument(&call, 1);
        other = krl_text_argument(&call, 2);
        inputs[0] = krl_of_int(find(krl_int_in(inputs[entry->parts[0].place]), text, other,
                                    is_sensitive(&call, 3)));
        break;
    case KRL_STRTOBOOL:
        inputs[0] = taken(&call, krl_read_bool);
        break;
    case KRL_STRTOINT:
        inputs[0] = taken(&call, krl_read_int);
        break;
    case KRL_STRTOREAL:
        inputs[0] = taken(&call, krl_read_real);
        break;
    case KRL_STRTOSTRING:
        inputs[0] = krl_of_bool(krl_put_text(&call, krl_array_letters(&call, 1), 0, krl_text_argument(&call, 0)));
        break;
    case KRL_SWRITE:
        return krl_swrite(&call);
    case KRL_SREAD:
        return krl_sread(&call);
    case KRL_TEXT_FUNCTIONS:
        break;
    }
    return 1;
}
