/* SWRITE and SREAD [FCT-09], as in interp/values/formats.py, which describes the formats. Python executes
 * assignments that may be refused, calls in which one text is read and written, and values of
 * structures: in these cases nothing has been done here. */
#include "formats.h"

#include <stdio.h>

/* Maximum of widths and precisions; of values in a call; and of the characters of a number: up to
 * LONGEST after the point, and some before it. */
enum { LONGEST = 2047, MOST_VALUES = 10, LONGEST_NUMBER = LONGEST + 64 };
/* Maximum length of a constant with its #; Python writes longer ones. */
enum { LONGEST_WORD = 256 };

/* ---------------------------------------------------------------------------- arguments */

/* The members of STATE_T, in order. */
enum { RET1, MSG_NO, MSG_TYPE, MSG_TXT, HITS, LENGTH, STATE_MEMBERS };
enum { TEXT = 0, STATE, OFFSET, FORMAT, VALUES };

int krl_is_state(const struct krl_program *program, const struct krl_part *part)
{
    const struct krl_type *type = &program->types[part->passed.type];
    if (part->kind != KRL_PART_CHANGED || part->has_path || part->passed.mode != KRL_BY_REFERENCE ||
        type->form != KRL_STRUCTURE || type->count != STATE_MEMBERS)
        return 0;
    const struct krl_type *results = &program->types[type->members[RET1].type];
    return type->members[MSG_NO].type == KRL_TYPE_INT && type->members[HITS].type == KRL_TYPE_INT &&
           type->members[LENGTH].type == KRL_TYPE_INT && krl_constant_named(results, "CMD_OK") >= 0 &&
           krl_constant_named(results, "CMD_ABORT") >= 0 && krl_constant_named(results, "FMT_ERR") >= 0;
}

int krl_can_format(const struct krl_program *program, const struct krl_part *part)
{
    const struct krl_type *type = &program->types[part->passed.type];
    if (part->kind == KRL_PART_STRING)
        return 1;
    if (part->kind != KRL_PART_INPUT)
        return 0;
    for (int32_t i = 0; type->form == KRL_ENUMERATION && i < type->count; i++) {
        if (type->constants[i].length >= LONGEST_WORD)
            return 0;
        for (uint32_t letter = 0; letter < type->constants[i].length; letter++)
            if ((uint8_t)type->constants[i].bytes[letter] > 127)
                return 0;
    }
    return part->passed.mode == KRL_BY_VALUE || krl_is_text_array(program, part);
}

int krl_can_scan(const struct krl_program *program, const struct krl_part *part)
{
    int32_t type = part->passed.type;
    return part->kind == KRL_PART_CHANGED && !part->has_path &&
           (krl_is_text_array(program, part) ||
            (part->passed.mode == KRL_BY_REFERENCE &&
             (type == KRL_TYPE_INT || type == KRL_TYPE_REAL || type == KRL_TYPE_CHAR)));
}

/* Returns the cells of an argument that is passed by reference or as a view; none for a constant
 * text. */
static struct krl_letters cells_of(const struct krl_text_call *call, int32_t argument)
{
    const struct krl_part *part = &call->entry->parts[argument];
    if (part->kind == KRL_PART_STRING)
        return (struct krl_letters){call->machine->cells, 0};
    if (krl_is_text_array(&call->machine->program, part))
        return krl_array_letters(call, argument);
    return (struct krl_letters){krl_referred(call, argument), call->machine->program.types[part->passed.type].size};
}

/* Whether all arguments by value and the offset have values, and no argument that is changed
 * overlaps another. */
static int are_apart(const struct krl_text_call *call)
{
    const struct krl_entry *entry = call->entry;
    for (int32_t i = 0; i < entry->part_count; i++) {
        const struct krl_part *part = &entry->parts[i];
        if (krl_is_value(part)) {
            if (call->inputs[part->place] == KRL_NOTHING)
                return 0;
            continue;
        }
        struct krl_letters one = cells_of(call, i);
        for (int32_t j = 0; j < i; j++) {
            if (krl_is_value(&entry->parts[j]) ||
                (part->kind != KRL_PART_CHANGED && entry->parts[j].kind != KRL_PART_CHANGED))
                continue;
            struct krl_letters other = cells_of(call, j);
            if (one.cells < other.cells + other.count && other.cells < one.cells + one.count)
                return 0;
        }
    }
    return *krl_referred(call, OFFSET) != KRL_NOTHING;
}

static void give_state(const struct krl_text_call *call, const char *word, int32_t hits, int32_t length)
{
    const struct krl_type *type = &call->machine->program.types[call->entry->parts[STATE].passed.type];
    const struct krl_type *results = &call->machine->program.types[type->members[RET1].type];
    krl_cell *state = krl_referred(call, STATE);
    memset(state, 0, (size_t)type->size * sizeof *state);
    state[type->members[RET1].offset] = krl_of_int(krl_constant_named(results, word));
    state[type->members[MSG_NO].offset] = krl_of_int(0);
    state[type->members[HITS].offset] = krl_of_int(hits);
    state[type->members[LENGTH].offset] = krl_of_int(length);
}

/* ---------------------------------------------------------------------------- formats */

/* The next piece of a format: a conversion, or a run of literal letters. */
struct piece {
    struct krl_letters letters;
    int is_plus, is_left, is_zero, is_full; /* the flags + - 0 # */
    int32_t width, precision;               /* -1 for none */
    char letter;                            /* of the conversion; 0 for literal letters */
};

static uint32_t code_at(struct krl_letters text, int32_t place)
{
    return place < text.count ? (uint32_t)text.cells[place] : 0;
}

/* Reads a number of up to four digits, -1 if there are none. Returns 0 if it is too large. */
static int count(struct krl_letters format, int32_t *place, int32_t *number)
{
    *number = -1;
    for (int32_t i = 0; i < 4 && code_at(format, *place) - '0' < 10; i++)
        *number = (*number < 0 ? 0 : *number * 10) + (int32_t)(code_at(format, (*place)++) - '0');
    return *number <= LONGEST;
}

/* Removes the first piece from a format that is not empty. Returns 0 if it is invalid. */
static int take_piece(struct krl_letters *format, struct piece *piece)
{
    int32_t place = 0;
    memset(piece, 0, sizeof *piece);
    piece->letters.cells = format->cells;
    if (code_at(*format, 0) != '%' || code_at(*format, 1) == '%') {
        while (place < format->count && code_at(*format, place) != '%')
            place++;
        piece->letters.count = place > 0 ? place : 1;
        place = place > 0 ? place : 2;
    } else {
        for (place = 1;; place++) {
            uint32_t flag = code_at(*format, place);
            piece->is_plus |= flag == '+';
            piece->is_left |= flag == '-';
            piece->is_zero |= flag == '0';
            piece->is_full |= flag == '#';
            if (flag != '+' && flag != '-' && flag != '0' && flag != '#')
                break;
        }
        int is_fine = count(*format, &place, &piece->width);
        piece->precision = -1;
        if (code_at(*format, place) == '.') {
            place++;
            is_fine = count(*format, &place, &piece->precision) && piece->precision >= 0 && is_fine;
        }
        uint32_t letter = code_at(*format, place++);
        if (!is_fine || letter > 'z' || (letter | 32) < 'a' || (letter | 32) > 'z')
            return 0;
        piece->letter = (char)letter;
    }
    format->cells += place;
    format->count -= place;
    return 1;
}

/* ---------------------------------------------------------------------------- SWRITE */

/* The letters to write to, of which `used` are in use. */
struct output {
    krl_cell *cells;
    int32_t count;
    int32_t used;
};

static void put(struct output *output, int32_t repeats, uint32_t code)
{
    for (int32_t i = 0; i < repeats; i++)
        output->cells[output->used++] = krl_of_int((int32_t)code);
}

static void put_bytes(struct output *output, const char *bytes, int32_t length)
{
    for (int32_t i = 0; i < length; i++)
        put(output, 1, (uint8_t)bytes[i]);
}

static int has_room(const struct output *output, int32_t length)
{
    return length <= output->count - output->used;
}

static int32_t at_least(int32_t length, int32_t least)
{
    return length > least ? length : least;
}

/* Writes letters, padded with blanks. Returns 0, with nothing written, if they do not fit. */
static int put_letters(struct output *output, const struct piece *piece, struct krl_letters text)
{
    int32_t blanks = at_least(piece->width - text.count, 0);
    if (!has_room(output, text.count + blanks))
        return 0;
    put(output, piece->is_left ? 0 : blanks, ' ');
    for (int32_t i = 0; i < text.count; i++)
        put(output, 1, (uint32_t)text.cells[i]);
    put(output, piece->is_left ? blanks : 0, ' ');
    return 1;
}

/* Writes a value as letters, for %c and %s. Returns 0 if the value has no such form, or it does not
 * fit. */
static int put_characters(struct output *output, const struct piece *piece, const struct krl_program *program,
                          const struct krl_part *part, krl_cell value, struct krl_letters text)
{
    krl_cell letters[LONGEST_WORD];
    struct krl_letters found = {letters, 0};
    const struct krl_type *type = &program->types[part->passed.type];
    int is_value = krl_is_value(part);
    int is_letter = is_value && part->passed.type == KRL_TYPE_CHAR;
    if (piece->letter == 'c') {
        letters[0] = value;
        found.count = 1;
        if (part->kind == KRL_PART_STRING && part->letters.count == 1)
            letters[0] = part->letters.cells[0];
        else if (!is_letter && !(is_value && part->passed.type == KRL_TYPE_INT && (uint32_t)value <= 255))
            return 0;
        return put_letters(output, piece, found);
    }
    if (!is_value)
        found = text;
    else if (is_letter) {
        letters[0] = value;
        found.count = (uint32_t)value != 0;
    } else if (part->passed.type == KRL_TYPE_BOOL || type->form == KRL_ENUMERATION) {
        const char *word = krl_int_in(value) ? "TRUE" : "FALSE";
        uint32_t length = (uint32_t)strlen(word);
        if (type->form == KRL_ENUMERATION) {
            word = type->constants[krl_int_in(value)].bytes;
            length = type->constants[krl_int_in(value)].length;
            letters[found.count++] = krl_of_int('#');
        }
        for (uint32_t i = 0; i < length; i++) {
            uint32_t code = (uint8_t)word[i];
            letters[found.count++] = krl_of_int((int32_t)(code >= 'a' && code <= 'z' ? code - 'a' + 'A' : code));
        }
    } else
        return 0;
    if (piece->precision >= 0 && piece->precision < found.count)
        found.count = piece->precision;
    return put_letters(output, piece, found);
}

/* Stores the digits of a number without its sign. Returns their number, or -1 if the conversion is
 * not for this type. */
static int32_t digits_of(const struct piece *piece, int32_t type, krl_cell value, char *digits)
{
    char letter = piece->letter;
    int32_t precision = piece->precision;
    if (strchr("efg", letter) || (strchr("di", letter) && type == KRL_TYPE_REAL)) {
        double number = type == KRL_TYPE_REAL ? (double)krl_real_in(value) : (double)krl_int_in(value);
        char format[] = {'%', '#', '.', '*', strchr("efg", letter) ? letter : 'f', 0};
        if (!piece->is_full)
            memmove(format + 1, format + 2, sizeof format - 2);
        snprintf(digits, LONGEST_NUMBER, format, precision < 0 ? 6 : precision, fabs(number));
        krl_show_point(digits);
        return (int32_t)strlen(digits);
    }
    if (!strchr("diux", letter) || type == KRL_TYPE_REAL)
        return -1;
    uint32_t number = (uint32_t)value;
    if (strchr("di", letter) && krl_int_in(value) < 0)
        number = 0 - number;
    return snprintf(digits, LONGEST_NUMBER, letter == 'x' ? "%.*x" : "%.*u", at_least(precision, 1), number);
}

/* Writes a number, for all other conversions. Returns 0 if it does not fit, or the conversion is
 * not for its type. */
static int put_number(struct output *output, const struct piece *piece, int32_t type, krl_cell value)
{
    char digits[LONGEST_NUMBER];
    int32_t length = digits_of(piece, type, value, digits);
    int is_bare = strchr("ux", piece->letter) != NULL;
    int is_negative = type == KRL_TYPE_REAL ? krl_real_in(value) < 0 : krl_int_in(value) < 0;
    const char *sign = is_bare ? "" : is_negative ? "-" : piece->is_plus ? "+" : "";
    const char *prefix = piece->letter == 'x' && piece->is_full && (uint32_t)value != 0 ? "0x" : "";
    int32_t signs = (int32_t)strlen(sign), prefixes = (int32_t)strlen(prefix);
    int32_t filling = at_least(piece->width - prefixes - length, 0);
    if (length < 0 || !has_room(output, signs + prefixes + length + filling))
        return 0;
    put(output, piece->is_left || piece->is_zero ? 0 : filling, ' ');
    put_bytes(output, sign, signs);
    put_bytes(output, prefix, prefixes);
    put(output, piece->is_zero && !piece->is_left ? filling : 0, '0');
    put_bytes(output, digits, length);
    put(output, piece->is_left ? filling : 0, ' ');
    return 1;
}

/* Writes the value of an argument after the format. Returns 0 as the functions above do. */
static int put_value(struct output *output, const struct piece *piece, const struct krl_text_call *call,
                     int32_t argument)
{
    const struct krl_program *program = &call->machine->program;
    const struct krl_part *part = &call->entry->parts[argument];
    int is_value = krl_is_value(part);
    krl_cell value = is_value ? call->inputs[part->place] : KRL_NOTHING;
    if (strchr("cs", piece->letter))
        return put_characters(output, piece, program, part, value,
                              is_value ? (struct krl_letters){NULL, 0} : krl_text_argument(call, argument));
    int is_number = part->passed.type <= KRL_TYPE_BOOL;
    return is_value && is_number && put_number(output, piece, part->passed.type, value);
}

static int write_text(const struct krl_text_call *call, struct krl_letters target, int32_t start)
{
    const struct krl_entry *entry = call->entry;
    struct krl_letters format = krl_text_argument(call, FORMAT);
    struct output output = {krl_cells_of(call, target), target.count, start};
    int32_t hits = 0, left = entry->part_count - VALUES;
    int is_fine = 1;
    while (is_fine && format.count > 0) {
        struct piece piece;
        is_fine = take_piece(&format, &piece);
        if (is_fine && piece.letter == 0)
            is_fine = put_letters(&output, &piece, piece.letters);
        else if (is_fine) {
            is_fine = hits < left && hits < MOST_VALUES && put_value(&output, &piece, call, VALUES + hits);
            hits += is_fine;
        }
    }
    give_state(call, is_fine && hits == left ? "CMD_OK" : "FMT_ERR", hits, output.used - start);
    *krl_referred(call, OFFSET) = krl_of_int(output.used);
    return 1;
}

/* ---------------------------------------------------------------------------- SREAD */

/* What SREAD has read: letters, or a number. */
struct found {
    struct krl_letters letters;
    krl_cell number; /* KRL_NOTHING for letters */
};

static int32_t behind_blanks(struct krl_letters text, int32_t place)
{
    while (code_at(text, place) == ' ')
        place++;
    return place;
}

/* Skips what the format expects literally; a blank stands for any number of blanks. Returns the
 * place after it, or -1 if the text differs. */
static int32_t skipped(struct krl_letters text, int32_t place, struct krl_letters expected)
{
    for (int32_t i = 0; i < expected.count; i++) {
        uint32_t code = (uint32_t)expected.cells[i];
        if (code == ' ')
            place = behind_blanks(text, place);
        else if (place >= text.count || code_at(text, place++) != code)
            return -1;
    }
    return place;
}

static uint32_t hexadecimal(uint32_t code)
{
    return code - '0' < 10 ? code - '0' : (code | 32) - 'a' < 6 && code < 128 ? (code | 32) - 'a' + 10 : 16;
}

/* Reads an unsigned number, decimal or hexadecimal, and returns how many letters it has; 0 for
 * none, or if it is too large. */
static int32_t take_unsigned(struct krl_letters text, uint32_t base, krl_cell *value)
{
    int32_t place = 0;
    uint64_t number = 0;
    if (base == 16 && code_at(text, 0) == '0' && (code_at(text, 1) | 32) == 'x' && hexadecimal(code_at(text, 2)) < 16)
        place = 2;
    for (; hexadecimal(code_at(text, place)) < base; place++)
        number = number > UINT32_MAX ? number : number * base + hexadecimal(code_at(text, place));
    *value = krl_of_int((int32_t)(uint32_t)number);
    return number > UINT32_MAX ? 0 : place;
}

/* Reads a value by a conversion. Returns the place after it, or -1 if there is none. */
static int32_t scan(struct krl_letters text, int32_t place, const struct piece *piece, struct found *found)
{
    if (piece->is_plus || piece->is_left || piece->is_zero || piece->is_full || piece->precision >= 0)
        return -1;
    if (piece->letter != 'c')
        place = behind_blanks(text, place);
    int32_t most = text.count - place;
    struct krl_letters here = {text.cells + place, piece->width >= 0 && piece->width < most ? piece->width : most};
    int32_t length = 0;
    found->letters = here;
    found->number = KRL_NOTHING;
    switch (piece->letter) {
    case 'c':
        length = piece->width < 0 ? 1 : piece->width;
        if (length > here.count)
            return -1;
        break;
    case 's':
        while (length < here.count && code_at(here, length) != ' ')
            length++;
        break;
    case 'd': case 'i':
        here.count = length = krl_int_length(here, 0);
        length = krl_read_int(here, &found->number) ? length : 0;
        break;
    case 'u': case 'x':
        length = take_unsigned(here, piece->letter == 'x' ? 16 : 10, &found->number);
        break;
    case 'e': case 'f': case 'g':
        here.count = length = krl_real_length(here, 0);
        length = krl_read_real(here, &found->number) ? length : 0;
        break;
    default:
        break;
    }
    found->letters.count = length;
    return length > 0 ? place + length : -1;
}

/* Converts what was read to the type of a variable. Returns 0 if Python has to do the assignment. */
static int converts(const struct krl_program *program, const struct krl_part *part, struct found *found)
{
    int is_real = krl_tag_of(found->number) == KRL_TAG_REAL;
    if (found->number == KRL_NOTHING) {
        if (!krl_is_text_array(program, part) && part->passed.type == KRL_TYPE_CHAR && found->letters.count == 1)
            found->number = found->letters.cells[0];
        return found->number != KRL_NOTHING || krl_is_text_array(program, part);
    }
    if (krl_is_text_array(program, part))
        return 0;
    if (part->passed.type == KRL_TYPE_REAL && !is_real)
        found->number = krl_of_real((float)krl_int_in(found->number));
    return part->passed.type == KRL_TYPE_REAL || (part->passed.type == KRL_TYPE_INT && !is_real);
}

static int read_text(const struct krl_text_call *call, struct krl_letters text, int32_t start)
{
    const struct krl_entry *entry = call->entry;
    const struct krl_program *program = &call->machine->program;
    struct krl_letters format = krl_text_argument(call, FORMAT);
    struct found found[MOST_VALUES];
    int32_t end = start, hits = 0, left = entry->part_count - VALUES;
    int is_fine = 1;
    while (is_fine && format.count > 0) {
        struct piece piece;
        is_fine = take_piece(&format, &piece);
        if (!is_fine)
            break;
        int32_t next = piece.letter == 0                         ? skipped(text, end, piece.letters)
                       : hits < left && hits < MOST_VALUES ? scan(text, end, &piece, &found[hits])
                                                            : -1;
        is_fine = next >= 0;
        end = is_fine ? next : end;
        if (is_fine && piece.letter != 0) {
            if (!converts(program, &entry->parts[VALUES + hits], &found[hits]))
                return 0;
            hits++;
        }
    }
    give_state(call, is_fine && hits == left ? "CMD_OK" : "FMT_ERR", hits, end - start);
    *krl_referred(call, OFFSET) = krl_of_int(end);
    for (int32_t i = 0; i < hits; i++) {
        if (found[i].number == KRL_NOTHING) {
            struct krl_letters target = krl_array_letters(call, VALUES + i);
            struct krl_letters some = found[i].letters;
            some.count = some.count < target.count ? some.count : target.count;
            krl_put_text(call, target, 0, some);
        } else
            *krl_referred(call, VALUES + i) = found[i].number;
    }
    return 1;
}

int krl_call_format(const struct krl_text_call *call, int is_writing)
{
    struct krl_letters text = is_writing ? krl_array_letters(call, TEXT) : krl_text_argument(call, TEXT);
    int32_t start = krl_int_in(*krl_referred(call, OFFSET));
    if (!are_apart(call))
        return 0;
    if (start >= 0 && start <= text.count)
        return is_writing ? write_text(call, text, start) : read_text(call, text, start);
    give_state(call, "CMD_ABORT", 0, 0);
    return 1;
}
