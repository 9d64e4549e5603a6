/* Reads the tables of an image: types, requests, calls of predefined functions, texts, data lists. */
#include "reader.h"

enum { DEEPEST = 64 };
enum { NIL, FALSE_, TRUE_, INT_, REAL_, STRING, CHOICE, INPUT, CHANGED, HANDLE, ITEMS, RECORD };

/* ---------------------------------------------------------------------------- types */

/* Returns a size in cells. Refuses the image and returns 0 if it is 0 or greater than
 * KRL_MAX_CELLS. */
static int32_t sized(struct reader *reader, uint64_t cells)
{
    if (cells == 0 || cells > KRL_MAX_CELLS) {
        krl_refuse_image(reader, "a type has no cells or too many");
        return 0;
    }
    return (int32_t)cells;
}

static void read_type(struct reader *reader, struct krl_type *type)
{
    const struct krl_type *types = reader->program->types;
    uint64_t cells = 0;
    switch (krl_read_choice(reader, 3)) {
    case 0: {
        type->form = KRL_STRUCTURE;
        type->name = krl_read_string(reader);
        type->count = krl_read_count(reader);
        struct krl_member *members = krl_allocate_read(reader, type->count, sizeof *members);
        for (int32_t i = 0; i < type->count && !reader->is_wrong; i++) {
            krl_read_string(reader);
            members[i].type = krl_read_type_number(reader);
            members[i].offset = (int32_t)cells;
            cells += (uint64_t)types[members[i].type].size;
            sized(reader, cells);
        }
        type->members = members;
        break;
    }
    case 1: {
        type->form = KRL_ENUMERATION;
        type->name = krl_read_string(reader);
        type->count = krl_read_count(reader);
        struct krl_text *constants = krl_allocate_read(reader, type->count, sizeof *constants);
        for (int32_t i = 0; i < type->count && !reader->is_wrong; i++)
            constants[i] = krl_read_string(reader);
        type->constants = constants;
        cells = 1;
        break;
    }
    default:
        type->form = KRL_ARRAY;
        type->element = krl_read_type_number(reader);
        type->count = krl_read_count(reader);
        cells = (uint64_t)types[type->element].size;
        if (type->count < 1 || type->count > KRL_MOST_DIMENSIONS || types[type->element].form == KRL_ARRAY) {
            krl_refuse_image(reader, "an array has 1 to 3 dimensions, and its elements are not arrays");
            return;
        }
        for (int32_t i = 0; i < type->count && !reader->is_wrong; i++) {
            uint32_t size = krl_read_word(reader);
            cells *= size; /* no overflow: at most 2**20 before */
            type->sizes[i] = sized(reader, cells) ? (int32_t)size : 1;
        }
    }
    type->size = sized(reader, cells);
}

void krl_read_types(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = krl_read_count(reader);
    program->types = krl_allocate_read(reader, count + KRL_BASIC_TYPES, sizeof *program->types);
    if (reader->is_wrong)
        return;
    for (program->type_count = 0; program->type_count < KRL_BASIC_TYPES; program->type_count++)
        program->types[program->type_count].size = 1;
    for (int32_t i = 0; i < count && !reader->is_wrong; i++) {
        read_type(reader, &program->types[program->type_count]);
        program->type_count++; /* a type consists of types before it */
    }
}

/* ---------------------------------------------------------------------------- requests */

/* Appends an input and returns the index of its first cell among those of all inputs. */
static int32_t add_input(struct reader *reader, struct krl_passed passed)
{
    if (reader->is_wrong)
        return 0;
    if (passed.mode == KRL_BY_VALUE && !krl_is_plain(reader->program, passed.type)) {
        krl_refuse_image(reader, "a structure must be passed by reference");
        return 0;
    }
    int32_t place = reader->input_cells;
    reader->inputs[reader->input_count++] = passed;
    reader->input_cells += krl_stack_cells(&passed);
    return place;
}

static struct krl_part read_part(struct reader *reader, int depth)
{
    struct krl_part part = {KRL_PART_OTHER, 0, {KRL_BY_VALUE, 0, 0}, {NULL, 0}, 0};
    if (depth > DEEPEST) {
        krl_refuse_image(reader, "the image is damaged: parts are nested too deeply");
        return part;
    }
    uint32_t tag = krl_read_choice(reader, RECORD + 1);
    switch (tag) {
    case INT_:
    case REAL_:
    case HANDLE:
        krl_read_word(reader);
        break;
    case STRING:
        part.kind = KRL_PART_STRING;
        part.letters = krl_read_letters(reader);
        break;
    case CHOICE:
        part.kind = KRL_PART_CHOICE;
        part.passed.type = krl_read_type_number(reader);
        part.place = (int32_t)krl_read_choice(reader, KRL_MAX_CELLS);
        break;
    case INPUT:
        part.kind = KRL_PART_INPUT;
        part.passed = krl_read_passed(reader);
        part.place = add_input(reader, part.passed);
        break;
    case CHANGED: {
        part.passed = krl_read_passed(reader);
        krl_read_word(reader);
        int32_t count = krl_read_count(reader);
        for (int32_t i = 0; i < count && !reader->is_wrong; i++)
            read_part(reader, depth + 1);
        if (part.passed.mode == KRL_BY_VALUE)
            krl_refuse_image(reader, "an argument that is changed must be passed by reference");
        part.kind = KRL_PART_CHANGED;
        part.has_path = count > 0;
        part.place = add_input(reader, part.passed);
        break;
    }
    case ITEMS:
    case RECORD: {
        if (tag == RECORD) {
            krl_read_word(reader);
            krl_read_string(reader);
        }
        int32_t count = krl_read_count(reader);
        for (int32_t i = 0; i < count && !reader->is_wrong; i++)
            read_part(reader, depth + 1);
        break;
    }
    default:
        break;
    }
    return part;
}

static void read_entry(struct reader *reader, struct krl_entry *entry)
{
    entry->name = krl_read_string(reader);
    entry->result = krl_read_optional(reader, reader->program->type_count);
    entry->part_count = krl_read_count(reader);
    struct krl_part *parts = krl_allocate_read(reader, entry->part_count, sizeof *parts);
    reader->input_count = reader->input_cells = 0;
    for (int32_t i = 0; i < entry->part_count && !reader->is_wrong; i++)
        parts[i] = read_part(reader, 0);
    entry->parts = parts;
    entry->input_count = reader->input_count;
    entry->input_cells = reader->input_cells;
    struct krl_passed *inputs = krl_allocate_read(reader, entry->input_count, sizeof *inputs);
    if (inputs != NULL)
        memcpy(inputs, reader->inputs, (size_t)entry->input_count * sizeof *inputs);
    entry->inputs = inputs;
}

struct krl_entry *krl_read_entries(struct reader *reader, int32_t *count)
{
    *count = krl_read_count(reader);
    /* An input has at least three words, so there cannot be more. */
    reader->inputs = krl_allocate_read(reader, (int32_t)(reader->left / 3), sizeof *reader->inputs);
    struct krl_entry *entries = krl_allocate_read(reader, *count, sizeof *entries);
    for (int32_t i = 0; i < *count && !reader->is_wrong; i++)
        read_entry(reader, &entries[i]);
    return entries;
}

/* ---------------------------------------------------------------------------- texts and data */

void krl_read_texts(struct reader *reader)
{
    struct krl_program *program = reader->program;
    program->text_count = krl_read_count(reader);
    program->texts = krl_allocate_read(reader, program->text_count, sizeof *program->texts);
    for (int32_t i = 0; i < program->text_count && !reader->is_wrong; i++)
        program->texts[i] = krl_read_letters(reader);
}

void krl_read_data(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = krl_read_count(reader);
    program->data = krl_allocate_read(reader, count, sizeof *program->data);
    for (int32_t i = 0; i < count && !reader->is_wrong; i++) {
        krl_read_string(reader);
        krl_read_string(reader);
        program->data[i].type = krl_read_type_number(reader);
        program->data[i].address = program->data_cells;
        krl_read_choice(reader, 2);
        if (!reader->is_wrong)
            program->data_cells += program->types[program->data[i].type].size;
        if (program->data_cells > KRL_MAX_CELLS)
            krl_refuse_image(reader, "the data lists have too many cells");
    }
    program->data_count = count;
}

/* Only validates the imports, which name variables of other data lists: Python alone uses the
 * names. */
void krl_read_imports(struct reader *reader)
{
    int32_t count = krl_read_count(reader);
    for (int32_t i = 0; i < count && !reader->is_wrong; i++) {
        for (int string = 0; string < 3; string++)
            krl_read_string(reader);
        krl_read_choice(reader, (uint32_t)reader->program->data_count);
    }
}

void krl_read_initial(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = krl_read_count(reader), last = -1;
    program->initial = krl_allocate_read(reader, count, sizeof *program->initial);
    for (int32_t i = 0; i < count && !reader->is_wrong; i++) {
        int32_t address = (int32_t)krl_read_choice(reader, (uint32_t)program->data_cells);
        int32_t value = (int32_t)krl_read_word(reader);
        if (reader->is_wrong)
            return;
        const struct krl_variable *variable = krl_data_at(program, address);
        int32_t kind = krl_kind_at(program, variable->type, address - variable->address);
        if (address <= last || !krl_is_word_of(program, value, kind)) {
            krl_refuse_image(reader, "an initial value has the wrong type or place");
            return;
        }
        last = address;
        program->initial[i].address = address;
        program->initial[i].cell = krl_cell_of_word(value, kind);
    }
    program->initial_count = count;
}
