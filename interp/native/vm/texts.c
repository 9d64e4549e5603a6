/* Texts and the numbers in them, for the text functions, SWRITE and SREAD. */
#include "texts.h"

#include <locale.h>
#include <stdlib.h>

int krl_is_text_array(const struct krl_program *program, const struct krl_part *part)
{
    const struct krl_type *type = &program->types[part->passed.type];
    if (part->passed.mode == KRL_BY_VIEW)
        return part->passed.dimensions == 1 && part->passed.type == KRL_TYPE_CHAR;
    return part->passed.mode == KRL_BY_REFERENCE && type->form == KRL_ARRAY && type->count == 1 &&
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

/* ---------------------------------------------------------------------------- letters */

struct krl_letters krl_used(struct krl_letters all)
{
    struct krl_letters found = {all.cells, 0};
    /* Tests four letters with one branch: codes are small, so code - 1 has the highest bit set only
     * for code 0. */
    for (const krl_cell *four = all.cells; found.count + 4 <= all.count; found.count += 4, four += 4)
        if ((((uint32_t)four[0] - 1) | ((uint32_t)four[1] - 1) | ((uint32_t)four[2] - 1) | ((uint32_t)four[3] - 1)) >> 31)
            break;
    while (found.count < all.count && (uint32_t)all.cells[found.count] != 0)
        found.count++;
    return found;
}

struct krl_letters krl_array_letters(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    const krl_cell *given = call->inputs + part->place;
    const struct krl_type *type = &call->machine->program.types[part->passed.type];
    int32_t count = part->passed.mode == KRL_BY_VIEW ? krl_int_in(given[1]) : type->sizes[0];
    return (struct krl_letters){krl_referred(call, argument), count};
}

krl_cell *krl_cells_of(const struct krl_text_call *call, struct krl_letters array)
{
    return call->machine->cells + (array.cells - call->machine->cells);
}

struct krl_letters krl_text_argument(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    return krl_used(part->kind == KRL_PART_STRING ? part->letters : krl_array_letters(call, argument));
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

/* ---------------------------------------------------------------------------- numbers */

/* Longer numbers are refused, as in interp/values/texts.py. */
enum { MOST_DIGITS = 64 };
/* The maximum length of a locale's decimal point in bytes; a number has at most one. */
enum { LONGEST_POINT = 8 };

static int is_digit(struct krl_letters text, int32_t place)
{
    return place < text.count && (uint32_t)text.cells[place] - '0' < 10;
}

static int32_t behind_digits(struct krl_letters text, int32_t place)
{
    while (is_digit(text, place))
        place++;
    return place;
}

int32_t krl_int_length(struct krl_letters text, int32_t place)
{
    int32_t first = place + krl_is_one_of(text, place, '+', '-');
    int32_t end = behind_digits(text, first);
    return end > first ? end - place : 0;
}

int32_t krl_real_length(struct krl_letters text, int32_t place)
{
    int32_t first = place + krl_is_one_of(text, place, '+', '-');
    int32_t point = behind_digits(text, first), end = point;
    if (krl_is_one_of(text, point, '.', '.'))
        end = point > first || is_digit(text, point + 1) ? behind_digits(text, point + 1) : first;
    if (end == first)
        return 0;
    int32_t exponent = krl_is_one_of(text, end, 'e', 'E') ? krl_int_length(text, end + 1) : 0;
    return end - place + (exponent > 0 ? 1 + exponent : 0);
}

int krl_read_bool(struct krl_letters text, krl_cell *value)
{
    static const char *const words[] = {"FALSE", "TRUE"};
    for (int truth = 0; truth < 2; truth++) {
        int32_t i = 0;
        while (i < text.count && words[truth][i] != 0 &&
               krl_cased(text.cells[i], 0) == (uint32_t)words[truth][i])
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
    int is_negative = krl_is_one_of(text, 0, '-', '-');
    for (int32_t i = krl_is_one_of(text, 0, '+', '-'); i < text.count; i++) {
        number = number * 10 + (int64_t)((uint32_t)text.cells[i] - '0');
        if (number > (int64_t)INT32_MAX + is_negative)
            return 0;
    }
    *value = krl_of_int((int32_t)(is_negative ? -number : number));
    return 1;
}

int krl_read_real(struct krl_letters text, krl_cell *value)
{
    const char *point = localeconv()->decimal_point;
    char digits[MOST_DIGITS + LONGEST_POINT];
    size_t length = 0, wide = strlen(point);
    if (text.count > MOST_DIGITS || text.count == 0 || krl_real_length(text, 0) != text.count || wide > LONGEST_POINT)
        return 0;
    for (int32_t i = 0; i < text.count; i++)
        if ((uint32_t)text.cells[i] == '.') {
            memcpy(digits + length, point, wide);
            length += wide;
        } else
            digits[length++] = (char)(uint32_t)text.cells[i];
    digits[length] = 0;
    float number = (float)strtod(digits, NULL);
    *value = krl_of_real(number);
    return krl_is_finite(number);
}

void krl_show_point(char *digits)
{
    const char *point = localeconv()->decimal_point;
    char *place = strstr(digits, point);
    if (place == NULL)
        return;
    *place = '.';
    memmove(place + 1, place + strlen(point), strlen(place + strlen(point)) + 1);
}
