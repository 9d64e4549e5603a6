/* Reads an image into a program; interp/bytecode/image/layout.py defines the format. */
#include "reader.h"

/* Where the header has the length of the image, its checksum and the length of the strings, and
 * where these begin, after the table of 9 sections. */
enum { LENGTH = 8, CHECKSUM = 12, LENGTH_OF_STRINGS = 24, STRINGS = 20 + 8 * 9 };

void *krl_allocate_read(struct reader *reader, int32_t count, size_t size)
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

int32_t krl_read_word(struct reader *reader)
{
    uint32_t found = word_at(reader->next);
    reader->next += 4;
    return (int32_t)found;
}

void krl_skip(struct reader *reader, int32_t words)
{
    reader->next += 4 * (size_t)words;
}

int32_t krl_read_optional(struct reader *reader)
{
    return krl_read_word(reader) - 1;
}

/* ---------------------------------------------------------------------------- strings */

static void read_strings(struct reader *reader, size_t length)
{
    int32_t count = krl_read_word(reader);
    struct krl_text *strings = krl_allocate_read(reader, count, sizeof *strings);
    char *bytes = krl_allocate_read(reader, (int32_t)length, 1);
    for (int32_t i = 0; i < count; i++)
        strings[i].length = (uint32_t)krl_read_word(reader);
    for (int32_t i = 0; i < count; i++) {
        memcpy(bytes, reader->next, strings[i].length);
        strings[i].bytes = bytes;
        bytes += strings[i].length;
        reader->next += strings[i].length;
    }
    reader->strings = strings;
}

struct krl_text krl_read_string(struct reader *reader)
{
    return reader->strings[krl_read_word(reader)];
}

struct krl_letters krl_read_letters(struct reader *reader)
{
    struct krl_text text = krl_read_string(reader);
    krl_cell *cells = krl_allocate_read(reader, (int32_t)text.length, sizeof *cells);
    struct krl_letters found = {cells, 0};
    for (uint32_t place = 0; place < text.length; place++) {
        uint8_t first = (uint8_t)text.bytes[place];
        int32_t code = first >= 0xc0 ? (first & 3) << 6 | (text.bytes[++place] & 0x3f) : first;
        cells[found.count++] = krl_of_int(code);
    }
    return found;
}

struct krl_passed krl_read_passed(struct reader *reader)
{
    struct krl_passed passed;
    passed.mode = (enum krl_mode)krl_read_word(reader);
    passed.type = krl_read_word(reader);
    passed.dimensions = krl_read_word(reader);
    return passed;
}

/* ---------------------------------------------------------------------------- the image */

uint32_t krl_checksum(const uint8_t *image)
{
    return word_at(image + CHECKSUM);
}

int krl_read_image(struct krl_program *program, const uint8_t *image)
{
    struct reader reader = {0};
    size_t length = word_at(image + LENGTH_OF_STRINGS);
    memset(program, 0, sizeof *program);
    reader.program = program;
    reader.next = image + STRINGS;
    if (setjmp(reader.no_memory)) {
        krl_free_program(program);
        return 0;
    }
    /* An input takes four words of the image, so there cannot be more. */
    reader.inputs = krl_allocate_read(&reader, (int32_t)(word_at(image + LENGTH) / 16), sizeof *reader.inputs);
    read_strings(&reader, length);
    reader.next = image + STRINGS + length;
    krl_read_types(&reader);
    krl_read_texts(&reader);
    program->asks = krl_read_entries(&reader, &program->ask_count);
    program->builtins = krl_read_entries(&reader, &program->builtin_count);
    krl_read_data(&reader);
    krl_read_initial(&reader);
    krl_read_codes(&reader);
    return 1;
}
