/* Reads an image word by word. The verifier has accepted it, so nothing is checked again. */
#ifndef KRL_READER_H
#define KRL_READER_H

#include <setjmp.h>

#include "program/program.h"

struct reader {
    struct krl_program *program;
    const uint8_t *next; /* the next word */
    const struct krl_text *strings;
    /* The inputs of the entry that is being read. */
    struct krl_passed *inputs;
    int32_t input_count;
    int32_t input_cells;
    jmp_buf no_memory;
};

/* ---------------------------------------------------------------------------- reader.c */

/* Returns zeroed memory for `count` elements, at least one, that is freed with the program. Leaves
 * the reader by `no_memory` if there is not enough. */
void *krl_allocate_read(struct reader *reader, int32_t count, size_t size);

int32_t krl_read_word(struct reader *reader);

/* Skips this number of words, which only Python uses. */
void krl_skip(struct reader *reader, int32_t words);

/* Returns a number, or -1 for none. */
int32_t krl_read_optional(struct reader *reader);

struct krl_text krl_read_string(struct reader *reader);

/* Reads a string as a text: each character stands for one byte of the controller, so it has a code
 * below 256 and at most two bytes of UTF-8. */
struct krl_letters krl_read_letters(struct reader *reader);

struct krl_passed krl_read_passed(struct reader *reader);

/* Reads an image and copies what it needs. Returns 0 if there is not enough memory. */
int krl_read_image(struct krl_program *program, const uint8_t *image);

/* Returns the CRC-32 in the header of an image. */
uint32_t krl_checksum(const uint8_t *image);

/* ---------------------------------------------------------------------------- table_reader.c */

void krl_read_types(struct reader *reader);
void krl_read_texts(struct reader *reader);

/* Reads the table of requests, or that of calls of predefined functions, and sets its length. */
struct krl_entry *krl_read_entries(struct reader *reader, int32_t *count);

/* Read the variables of the data lists, and the initial values. */
void krl_read_data(struct reader *reader);
void krl_read_initial(struct reader *reader);

/* ---------------------------------------------------------------------------- code_object_reader.c */

void krl_read_codes(struct reader *reader);

#endif
