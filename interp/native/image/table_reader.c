/* Reads the tables of an image: types, requests, calls of predefined functions, texts, data lists. */
#include "reader.h"

enum { NIL, FALSE_, TRUE_, INT_, REAL_, STRING, CHOICE, INPUT, CHANGED, HANDLE, ITEMS, RECORD };

/* ---------------------------------------------------------------------------- types */

static void read_type(struct reader *reader, struct krl_type *type)
{
    const struct krl_type *types = reader->program->types;
    static const enum krl_form forms[] = {KRL_STRUCTURE, KRL_ENUMERATION, KRL_ARRAY};
    type->form = forms[krl_read_word(reader)];
    if (type->form == KRL_ARRAY) {
        type->element = krl_read_word(reader);
        type->count = krl_read_word(reader);
        type->size = types[type->element].size;
        for (int32_t i = 0; i < type->count; i++) {
            type->sizes[i] = krl_read_word(reader);
            type->size *= type->sizes[i];
        }
        return;
    }
    type->name = krl_read_string(reader);
    type->count = krl_read_word(reader);
    if (type->form == KRL_ENUMERATION) {
        struct krl_text *constants = krl_allocate_read(reader, type->count, sizeof *constants);
        for (int32_t i = 0; i < type->count; i++)
            constants[i] = krl_read_string(reader);
        type->constants = constants;
        type->size = 1;
        return;
    }
    struct krl_member *members = krl_allocate_read(reader, type->count, sizeof *members);
    for (int32_t i = 0; i < type->count; i++) {
        krl_skip(reader, 1); /* its name */
        members[i].type = krl_read_word(reader);
        members[i].offset = type->size;
        type->size += types[members[i].type].size;
    }
    type->members = members;
}

void krl_read_types(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = krl_read_word(reader);
    program->type_count = KRL_BASIC_TYPES + count;
    program->types = krl_allocate_read(reader, program->type_count, sizeof *program->types);
    for (int32_t i = 0; i < KRL_BASIC_TYPES; i++)
        program->types[i].size = 1;
    for (int32_t i = 0; i < count; i++) /* a type consists of types before it */
        read_type(reader, &program->types[KRL_BASIC_TYPES + i]);
}

/* ---------------------------------------------------------------------------- requests */

/* Appends an input and returns the index of its first cell among those of all inputs. */
static int32_t add_input(struct reader *reader, struct krl_passed passed)
{
    int32_t place = reader->input_cells;
    reader->inputs[reader->input_count++] = passed;
    reader->input_cells += krl_stack_cells(&passed);
    return place;
}

static struct krl_part read_part(struct reader *reader)
{
    struct krl_part part = {KRL_PART_OTHER, 0, {KRL_BY_VALUE, 0, 0}, {NULL, 0}, 0};
    int32_t tag = krl_read_word(reader), count;
    switch (tag) {
    case INT_:
    case REAL_:
    case HANDLE:
        krl_skip(reader, 1);
        break;
    case STRING:
        part.kind = KRL_PART_STRING;
        part.letters = krl_read_letters(reader);
        break;
    case CHOICE:
        part.kind = KRL_PART_CHOICE;
        part.passed.type = krl_read_word(reader);
        part.place = krl_read_word(reader);
        break;
    case INPUT:
        part.kind = KRL_PART_INPUT;
        part.passed = krl_read_passed(reader);
        part.place = add_input(reader, part.passed);
        break;
    case CHANGED:
        part.kind = KRL_PART_CHANGED;
        part.passed = krl_read_passed(reader);
        krl_skip(reader, 1); /* the parameter through which it is passed on */
        count = krl_read_word(reader);
        for (int32_t i = 0; i < count; i++)
            read_part(reader);
        part.has_path = count > 0;
        part.place = add_input(reader, part.passed);
        break;
    case ITEMS:
    case RECORD:
        krl_skip(reader, tag == RECORD ? 2 : 0); /* its line and name */
        count = krl_read_word(reader);
        for (int32_t i = 0; i < count; i++)
            read_part(reader);
        break;
    default:
        break;
    }
    return part;
}

static void read_entry(struct reader *reader, struct krl_entry *entry)
{
    entry->name = krl_read_string(reader);
    entry->result = krl_read_optional(reader);
    entry->part_count = krl_read_word(reader);
    struct krl_part *parts = krl_allocate_read(reader, entry->part_count, sizeof *parts);
    reader->input_count = reader->input_cells = 0;
    for (int32_t i = 0; i < entry->part_count; i++)
        parts[i] = read_part(reader);
    entry->parts = parts;
    entry->input_count = reader->input_count;
    entry->input_cells = reader->input_cells;
    struct krl_passed *inputs = krl_allocate_read(reader, entry->input_count, sizeof *inputs);
    memcpy(inputs, reader->inputs, (size_t)entry->input_count * sizeof *inputs);
    entry->inputs = inputs;
}

struct krl_entry *krl_read_entries(struct reader *reader, int32_t *count)
{
    *count = krl_read_word(reader);
    struct krl_entry *entries = krl_allocate_read(reader, *count, sizeof *entries);
    for (int32_t i = 0; i < *count; i++)
        read_entry(reader, &entries[i]);
    return entries;
}

/* ---------------------------------------------------------------------------- texts and data */

void krl_read_texts(struct reader *reader)
{
    struct krl_program *program = reader->program;
    program->text_count = krl_read_word(reader);
    program->texts = krl_allocate_read(reader, program->text_count, sizeof *program->texts);
    for (int32_t i = 0; i < program->text_count; i++)
        program->texts[i] = krl_read_letters(reader);
}

void krl_read_data(struct reader *reader)
{
    struct krl_program *program = reader->program;
    program->data_count = krl_read_word(reader);
    program->data = krl_allocate_read(reader, program->data_count, sizeof *program->data);
    for (int32_t i = 0; i < program->data_count; i++) {
        krl_skip(reader, 2); /* module and name */
        program->data[i].type = krl_read_word(reader);
        program->data[i].address = program->data_cells;
        krl_skip(reader, 1); /* whether it is GLOBAL */
        program->data_cells += program->types[program->data[i].type].size;
    }
}

/* Returns the variable of the data lists that contains a cell. */
static const struct krl_variable *variable_at(const struct krl_program *program, int32_t address)
{
    int32_t low = 0, high = program->data_count - 1;
    while (low < high) {
        int32_t middle = (low + high + 1) / 2;
        if (program->data[middle].address <= address)
            low = middle;
        else
            high = middle - 1;
    }
    return &program->data[low];
}

void krl_read_initial(struct reader *reader)
{
    struct krl_program *program = reader->program;
    program->initial_count = krl_read_word(reader);
    program->initial = krl_allocate_read(reader, program->initial_count, sizeof *program->initial);
    for (int32_t i = 0; i < program->initial_count; i++) {
        int32_t address = krl_read_word(reader);
        const struct krl_variable *variable = variable_at(program, address);
        int32_t kind = krl_kind_at(program, variable->type, address - variable->address);
        program->initial[i].address = address;
        program->initial[i].cell = krl_cell_of_word(krl_read_word(reader), kind);
    }
}
