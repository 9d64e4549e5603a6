/* Reads an image into a program; interp/bytecode/image/layout.py defines the format.
 *
 * This file reads the header and defines the order of the sections. table_reader.c and
 * code_object_reader.c read their contents, with a reader that trusts none of them (reader.h).
 */
#include "reader.h"

enum { SECTIONS = 9 };
enum { STRS, TYPE, TEXT, ASKS, BLTN, DATA, INIT, CODE, IMPT };

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
    static const char names[] = "STRSTYPETEXTASKSBLTNDATAINITCODEIMPT";
    size_t start = 20 + 8 * SECTIONS;
    if (length < start || length > INT32_MAX || memcmp(image, KRL_IMAGE_MAGIC, 4) != 0)
        return krl_refuse(why, "not an image, or too short for one");
    if (krl_word_at(image + 4) != KRL_IMAGE_FORMAT)
        return krl_refuse(why, "the image has another format: compile it again");
    if (krl_word_at(image + 8) != length || krl_word_at(image + 16) != SECTIONS)
        return krl_refuse(why, "the image does not have the length or the sections that it states");
    if (krl_word_at(image + 12) != krl_checksum(image + 16, length - 16))
        return krl_refuse(why, "the image is damaged: its checksum is wrong");
    for (int i = 0; i < SECTIONS; i++) {
        const uint8_t *row = image + 20 + 8 * i;
        uint32_t size = krl_word_at(row + 4);
        if (memcmp(row, names + 4 * i, 4) != 0 || size % 4 != 0 || size > length - start)
            return krl_refuse(why, "the sections of the image are not those of its format");
        sections[i] = (struct section){image + start, size};
        start += size;
    }
    return start == length || krl_refuse(why, "the image is longer than its sections");
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
    krl_read_strings(&reader, sections[STRS]);
    krl_begin_section(&reader, sections[TYPE]), krl_read_types(&reader), krl_end_section(&reader);
    krl_begin_section(&reader, sections[TEXT]), krl_read_texts(&reader), krl_end_section(&reader);
    krl_begin_section(&reader, sections[ASKS]);
    program->asks = krl_read_entries(&reader, &program->ask_count), krl_end_section(&reader);
    krl_begin_section(&reader, sections[BLTN]);
    program->builtins = krl_read_entries(&reader, &program->builtin_count), krl_end_section(&reader);
    krl_begin_section(&reader, sections[DATA]), krl_read_data(&reader), krl_end_section(&reader);
    krl_begin_section(&reader, sections[INIT]), krl_read_initial(&reader), krl_end_section(&reader);
    krl_begin_section(&reader, sections[CODE]), krl_read_codes(&reader), krl_end_section(&reader);
    krl_begin_section(&reader, sections[IMPT]), krl_read_imports(&reader), krl_end_section(&reader);
    if (reader.is_wrong) {
        krl_free_program(program);
        return 0;
    }
    return 1;
}
