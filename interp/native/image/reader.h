/* How the sections of an image are read, word by word.
 *
 * Nothing of the image is trusted. A reader that has met its end or something wrong gives zeros and
 * remembers why, so that it has to be asked only where a number is used to go on.
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

static inline uint32_t krl_word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/* ---------------------------------------------------------------------------- reader.c */

/* Notes why the image is refused; from then on there is nothing left to read. */
void krl_refuse_image(struct reader *reader, const char *reason);

/* Memory for so many, one at least, that is freed with the program; or NULL. */
void *krl_allot_read(struct reader *reader, int32_t count, size_t size);

/* What a section begins with, and that it has been read to its end. */
void krl_begin_section(struct reader *reader, struct section section);
void krl_end_section(struct reader *reader);

uint32_t krl_read_word(struct reader *reader);

/* The length of a list; whatever is read has a word at least. */
int32_t krl_read_count(struct reader *reader);

/* A number below a count; the second one gives -1 for none. */
uint32_t krl_read_choice(struct reader *reader, uint32_t choices);
int32_t krl_read_optional(struct reader *reader, int32_t count);

/* The table of strings, and one of them by its number. */
void krl_read_strings(struct reader *reader, struct section section);
struct krl_text krl_read_string(struct reader *reader);

/* A text as letters: a string has one byte of the controller's in each character. */
struct krl_letters krl_read_letters(struct reader *reader);

int32_t krl_read_type_number(struct reader *reader);
struct krl_handed krl_read_handed(struct reader *reader);

/* ---------------------------------------------------------------------------- table_reader.c */

void krl_read_types(struct reader *reader);
void krl_read_texts(struct reader *reader);

/* The requests, or the calls of predefined functions. */
struct krl_entry *krl_read_entries(struct reader *reader, int32_t *count);

/* The variables of the data lists, and their values in the beginning. */
void krl_read_data(struct reader *reader);
void krl_read_imports(struct reader *reader);
void krl_read_initial(struct reader *reader);

/* ---------------------------------------------------------------------------- code_object_reader.c */

void krl_read_codes(struct reader *reader);

/* ---------------------------------------------------------------------------- image.c */

/* Reads an image. It copies what it needs. 0 where the image is refused; then nothing is left. */
int krl_read_image(struct krl_program *program, const uint8_t *image, size_t length,
                   struct krl_refusal *why);

/* The CRC-32 that an image has of what follows its header. */
uint32_t krl_checksum(const uint8_t *bytes, size_t length);

#endif
