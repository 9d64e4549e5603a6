/* From the bytes of an image to a program; the format is that of interp/bytecode/image.py.
 *
 * Nothing of the image is trusted. A reader that has met its end or something wrong gives zeros and
 * remembers why, so that it has to be asked only where a number is used to go on.
 */
#include "program.h"

#include <stdio.h>
#include <stdlib.h>

enum { SECTIONS = 8, DEEPEST = 64 };
enum { STRS, TYPE, TEXT, ASKS, BLTN, DATA, INIT, CODE };
enum { NIL, FALSE_, TRUE_, INT_, REAL_, STRING, CHOICE, INPUT, CHANGED, HANDLE, ITEMS, RECORD };

struct section {
    const uint8_t *bytes;
    uint32_t length;
};

struct reader {
    struct krl_program *program;
    struct krl_refusal *why;
    const uint8_t *next; /* words that are left of the section */
    uint32_t left;
    int is_wrong;
    struct krl_text *strings;
    uint32_t string_count;
    /* What is collected while the parts of an entry are read. */
    struct krl_handed *inputs;
    int32_t input_count;
    int32_t input_cells;
};

/* ---------------------------------------------------------------------------- memory */

struct krl_block {
    struct krl_block *before;
    krl_cell bytes[];
};

void *krl_allot(struct krl_program *program, size_t count, size_t size)
{
    if (count > (SIZE_MAX / 2 - sizeof(struct krl_block)) / size)
        return NULL;
    struct krl_block *block = calloc(1, sizeof *block + count * size);
    if (block == NULL)
        return NULL;
    block->before = program->memory;
    program->memory = block;
    return block->bytes;
}

void krl_free_program(struct krl_program *program)
{
    while (program->memory != NULL) {
        struct krl_block *block = program->memory;
        program->memory = block->before;
        free(block);
    }
    memset(program, 0, sizeof *program);
}

int krl_refuse(struct krl_refusal *why, const char *reason)
{
    if (why->text[0] == 0)
        snprintf(why->text, sizeof why->text, "%s", reason);
    return 0;
}

/* ---------------------------------------------------------------------------- words */

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static void wrong(struct reader *reader, const char *reason)
{
    krl_refuse(reader->why, reason);
    reader->is_wrong = 1;
    reader->left = 0;
}

static uint32_t word(struct reader *reader)
{
    if (reader->left == 0) {
        wrong(reader, "the image is damaged: a section ends early");
        return 0;
    }
    uint32_t found = word_at(reader->next);
    reader->next += 4;
    reader->left--;
    return found;
}

/* The length of a list; whatever is read has a word at least. */
static int32_t list(struct reader *reader)
{
    uint32_t count = word(reader);
    if (count > reader->left) {
        wrong(reader, "the image is damaged: a list is longer than its section");
        return 0;
    }
    return (int32_t)count;
}

static uint32_t choice(struct reader *reader, uint32_t choices)
{
    uint32_t number = word(reader);
    if (number >= choices) {
        wrong(reader, "the image is damaged: a number stands for nothing");
        return 0;
    }
    return number;
}

/* A number below a count, or -1 for none. */
static int32_t optional(struct reader *reader, int32_t count)
{
    return (int32_t)choice(reader, (uint32_t)count + 1) - 1;
}

static struct krl_text string(struct reader *reader)
{
    uint32_t number = choice(reader, reader->string_count);
    struct krl_text none = {"", 0};
    return reader->is_wrong ? none : reader->strings[number];
}

static void *allot(struct reader *reader, int32_t count, size_t size)
{
    void *memory = krl_allot(reader->program, (size_t)count + 1, size); /* never of no bytes */
    if (memory == NULL)
        wrong(reader, "there is not enough memory for the image");
    return memory;
}

/* A text as letters: a string has one byte of the controller's in each character. */
static struct krl_letters letters(struct reader *reader)
{
    struct krl_text text = string(reader);
    krl_cell *cells = allot(reader, (int32_t)text.length, sizeof *cells);
    struct krl_letters found = {cells, 0};
    for (uint32_t place = 0; place < text.length && cells != NULL; place++) {
        uint8_t first = (uint8_t)text.bytes[place];
        int is_pair = first >= 0xc0 && place + 1 < text.length;
        int32_t code = is_pair ? (first & 3) << 6 | (text.bytes[++place] & 0x3f) : first;
        cells[found.count++] = krl_of_int(code);
    }
    return found;
}

/* ---------------------------------------------------------------------------- strings, types */

static void read_strings(struct reader *reader, struct section section)
{
    uint32_t count = section.length >= 4 ? word_at(section.bytes) : 0;
    if (count > section.length / 4 || 4 + 4 * (uint64_t)count > section.length) {
        if (section.length > 0)
            wrong(reader, "the image is damaged: the strings end early");
        return;
    }
    uint64_t start = 4 + 4 * (uint64_t)count, total = 0;
    for (uint32_t i = 0; i < count; i++)
        total += word_at(section.bytes + 4 + 4 * i);
    if (start + total > section.length) {
        wrong(reader, "the image is damaged: the strings end early");
        return;
    }
    reader->strings = allot(reader, (int32_t)count, sizeof *reader->strings);
    char *kept = allot(reader, (int32_t)total, 1);
    if (reader->is_wrong)
        return;
    memcpy(kept, section.bytes + start, (size_t)total);
    for (uint32_t i = 0; i < count; i++) {
        reader->strings[i].bytes = kept;
        reader->strings[i].length = word_at(section.bytes + 4 + 4 * i);
        kept += reader->strings[i].length;
    }
    reader->string_count = count;
}

static int32_t type_number(struct reader *reader)
{
    return (int32_t)choice(reader, (uint32_t)reader->program->type_count);
}

/* A size in cells; 0 where there are too many. */
static int32_t sized(struct reader *reader, uint64_t cells)
{
    if (cells == 0 || cells > KRL_MAX_CELLS) {
        wrong(reader, "a type has no cells or too many");
        return 0;
    }
    return (int32_t)cells;
}

static void read_type(struct reader *reader, struct krl_type *type)
{
    const struct krl_type *types = reader->program->types;
    uint64_t cells = 0;
    switch (choice(reader, 3)) {
    case 0: {
        type->form = KRL_STRUCTURE;
        type->name = string(reader);
        type->count = list(reader);
        struct krl_member *members = allot(reader, type->count, sizeof *members);
        for (int32_t i = 0; i < type->count && !reader->is_wrong; i++) {
            string(reader);
            members[i].type = type_number(reader);
            members[i].offset = (int32_t)cells;
            cells += (uint64_t)types[members[i].type].size;
            sized(reader, cells);
        }
        type->members = members;
        break;
    }
    case 1: {
        type->form = KRL_ENUMERATION;
        type->name = string(reader);
        type->count = list(reader);
        struct krl_text *constants = allot(reader, type->count, sizeof *constants);
        for (int32_t i = 0; i < type->count && !reader->is_wrong; i++)
            constants[i] = string(reader);
        type->constants = constants;
        cells = 1;
        break;
    }
    default:
        type->form = KRL_ARRAY;
        type->element = type_number(reader);
        type->count = list(reader);
        cells = (uint64_t)types[type->element].size;
        if (type->count < 1 || type->count > KRL_MOST_DIMENSIONS || types[type->element].form == KRL_ARRAY) {
            wrong(reader, "an array has 1 to 3 dimensions, and no arrays in it");
            return;
        }
        for (int32_t i = 0; i < type->count && !reader->is_wrong; i++) {
            uint32_t size = word(reader);
            cells *= size; /* below 2**20 before */
            type->sizes[i] = sized(reader, cells) ? (int32_t)size : 1;
        }
    }
    type->size = sized(reader, cells);
}

static void read_types(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = list(reader);
    program->types = allot(reader, count + KRL_BASIC_TYPES, sizeof *program->types);
    if (reader->is_wrong)
        return;
    for (program->type_count = 0; program->type_count < KRL_BASIC_TYPES; program->type_count++)
        program->types[program->type_count].size = 1;
    for (int32_t i = 0; i < count && !reader->is_wrong; i++) {
        read_type(reader, &program->types[program->type_count]);
        program->type_count++; /* a type is made of those before it */
    }
}

/* ---------------------------------------------------------------------------- requests */

static struct krl_handed handed_over(struct reader *reader)
{
    struct krl_handed handed;
    handed.mode = (enum krl_mode)choice(reader, 3);
    handed.type = type_number(reader);
    handed.dimensions = (int32_t)choice(reader, KRL_MOST_DIMENSIONS + 1);
    if (reader->is_wrong) {
        handed.dimensions = 0;
        handed.type = 0;
    } else if ((handed.mode == KRL_BY_VIEW) != (handed.dimensions > 0))
        wrong(reader, "a view has 1 to 3 dimensions, and nothing else has any");
    else if (handed.mode == KRL_BY_VIEW && reader->program->types[handed.type].form == KRL_ARRAY)
        wrong(reader, "elements are no arrays");
    return handed;
}

/* Notes an input and gives the place of its first cell. */
static int32_t add_input(struct reader *reader, struct krl_handed handed)
{
    if (reader->is_wrong)
        return 0;
    if (handed.mode == KRL_BY_VALUE && !krl_is_plain(reader->program, handed.type)) {
        wrong(reader, "a structure is handed over by reference");
        return 0;
    }
    int32_t place = reader->input_cells;
    reader->inputs[reader->input_count++] = handed;
    reader->input_cells += krl_stack_cells(&handed);
    return place;
}

static struct krl_part read_part(struct reader *reader, int depth)
{
    struct krl_part part = {KRL_PART_OTHER, 0, {KRL_BY_VALUE, 0, 0}, {NULL, 0}, 0};
    if (depth > DEEPEST) {
        wrong(reader, "the image is damaged: parts lie too deep");
        return part;
    }
    uint32_t tag = choice(reader, RECORD + 1);
    switch (tag) {
    case INT_:
    case REAL_:
    case HANDLE:
        word(reader);
        break;
    case STRING:
        part.kind = KRL_PART_STRING;
        part.letters = letters(reader);
        break;
    case CHOICE:
        part.kind = KRL_PART_CHOICE;
        part.handed.type = type_number(reader);
        part.place = (int32_t)choice(reader, KRL_MAX_CELLS);
        break;
    case INPUT:
        part.kind = KRL_PART_INPUT;
        part.handed = handed_over(reader);
        part.place = add_input(reader, part.handed);
        break;
    case CHANGED: {
        part.handed = handed_over(reader);
        word(reader);
        int32_t count = list(reader);
        for (int32_t i = 0; i < count && !reader->is_wrong; i++)
            read_part(reader, depth + 1);
        if (part.handed.mode == KRL_BY_VALUE)
            wrong(reader, "what changes is handed over by reference");
        part.kind = KRL_PART_CHANGED;
        part.has_path = count > 0;
        part.place = add_input(reader, part.handed);
        break;
    }
    case ITEMS:
    case RECORD: {
        if (tag == RECORD) {
            word(reader);
            string(reader);
        }
        int32_t count = list(reader);
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
    entry->name = string(reader);
    entry->result = optional(reader, reader->program->type_count);
    entry->part_count = list(reader);
    struct krl_part *parts = allot(reader, entry->part_count, sizeof *parts);
    reader->input_count = reader->input_cells = 0;
    for (int32_t i = 0; i < entry->part_count && !reader->is_wrong; i++)
        parts[i] = read_part(reader, 0);
    entry->parts = parts;
    entry->input_count = reader->input_count;
    entry->input_cells = reader->input_cells;
    struct krl_handed *inputs = allot(reader, entry->input_count, sizeof *inputs);
    if (inputs != NULL)
        memcpy(inputs, reader->inputs, (size_t)entry->input_count * sizeof *inputs);
    entry->inputs = inputs;
}

static struct krl_entry *read_entries(struct reader *reader, int32_t *count)
{
    *count = list(reader);
    /* An input has three words at least. */
    reader->inputs = allot(reader, (int32_t)(reader->left / 3), sizeof *reader->inputs);
    struct krl_entry *entries = allot(reader, *count, sizeof *entries);
    for (int32_t i = 0; i < *count && !reader->is_wrong; i++)
        read_entry(reader, &entries[i]);
    return entries;
}

static void read_texts(struct reader *reader)
{
    struct krl_program *program = reader->program;
    program->text_count = list(reader);
    program->texts = allot(reader, program->text_count, sizeof *program->texts);
    for (int32_t i = 0; i < program->text_count && !reader->is_wrong; i++)
        program->texts[i] = letters(reader);
}

/* ---------------------------------------------------------------------------- data */

static void read_data(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = list(reader);
    program->data = allot(reader, count, sizeof *program->data);
    for (int32_t i = 0; i < count && !reader->is_wrong; i++) {
        string(reader);
        string(reader);
        program->data[i].type = type_number(reader);
        program->data[i].address = program->data_cells;
        choice(reader, 2);
        if (!reader->is_wrong)
            program->data_cells += program->types[program->data[i].type].size;
        if (program->data_cells > KRL_MAX_CELLS)
            wrong(reader, "the data lists have too many cells");
    }
    program->data_count = count;
}

static void read_initial(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = list(reader), last = -1;
    program->initial = allot(reader, count, sizeof *program->initial);
    for (int32_t i = 0; i < count && !reader->is_wrong; i++) {
        int32_t address = (int32_t)choice(reader, (uint32_t)program->data_cells);
        int32_t value = (int32_t)word(reader);
        if (reader->is_wrong)
            return;
        const struct krl_variable *variable = krl_data_at(program, address);
        int32_t kind = krl_kind_at(program, variable->type, address - variable->address);
        if (address <= last || !krl_is_word_of(program, value, kind)) {
            wrong(reader, "an initial value has the wrong type or place");
            return;
        }
        last = address;
        program->initial[i].address = address;
        program->initial[i].cell = krl_cell_of_word(value, kind);
    }
    program->initial_count = count;
}

/* ---------------------------------------------------------------------------- code */

struct shape {
    uint32_t operands;
    uint32_t kinds;
};
#define SHAPE(name, count, kinds) {count, kinds},
static const struct shape shapes[] = {KRL_OPCODES(SHAPE)};

static void read_slots(struct reader *reader, struct krl_code *code)
{
    const struct krl_type *types = reader->program->types;
    const uint8_t *start = reader->next;
    uint32_t left = reader->left;
    /* Two passes: how many there are is known when the parameters and captures have been read. */
    struct krl_slot *slots = NULL;
    for (int pass = 0; pass < 2 && !reader->is_wrong; pass++) {
        reader->next = start;
        reader->left = left;
        int32_t parameters = list(reader), offset = 0, number = 0;
        for (; number < parameters && !reader->is_wrong; number++) {
            string(reader);
            struct krl_handed handed = handed_over(reader);
            int32_t cells = handed.mode == KRL_BY_VALUE ? types[handed.type].size : krl_stack_cells(&handed);
            if (slots != NULL)
                slots[number] = (struct krl_slot){handed, 0, offset, cells};
            offset += cells;
            if (offset > KRL_MAX_CELLS)
                wrong(reader, "a frame has too many cells");
        }
        code->capture_count = list(reader);
        for (int32_t i = 0; i < code->capture_count && !reader->is_wrong; i++)
            word(reader);
        int32_t locals = list(reader);
        for (int32_t i = 0; i < locals && !reader->is_wrong; i++, number++) {
            string(reader);
            struct krl_handed handed = {KRL_BY_VALUE, type_number(reader), 0};
            int32_t cells = types[handed.type].size;
            if (slots != NULL)
                slots[number] = (struct krl_slot){handed, 1, offset, cells};
            offset += cells;
            if (offset > KRL_MAX_CELLS)
                wrong(reader, "a frame has too many cells");
        }
        if (pass == 0)
            slots = allot(reader, number, sizeof *slots);
        code->parameter_count = parameters;
        code->slot_count = number;
        code->frame = offset;
    }
    code->slots = slots;
    if (reader->program->data_cells + code->frame > KRL_MAX_CELLS)
        wrong(reader, "the data lists and a frame have too many cells");
}

/* The words of instructions, of which targets become places of instructions. */
static void read_body(struct reader *reader, struct krl_code *code)
{
    int32_t words = list(reader), count = 0;
    const uint8_t *bytes = reader->next;
    int32_t *numbers = allot(reader, words, sizeof *numbers);
    code->body = allot(reader, words, sizeof *code->body);
    if (reader->is_wrong)
        return;
    for (int32_t i = 0; i < words; i++)
        numbers[i] = -1;
    for (int32_t place = 0; place < words && !reader->is_wrong; count++) {
        struct krl_instruction *instruction = &code->body[count];
        instruction->op = choice(reader, KRL_OPCODE_COUNT);
        numbers[place] = count;
        place += 1 + (int32_t)shapes[instruction->op].operands;
        if (place > words) {
            wrong(reader, "the image is damaged: the last instruction is not complete");
            return;
        }
        for (uint32_t i = 0; i < shapes[instruction->op].operands; i++)
            instruction->operands[i] = (int32_t)word(reader);
    }
    code->length = count;
    reader->next = bytes + 4 * (size_t)words;
    for (int32_t i = 0; i < count && !reader->is_wrong; i++)
        for (uint32_t j = 0; j < shapes[code->body[i].op].operands; j++)
            if ((shapes[code->body[i].op].kinds >> 8 * j & 0xff) == KRL_OPERAND_TARGET) {
                int32_t target = code->body[i].operands[j];
                if (target < 0 || target >= words || numbers[target] < 0)
                    wrong(reader, "the image is damaged: a target is no instruction");
                else
                    code->body[i].operands[j] = numbers[target];
            }
}

static void read_code(struct reader *reader, struct krl_code *code)
{
    const struct krl_program *program = reader->program;
    string(reader);
    string(reader);
    code->kind = (enum krl_code_kind)choice(reader, 3);
    word(reader);
    code->owner = optional(reader, program->code_count);
    if (reader->is_wrong)
        return;
    read_slots(reader, code);
    code->result = optional(reader, program->type_count);
    code->stack = (int32_t)choice(reader, 1 << 16);
    if (reader->is_wrong)
        return;
    if (code->result >= 0 && !krl_is_plain(program, code->result))
        wrong(reader, "a result has one cell");
    read_body(reader, code);
}

static void read_codes(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = list(reader);
    program->codes = allot(reader, count, sizeof *program->codes);
    program->code_count = count;
    for (int32_t i = 0; i < count && !reader->is_wrong; i++)
        read_code(reader, &program->codes[i]);
}

/* ---------------------------------------------------------------------------- all of it */

uint32_t krl_checksum(const uint8_t *bytes, size_t length)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (0xedb88320 & (0u - (crc & 1)));
    }
    return ~crc;
}

static int open_sections(struct section *sections, const uint8_t *image, size_t length,
                         struct krl_refusal *why)
{
    static const char names[] = "STRSTYPETEXTASKSBLTNDATAINITCODE";
    size_t start = 20 + 8 * SECTIONS;
    if (length < start || length > INT32_MAX || memcmp(image, KRL_IMAGE_MAGIC, 4) != 0)
        return krl_refuse(why, "not an image, or too short for one");
    if (word_at(image + 4) != KRL_IMAGE_FORMAT)
        return krl_refuse(why, "the image has a format that is not known");
    if (word_at(image + 8) != length || word_at(image + 16) != SECTIONS)
        return krl_refuse(why, "the image has another length than it says, or other sections");
    if (word_at(image + 12) != krl_checksum(image + 16, length - 16))
        return krl_refuse(why, "the image is damaged: its checksum is wrong");
    for (int i = 0; i < SECTIONS; i++) {
        const uint8_t *row = image + 20 + 8 * i;
        uint32_t size = word_at(row + 4);
        if (memcmp(row, names + 4 * i, 4) != 0 || size % 4 != 0 || size > length - start)
            return krl_refuse(why, "the image has other sections than it should");
        sections[i] = (struct section){image + start, size};
        start += size;
    }
    return start == length || krl_refuse(why, "the image is longer than its sections");
}

static void begin(struct reader *reader, struct section section)
{
    if (reader->is_wrong)
        return;
    reader->next = section.bytes;
    reader->left = section.length / 4;
}

static void end(struct reader *reader)
{
    if (!reader->is_wrong && reader->left != 0)
        wrong(reader, "the image is damaged: a section is longer than what it holds");
}

int krl_read_image(struct krl_program *program, const uint8_t *image, size_t length,
                   struct krl_refusal *why)
{
    struct section sections[SECTIONS];
    struct reader reader = {0};
    memset(program, 0, sizeof *program);
    why->text[0] = 0;
    if (!open_sections(sections, image, length, why))
        return 0;
    reader.program = program;
    reader.why = why;
    read_strings(&reader, sections[STRS]);
    begin(&reader, sections[TYPE]), read_types(&reader), end(&reader);
    begin(&reader, sections[TEXT]), read_texts(&reader), end(&reader);
    begin(&reader, sections[ASKS]);
    program->asks = read_entries(&reader, &program->ask_count), end(&reader);
    begin(&reader, sections[BLTN]);
    program->builtins = read_entries(&reader, &program->builtin_count), end(&reader);
    begin(&reader, sections[DATA]), read_data(&reader), end(&reader);
    begin(&reader, sections[INIT]), read_initial(&reader), end(&reader);
    begin(&reader, sections[CODE]), read_codes(&reader), end(&reader);
    if (reader.is_wrong) {
        krl_free_program(program);
        return 0;
    }
    return 1;
}
