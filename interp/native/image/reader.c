/* Reads words, strings, types and modes, which all sections consist of. */
#include "reader.h"

void krl_refuse_image(struct reader *reader, const char *reason)
{
    krl_refuse(reader->why, reason);
    reader->is_wrong = 1;
    reader->left = 0;
}

uint32_t krl_read_word(struct reader *reader)
{
    if (reader->left == 0) {
        krl_refuse_image(reader, "the image is damaged: a section ends early");
        return 0;
    }
    uint32_t found = krl_word_at(reader->next);
    reader->next += 4;
    reader->left--;
    return found;
}

int32_t krl_read_count(struct reader *reader)
{
    uint32_t count = krl_read_word(reader);
    if (count > reader->left) {
        krl_refuse_image(reader, "the image is damaged: a list is longer than its section");
        return 0;
    }
    return (int32_t)count;
}

uint32_t krl_read_choice(struct reader *reader, uint32_t choices)
{
    uint32_t number = krl_read_word(reader);
    if (number >= choices) {
        krl_refuse_image(reader, "the image is damaged: a number is out of range");
        return 0;
    }
    return number;
}

int32_t krl_read_optional(struct reader *reader, int32_t count)
{
    return (int32_t)krl_read_choice(reader, (uint32_t)count + 1) - 1;
}

void *krl_allocate_read(struct reader *reader, int32_t count, size_t size)
{
    void *memory = krl_allocate(reader->program, (size_t)count + 1, size); /* never 0 bytes */
    if (memory == NULL)
        krl_refuse_image(reader, "there is not enough memory for the image");
    return memory;
}

void krl_begin_section(struct reader *reader, struct section section)
{
    if (reader->is_wrong)
        return;
    reader->next = section.bytes;
    reader->left = section.length / 4;
}

void krl_end_section(struct reader *reader)
{
    if (!reader->is_wrong && reader->left != 0)
        krl_refuse_image(reader, "the image is damaged: a section is longer than its contents");
}

/* ---------------------------------------------------------------------------- strings */

void krl_read_strings(struct reader *reader, struct section section)
{
    uint32_t count = section.length >= 4 ? krl_word_at(section.bytes) : 0;
    if (count > section.length / 4 || 4 + 4 * (uint64_t)count > section.length) {
        if (section.length > 0)
            krl_refuse_image(reader, "the image is damaged: the strings end early");
        return;
    }
    uint64_t start = 4 + 4 * (uint64_t)count, total = 0;
    for (uint32_t i = 0; i < count; i++)
        total += krl_word_at(section.bytes + 4 + 4 * i);
    if (start + total > section.length) {
        krl_refuse_image(reader, "the image is damaged: the strings end early");
        return;
    }
    reader->strings = krl_allocate_read(reader, (int32_t)count, sizeof *reader->strings);
    char *kept = krl_allocate_read(reader, (int32_t)total, 1);
    if (reader->is_wrong)
        return;
    memcpy(kept, section.bytes + start, (size_t)total);
    for (uint32_t i = 0; i < count; i++) {
        reader->strings[i].bytes = kept;
        reader->strings[i].length = krl_word_at(section.bytes + 4 + 4 * i);
        kept += reader->strings[i].length;
    }
    reader->string_count = count;
}

struct krl_text krl_read_string(struct reader *reader)
{
    uint32_t number = krl_read_choice(reader, reader->string_count);
    struct krl_text none = {"", 0};
    return reader->is_wrong ? none : reader->strings[number];
}

struct krl_letters krl_read_letters(struct reader *reader)
{
    struct krl_text text = krl_read_string(reader);
    krl_cell *cells = krl_allocate_read(reader, (int32_t)text.length, sizeof *cells);
    struct krl_letters found = {cells, 0};
    for (uint32_t place = 0; place < text.length && cells != NULL; place++) {
        uint8_t first = (uint8_t)text.bytes[place];
        int is_pair = first >= 0xc0 && place + 1 < text.length;
        int32_t code = is_pair ? (first & 3) << 6 | (text.bytes[++place] & 0x3f) : first;
        cells[found.count++] = krl_of_int(code);
    }
    return found;
}

/* ---------------------------------------------------------------------------- types, modes */

int32_t krl_read_type_number(struct reader *reader)
{
    return (int32_t)krl_read_choice(reader, (uint32_t)reader->program->type_count);
}

struct krl_passed krl_read_passed(struct reader *reader)
{
    struct krl_passed passed;
    passed.mode = (enum krl_mode)krl_read_choice(reader, 3);
    passed.type = krl_read_type_number(reader);
    passed.dimensions = (int32_t)krl_read_choice(reader, KRL_MOST_DIMENSIONS + 1);
    if (reader->is_wrong) {
        passed.dimensions = 0;
        passed.type = 0;
    } else if ((passed.mode == KRL_BY_VIEW) != (passed.dimensions > 0))
        krl_refuse_image(reader, "a view has 1 to 3 dimensions, anything else has none");
    else if (passed.mode == KRL_BY_VIEW && reader->program->types[passed.type].form == KRL_ARRAY)
        krl_refuse_image(reader, "the elements of an array cannot be arrays");
    return passed;
}
