/* Reads the sections of an image word by word.
 *
 * Nothing in the image is trusted. After an error every word is read as 0, and the first reason is
 * kept. So callers check `is_wrong` only before they use a number as an index or a size.
 */
#ifndef KRL_READER_H
#define KRL_READER_H

#include "program/program.h"

struct section {
    const uint8_t *bytes;
    uint32_t length;
};

struct reader {
    struct krl_program *program;
    struct krl_refusal *why;
    const uint8_t *next; /* the next word of the section */
    uint32_t left;
    int is_wrong;
    struct krl_text *strings;
    uint32_t string_count;
    /* The inputs of the entry that is being read. */
    struct krl_passed *inputs;
    int32_t input_count;
    int32_t input_cells;
};

static inline uint32_t krl_word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/* ---------------------------------------------------------------------------- reader.c */

/* Refuses the image, for the first reason that is given, and ends the section. */
void krl_refuse_image(struct reader *reader, const char *reason);

/* Returns zeroed memory for `count` elements, at least one, that is freed with the program. Refuses
 * the image and returns NULL if there is not enough. */
void *krl_allocate_read(struct reader *reader, int32_t count, size_t size);

/* Begin a section; refuse the image if a section has words that were not read. */
void krl_begin_section(struct reader *reader, struct section section);
void krl_end_section(struct reader *reader);

uint32_t krl_read_word(struct reader *reader);

/* Returns the length of a list. Every element has at least one word, so a length greater than the
 * rest of the section is refused before memory is allocated for it. */
int32_t krl_read_count(struct reader *reader);

/* krl_read_choice returns a number below `choices`. krl_read_optional returns a number below
 * `count`, or -1 for none: the image has the number plus 1. Other numbers refuse the image. */
uint32_t krl_read_choice(struct reader *reader, uint32_t choices);
int32_t krl_read_optional(struct reader *reader, int32_t count);

/* Read the table of strings, and a string by its index. */
void krl_read_strings(struct reader *reader, struct section section);
struct krl_text krl_read_string(struct reader *reader);

/* Reads a string as a text: each character stands for one byte of the controller, so it has a code
 * below 256 and at most two bytes of UTF-8. */
struct krl_letters krl_read_letters(struct reader *reader);

int32_t krl_read_type_number(struct reader *reader);
struct krl_passed krl_read_passed(struct reader *reader);

/* ---------------------------------------------------------------------------- table_reader.c */

void krl_read_types(struct reader *reader);
void krl_read_texts(struct reader *reader);

/* Reads the table of requests, or that of calls of predefined functions, and sets its length. */
struct krl_entry *krl_read_entries(struct reader *reader, int32_t *count);

/* Read the variables of the data lists, the imports, and the initial values. */
void krl_read_data(struct reader *reader);
void krl_read_imports(struct reader *reader);
void krl_read_initial(struct reader *reader);

/* ---------------------------------------------------------------------------- code_object_reader.c */

void krl_read_codes(struct reader *reader);

/* ---------------------------------------------------------------------------- image.c */

/* Reads an image and copies what it needs. Returns 0, with the reason in `why` and an empty
 * program, if the image is refused. */
int krl_read_image(struct krl_program *program, const uint8_t *image, size_t length,
                   struct krl_refusal *why);

/* Returns the CRC-32 that zlib computes. The header has that of all bytes from 16 on. */
uint32_t krl_checksum(const uint8_t *bytes, size_t length);

#endif
