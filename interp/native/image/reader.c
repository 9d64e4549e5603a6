/* Reads an image word by word; interp/bytecode/image/layout.py defines the format. The verifier has
 * accepted it, so nothing is checked again. */
#include "reader.h"

#include <setjmp.h>

/* Where the header has the checksum of the image and the length of the strings, and where these
 * begin, after the table of 9 sections. */
enum { CHECKSUM = 12, LENGTH_OF_STRINGS = 24, STRINGS = 20 + 8 * 9 };

struct variable {
    int32_t type;
    int32_t address;
};

struct reader {
    struct krl_program *program;
    const uint8_t *next; /* the next word */
    const struct krl_text *strings;
    int32_t input_cells; /* of the entry that is being read */
    struct variable *data; /* the variables of the data lists */
    int32_t data_count;
    jmp_buf no_memory;
};

/* Returns zeroed memory for `count` elements, at least one, that is freed with the program. Leaves
 * the reader by `no_memory` if there is not enough. */
static void *allocate(struct reader *reader, int32_t count, size_t size)
{
    void *memory = krl_allocate(reader->program, (size_t)count + 1, size); /* never 0 bytes */
    if (memory == NULL)
        longjmp(reader->no_memory, 1);
    return memory;
}

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static int32_t read_word(struct reader *reader)
{
    uint32_t found = word_at(reader->next);
    reader->next += 4;
    return (int32_t)found;
}

/* Skips this number of words, which only Python uses. */
static void skip(struct reader *reader, int32_t words)
{
    reader->next += 4 * (size_t)words;
}

/* Returns a number, or -1 for none. */
static int32_t read_optional(struct reader *reader)
{
    return read_word(reader) - 1;
}

static struct krl_passed read_passed(struct reader *reader)
{
    struct krl_passed passed;
    passed.mode = (enum krl_mode)read_word(reader);
    passed.type = read_word(reader);
    passed.dimensions = read_word(reader);
    return passed;
}

/* ---------------------------------------------------------------------------- strings */

static void read_strings(struct reader *reader, size_t length)
{
    int32_t count = read_word(reader);
    struct krl_text *strings = allocate(reader, count, sizeof *strings);
    char *bytes = allocate(reader, (int32_t)length, 1);
    for (int32_t i = 0; i < count; i++)
        strings[i].length = (uint32_t)read_word(reader);
    for (int32_t i = 0; i < count; i++) {
        memcpy(bytes, reader->next, strings[i].length);
        strings[i].bytes = bytes;
        bytes += strings[i].length;
        reader->next += strings[i].length;
    }
    reader->strings = strings;
}

static struct krl_text read_string(struct reader *reader)
{
    return reader->strings[read_word(reader)];
}

/* Reads a string as a text: each character stands for one byte of the controller, so it has a code
 * below 256 and at most two bytes of UTF-8. */
static struct krl_letters read_letters(struct reader *reader)
{
    struct krl_text text = read_string(reader);
    krl_cell *cells = allocate(reader, (int32_t)text.length, sizeof *cells);
    struct krl_letters found = {cells, 0};
    for (uint32_t place = 0; place < text.length; place++) {
        uint8_t first = (uint8_t)text.bytes[place];
        int32_t code = first >= 0xc0 ? (first & 3) << 6 | (text.bytes[++place] & 0x3f) : first;
        cells[found.count++] = krl_of_int(code);
    }
    return found;
}

/* ---------------------------------------------------------------------------- types */

static void read_type(struct reader *reader, struct krl_type *type)
{
    const struct krl_type *types = reader->program->types;
    static const enum krl_form forms[] = {KRL_STRUCTURE, KRL_ENUMERATION, KRL_ARRAY};
    type->form = forms[read_word(reader)];
    if (type->form == KRL_ARRAY) {
        type->element = read_word(reader);
        type->count = read_word(reader);
        type->size = types[type->element].size;
        for (int32_t i = 0; i < type->count; i++) {
            type->sizes[i] = read_word(reader);
            type->size *= type->sizes[i];
        }
        return;
    }
    skip(reader, 1); /* its name */
    type->count = read_word(reader);
    if (type->form == KRL_ENUMERATION) {
        struct krl_text *constants = allocate(reader, type->count, sizeof *constants);
        for (int32_t i = 0; i < type->count; i++)
            constants[i] = read_string(reader);
        type->constants = constants;
        type->size = 1;
        return;
    }
    struct krl_member *members = allocate(reader, type->count, sizeof *members);
    for (int32_t i = 0; i < type->count; i++) {
        skip(reader, 1); /* its name */
        members[i].type = read_word(reader);
        members[i].offset = type->size;
        type->size += types[members[i].type].size;
    }
    type->members = members;
}

static void read_types(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = read_word(reader);
    program->types = allocate(reader, KRL_BASIC_TYPES + count, sizeof *program->types);
    for (int32_t i = 0; i < KRL_BASIC_TYPES; i++)
        program->types[i].size = 1;
    for (int32_t i = 0; i < count; i++) /* a type consists of types before it */
        read_type(reader, &program->types[KRL_BASIC_TYPES + i]);
}

/* ---------------------------------------------------------------------------- requests */

enum { NIL, FALSE_, TRUE_, INT_, REAL_, STRING, CHOICE, INPUT, CHANGED, HANDLE, ITEMS, RECORD };

/* Returns the index of an input's first cell among those of all inputs of the entry. */
static int32_t add_input(struct reader *reader, struct krl_passed passed)
{
    int32_t place = reader->input_cells;
    reader->input_cells += krl_stack_cells(&passed);
    return place;
}

static struct krl_part read_part(struct reader *reader)
{
    struct krl_part part = {KRL_PART_OTHER, 0, {KRL_BY_VALUE, 0, 0}, {NULL, 0}, 0};
    int32_t tag = read_word(reader), count;
    switch (tag) {
    case INT_:
    case REAL_:
    case HANDLE:
        skip(reader, 1);
        break;
    case STRING:
        part.kind = KRL_PART_STRING;
        part.letters = read_letters(reader);
        break;
    case CHOICE:
        part.kind = KRL_PART_CHOICE;
        part.passed.type = read_word(reader);
        part.place = read_word(reader);
        break;
    case INPUT:
        part.kind = KRL_PART_INPUT;
        part.passed = read_passed(reader);
        part.place = add_input(reader, part.passed);
        break;
    case CHANGED:
        part.kind = KRL_PART_CHANGED;
        part.passed = read_passed(reader);
        skip(reader, 1); /* the parameter through which it is passed on */
        count = read_word(reader);
        for (int32_t i = 0; i < count; i++)
            read_part(reader);
        part.has_path = count > 0;
        part.place = add_input(reader, part.passed);
        break;
    case ITEMS:
    case RECORD:
        skip(reader, tag == RECORD ? 2 : 0); /* its line and name */
        count = read_word(reader);
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
    entry->name = read_string(reader);
    entry->result = read_optional(reader);
    entry->part_count = read_word(reader);
    struct krl_part *parts = allocate(reader, entry->part_count, sizeof *parts);
    reader->input_cells = 0;
    for (int32_t i = 0; i < entry->part_count; i++)
        parts[i] = read_part(reader);
    entry->parts = parts;
    entry->input_cells = reader->input_cells;
}

/* Reads the table of requests, or that of calls of predefined functions. */
static struct krl_entry *read_entries(struct reader *reader)
{
    int32_t count = read_word(reader);
    struct krl_entry *entries = allocate(reader, count, sizeof *entries);
    for (int32_t i = 0; i < count; i++)
        read_entry(reader, &entries[i]);
    return entries;
}

/* ---------------------------------------------------------------------------- texts and data */

static void read_texts(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = read_word(reader);
    program->texts = allocate(reader, count, sizeof *program->texts);
    for (int32_t i = 0; i < count; i++)
        program->texts[i] = read_letters(reader);
}

static void read_data(struct reader *reader)
{
    struct krl_program *program = reader->program;
    reader->data_count = read_word(reader);
    reader->data = allocate(reader, reader->data_count, sizeof *reader->data);
    for (int32_t i = 0; i < reader->data_count; i++) {
        skip(reader, 2); /* module and name */
        reader->data[i].type = read_word(reader);
        reader->data[i].address = program->data_cells;
        skip(reader, 1); /* whether it is GLOBAL */
        program->data_cells += program->types[reader->data[i].type].size;
    }
}

/* Reads the initial values. Their addresses ascend, and so do those of the variables. */
static void read_initial(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t number = 0;
    program->initial_count = read_word(reader);
    program->initial = allocate(reader, program->initial_count, sizeof *program->initial);
    for (int32_t i = 0; i < program->initial_count; i++) {
        int32_t address = read_word(reader);
        while (number + 1 < reader->data_count && reader->data[number + 1].address <= address)
            number++;
        const struct variable *variable = &reader->data[number];
        int32_t kind = krl_kind_at(program, variable->type, address - variable->address);
        program->initial[i].address = address;
        program->initial[i].cell = krl_cell_of_word(read_word(reader), kind);
    }
}

/* ---------------------------------------------------------------------------- code objects */

struct shape {
    int32_t operands;
    int32_t target; /* which operand is the target of a jump, or -1 */
};
static const struct shape shapes[] = {
#define SHAPE(name, count, target) {count, target},
    KRL_OPCODES(SHAPE)
#undef SHAPE
};

static void add_slot(struct krl_slot *slots, struct krl_code *code, struct krl_passed passed,
                     const struct krl_type *types)
{
    int32_t cells = passed.mode == KRL_BY_VALUE ? types[passed.type].size : krl_stack_cells(&passed);
    slots[code->slot_count++] = (struct krl_slot){passed, code->frame, cells};
    code->frame += cells;
}

static void read_slots(struct reader *reader, struct krl_code *code)
{
    const struct krl_type *types = reader->program->types;
    code->parameter_count = read_word(reader);
    const uint8_t *parameters = reader->next;
    skip(reader, 4 * code->parameter_count);
    code->capture_count = read_word(reader);
    skip(reader, code->capture_count);
    int32_t locals = read_word(reader);
    const uint8_t *first_local = reader->next;
    struct krl_slot *slots = allocate(reader, code->parameter_count + locals, sizeof *slots);
    reader->next = parameters;
    for (int32_t i = 0; i < code->parameter_count; i++) {
        skip(reader, 1); /* its name */
        add_slot(slots, code, read_passed(reader), types);
    }
    reader->next = first_local;
    for (int32_t i = 0; i < locals; i++) {
        skip(reader, 1); /* its name */
        struct krl_passed passed = {KRL_BY_VALUE, read_word(reader), 0};
        add_slot(slots, code, passed, types);
    }
    code->slots = slots;
}

/* Reads the instructions. Targets are word offsets in the image, and become indices of
 * instructions. */
static void read_body(struct reader *reader, struct krl_code *code)
{
    int32_t words = read_word(reader);
    int32_t *numbers = allocate(reader, words, sizeof *numbers);
    code->body = allocate(reader, words, sizeof *code->body);
    code->is_target = allocate(reader, words, sizeof *code->is_target);
    for (int32_t place = 0; place < words; code->length++) {
        struct krl_instruction *instruction = &code->body[code->length];
        instruction->op = (uint32_t)read_word(reader);
        numbers[place] = code->length;
        place += 1 + shapes[instruction->op].operands;
        for (int32_t i = 0; i < shapes[instruction->op].operands; i++)
            instruction->operands[i] = read_word(reader);
    }
    code->is_target[0] = 1;
    for (int32_t i = 0; i < code->length; i++)
        if (shapes[code->body[i].op].target >= 0) {
            int32_t *target = &code->body[i].operands[shapes[code->body[i].op].target];
            *target = numbers[*target];
            code->is_target[*target] = 1;
        }
}

static void read_code(struct reader *reader, struct krl_code *code)
{
    skip(reader, 2); /* name and file */
    code->kind = (enum krl_code_kind)read_word(reader);
    skip(reader, 1); /* its line */
    code->owner = read_optional(reader);
    read_slots(reader, code);
    code->result = read_optional(reader);
    code->stack = read_word(reader);
    read_body(reader, code);
}

static void read_codes(struct reader *reader)
{
    struct krl_program *program = reader->program;
    program->code_count = read_word(reader);
    program->codes = allocate(reader, program->code_count, sizeof *program->codes);
    for (int32_t i = 0; i < program->code_count; i++)
        read_code(reader, &program->codes[i]);
}

/* ---------------------------------------------------------------------------- the image */

uint32_t krl_checksum(const uint8_t *image)
{
    return word_at(image + CHECKSUM);
}

int krl_read_image(struct krl_program *program, const uint8_t *image)
{
    struct reader reader = {0};
    memset(program, 0, sizeof *program);
    reader.program = program;
    reader.next = image + STRINGS;
    if (setjmp(reader.no_memory)) {
        krl_free_program(program);
        return 0;
    }
    read_strings(&reader, word_at(image + LENGTH_OF_STRINGS));
    reader.next = image + STRINGS + word_at(image + LENGTH_OF_STRINGS);
    read_types(&reader);
    read_texts(&reader);
    program->asks = read_entries(&reader);
    program->builtins = read_entries(&reader);
    read_data(&reader);
    read_initial(&reader);
    read_codes(&reader);
    return 1;
}
