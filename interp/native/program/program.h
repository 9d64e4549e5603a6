/* A program in memory, as interp/bytecode/program.py has it, and how it is read from an image.
 *
 * All of it lies in one arena and is freed with it. Numbers of types, entries and code objects are
 * places in the tables; -1 stands for none.
 */
#ifndef KRL_PROGRAM_H
#define KRL_PROGRAM_H

#include <stddef.h>
#include <stdint.h>

#include "cells.h"
#include "isa.gen.h"

/* The types that every program begins with. */
enum { KRL_TYPE_INT, KRL_TYPE_REAL, KRL_TYPE_BOOL, KRL_TYPE_CHAR, KRL_BASIC_TYPES };

enum krl_form { KRL_SCALAR, KRL_ENUMERATION, KRL_STRUCTURE, KRL_ARRAY };
enum krl_mode { KRL_BY_VALUE, KRL_BY_REFERENCE, KRL_BY_VIEW };
enum krl_code_kind { KRL_ROUTINE, KRL_ACTION, KRL_CONDITION };
enum { KRL_MOST_DIMENSIONS = 3 };

struct krl_text {
    const char *bytes; /* UTF-8, not ended by a zero */
    uint32_t length;
};

/* A text as an array of CHAR has it. */
struct krl_letters {
    const krl_cell *cells;
    int32_t count;
};

struct krl_member {
    int32_t type;
    int32_t offset; /* its first cell within the structure */
};

struct krl_type {
    enum krl_form form;
    int32_t size;  /* in cells */
    int32_t count; /* constants, members or dimensions */
    struct krl_text name;
    const struct krl_text *constants;
    const struct krl_member *members;
    int32_t element;
    int32_t sizes[KRL_MOST_DIMENSIONS];
};

/* What is handed over: a parameter, or an input of a request or predefined function. */
struct krl_handed {
    enum krl_mode mode;
    int32_t type;
    int32_t dimensions;
};

/* How many cells it has on the stack. */
static inline int32_t krl_stack_cells(const struct krl_handed *handed)
{
    return 1 + handed->dimensions;
}

/* A part of a call of a predefined function, as far as this machine carries it out itself. */
enum krl_part_kind { KRL_PART_INPUT, KRL_PART_CHANGED, KRL_PART_STRING, KRL_PART_CHOICE, KRL_PART_OTHER };

struct krl_part {
    enum krl_part_kind kind;
    int32_t place; /* the first of its cells among the inputs, or the place of the constant */
    struct krl_handed handed;
    struct krl_letters letters;
    int has_path; /* changed, and a copy of a system variable */
};

/* A request or a call of a predefined function. */
struct krl_entry {
    struct krl_text name;
    int32_t result;
    const struct krl_handed *inputs;
    int32_t input_count;
    int32_t input_cells;
    const struct krl_part *parts;
    int32_t part_count;
};

/* A parameter or local: its first cell in the frame and how many it has. */
struct krl_slot {
    struct krl_handed handed; /* a local is like a parameter :IN */
    int is_local;
    int32_t offset;
    int32_t cells;
};

struct krl_instruction {
    uint32_t op;
    int32_t operands[4]; /* targets are places of instructions, not of words */
};

struct krl_code {
    enum krl_code_kind kind;
    int32_t owner;
    int32_t result;
    int32_t stack; /* the most cells that it has on the stack of operands */
    int32_t frame; /* cells of a frame */
    const struct krl_slot *slots;
    int32_t slot_count;
    int32_t parameter_count;
    int32_t capture_count;
    struct krl_instruction *body;
    int32_t length;
    /* Found by krl_verify. */
    int32_t *depths; /* cells on the stack before each instruction, -1 where no way leads to it */
    uint8_t *leads;  /* whether an instruction is a target */
};

struct krl_value {
    int32_t address;
    krl_cell cell;
};

struct krl_variable {
    int32_t type;
    int32_t address;
};

struct krl_program {
    struct krl_type *types;
    int32_t type_count;
    struct krl_letters *texts;
    int32_t text_count;
    struct krl_entry *asks;
    int32_t ask_count;
    struct krl_entry *builtins;
    int32_t builtin_count;
    struct krl_variable *data;
    int32_t data_count;
    int32_t data_cells;
    struct krl_value *initial;
    int32_t initial_count;
    struct krl_code *codes;
    int32_t code_count;
    struct krl_block *memory;
};

/* Why an image is refused: one line, without any text of the image. */
struct krl_refusal {
    char text[120];
};

/* ---------------------------------------------------------------------------- program.c */

/* Memory of zeros that is freed with the program, or NULL. */
void *krl_allot(struct krl_program *program, size_t count, size_t size);
void krl_free_program(struct krl_program *program);

/* Notes the reason and gives 0. */
int krl_refuse(struct krl_refusal *why, const char *reason);

/* ---------------------------------------------------------------------------- types.c */

/* The type that a cell of a type has: a scalar or an enumeration. */
int32_t krl_kind_at(const struct krl_program *program, int32_t type, int32_t offset);

/* Whether a part of this type begins there: a member, an element, a row, or the whole. */
int krl_has_part(const struct krl_program *program, int32_t whole, int32_t offset, int32_t wanted);

int krl_is_plain(const struct krl_program *program, int32_t type);

/* Whether a word stands for a value of a scalar or an enumeration; the cell that holds it. */
int krl_is_word_of(const struct krl_program *program, int32_t word, int32_t type);
krl_cell krl_cell_of_word(int32_t word, int32_t type);

/* The variable of the data lists that has a cell, or NULL. */
const struct krl_variable *krl_data_at(const struct krl_program *program, int32_t address);

/* The parameter or local that has a cell of the frame, or NULL. */
const struct krl_slot *krl_slot_at(const struct krl_code *code, int32_t offset);

#endif
