/* The text functions [FCT-04 to FCT-06], as in interp/values/texts.py. Python executes those that return structures. */
#include "formats.h"

struct known {
    const char *name;
    /* One letter for each argument: T a text; C an array that is changed; D an array that is not; N
     * an INT; M whether case matters; I, R, B a variable INT, REAL, BOOL that is changed; S a
     * STATE_T. The last one stands for any number: + values that SWRITE writes; * variables that
     * SREAD changes. */
    const char *parameters;
    int32_t result;
    int32_t weight;
};

static const struct known known[KRL_TEXT_FUNCTIONS] = {
    [KRL_STRLEN] = {"STRLEN", "T", KRL_TYPE_INT, KRL_WEIGHT_STRLEN},
    [KRL_STRDECLLEN] = {"STRDECLLEN", "D", KRL_TYPE_INT, KRL_WEIGHT_STRDECLLEN},
    [KRL_STRCLEAR] = {"STRCLEAR", "C", KRL_TYPE_BOOL, KRL_WEIGHT_STRCLEAR},
    [KRL_STRADD] = {"STRADD", "CT", KRL_TYPE_INT, KRL_WEIGHT_STRADD},
    [KRL_STRCOPY] = {"STRCOPY", "CT", KRL_TYPE_BOOL, KRL_WEIGHT_STRCOPY},
    [KRL_STRCOMP] = {"STRCOMP", "TTM", KRL_TYPE_BOOL, KRL_WEIGHT_STRCOMP},
    [KRL_STRFIND] = {"STRFIND", "NTTM", KRL_TYPE_INT, KRL_WEIGHT_STRFIND},
    [KRL_STRTOBOOL] = {"STRTOBOOL", "TB", KRL_TYPE_BOOL, KRL_WEIGHT_STRTOBOOL},
    [KRL_STRTOINT] = {"STRTOINT", "TI", KRL_TYPE_BOOL, KRL_WEIGHT_STRTOINT},
    [KRL_STRTOREAL] = {"STRTOREAL", "TR", KRL_TYPE_BOOL, KRL_WEIGHT_STRTOREAL},
    [KRL_STRTOSTRING] = {"STRTOSTRING", "TC", KRL_TYPE_BOOL, KRL_WEIGHT_STRTOSTRING},
    [KRL_SWRITE] = {"SWRITE", "CSIT+", -1, KRL_WEIGHT_SWRITE},
    [KRL_SREAD] = {"SREAD", "TSIT*", -1, KRL_WEIGHT_SREAD},
};

/* ---------------------------------------------------------------------------- signatures */

/* Returns the index of the constant for comparisons with case, or -1. */
static int32_t sensitive(const struct krl_program *program, int32_t type)
{
    return krl_constant_named(&program->types[type], "CASE_SENS");
}

static int is_changed(const struct krl_part *part, int32_t type)
{
    return part->kind == KRL_PART_CHANGED && !part->has_path && part->passed.mode == KRL_BY_REFERENCE &&
           part->passed.type == type;
}

static int accepts(const struct krl_program *program, const struct krl_part *part, char parameter)
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
        return krl_is_value(part) && part->passed.type == KRL_TYPE_INT;
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
        return (part->kind == KRL_PART_CHOICE || krl_is_value(part)) && sensitive(program, part->passed.type) >= 0;
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
            if (*parameter == 0 || !accepts(program, &entry->parts[i], *parameter))
                return KRL_TEXT_FUNCTIONS;
            parameter += *parameter != '+' && *parameter != '*';
        }
        if (*parameter == 0 || *parameter == '+' || *parameter == '*')
            return (enum krl_text_function)function;
        break;
    }
    return KRL_TEXT_FUNCTIONS;
}

/* ---------------------------------------------------------------------------- searching */

static int begins_with(const krl_cell *text, struct krl_letters what, int is_sensitive)
{
    for (int32_t i = 0; i < what.count; i++)
        if (krl_cased(text[i], is_sensitive) != krl_cased(what.cells[i], is_sensitive))
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
    return place == sensitive(&call->machine->program, part->passed.type);
}

/* Reads the first argument, without the blanks around it, as a value of the second one. Returns a
 * BOOL: whether it was one. */
static krl_cell taken(const struct krl_text_call *call, int (*read)(struct krl_letters, krl_cell *))
{
    struct krl_letters text = krl_text_argument(call, 0);
    krl_cell value;
    for (; krl_is_one_of(text, 0, ' ', ' '); text.count--)
        text.cells++;
    while (krl_is_one_of(text, text.count - 1, ' ', ' '))
        text.count--;
    if (!read(text, &value))
        return krl_of_bool(0);
    *krl_referred(call, 1) = value;
    return krl_of_bool(1);
}

/* ---------------------------------------------------------------------------- execution */

static int execute(struct krl_machine *machine, enum krl_text_function function,
                   const struct krl_entry *entry, krl_cell *inputs)
{
    struct krl_text_call call = {machine, entry, inputs};
    struct krl_letters array = {machine->cells, 0}, text, other;
    if (entry->parts[0].passed.mode != KRL_BY_VALUE)
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
        text = krl_used(array);
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
    case KRL_SREAD:
        return krl_call_format(&call, function == KRL_SWRITE);
    case KRL_TEXT_FUNCTIONS:
        break;
    }
    return 1;
}

int krl_call_text(struct krl_machine *machine, enum krl_text_function function,
                  const struct krl_entry *entry, krl_cell *inputs)
{
    int32_t weight = known[function].weight;
    if (machine->functions < weight || !execute(machine, function, entry, inputs))
        return 0;
    machine->functions -= weight;
    return 1;
}
