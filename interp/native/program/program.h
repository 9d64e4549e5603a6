/* A program in memory, as defined in interp/bytecode/program.py.
 *
 * All of it is allocated in one arena and freed together. Types, entries and code objects are
 * referred to by their index in a table; -1 stands for none.
 */
#ifndef KRL_PROGRAM_H
#define KRL_PROGRAM_H

#include <stddef.h>
#include <stdint.h>

#include "cells.h"
#include "isa.gen.h"

/* The first types of every program. */
enum { KRL_TYPE_INT, KRL_TYPE_REAL, KRL_TYPE_BOOL, KRL_TYPE_CHAR, KRL_BASIC_TYPES };

enum krl_form { KRL_SCALAR, KRL_ENUMERATION, KRL_STRUCTURE, KRL_ARRAY };
enum krl_mode { KRL_BY_VALUE, KRL_BY_REFERENCE, KRL_BY_VIEW };
enum krl_code_kind { KRL_ROUTINE, KRL_ACTION, KRL_CONDITION };
enum { KRL_MOST_DIMENSIONS = 3 };

struct krl_text {
    const char *bytes; /* UTF-8, not terminated by zero */
    uint32_t length;
};

/* A text as the cells of an array of CHAR. */
struct krl_letters {
    const krl_cell *cells;
    int32_t count;
};

struct krl_member {
    int32_t type;
    int32_t offset; /* of its first cell in the structure */
};

struct krl_type {
    enum krl_form form;
    int32_t size;  /* in cells */
    int32_t count; /* number of constants, members or dimensions */
    const struct krl_text *constants;
    const struct krl_member *members;
    int32_t element;
    int32_t sizes[KRL_MOST_DIMENSIONS];
};

/* The mode and type of a parameter, or of an input of a request or a predefined function.
 * `dimensions` is 0 unless it is a view, whose `type` is that of the elements. */
struct krl_passed {
    enum krl_mode mode;
    int32_t type;
    int32_t dimensions;
};

/* Returns the number of cells on the operand stack: a view has an address and the size of each
 * dimension. */
static inline int32_t krl_stack_cells(const struct krl_passed *passed)
{
    return 1 + passed->dimensions;
}

/* An argument of a predefined function, or a field of a request. KRL_PART_OTHER stands for kinds
 * that C does not use. */
enum krl_part_kind { KRL_PART_INPUT, KRL_PART_CHANGED, KRL_PART_STRING, KRL_PART_CHOICE, KRL_PART_OTHER };

struct krl_part {
    enum krl_part_kind kind;
    int32_t place; /* index of its first cell among the inputs, or of the constant */
    struct krl_passed passed;
    struct krl_letters letters;
    int has_path; /* KRL_PART_CHANGED: the reference is to a copy of a system variable */
};

/* A request or a call of a predefined function. */
struct krl_entry {
    struct krl_text name;
    int32_t result;
    int32_t input_cells;
    const struct krl_part *parts;
    int32_t part_count;
};

/* A parameter or local variable, with its first cell in the frame and its size in cells. */
struct krl_slot {
    struct krl_passed passed; /* a local has the mode of a parameter :IN */
    int32_t offset;
    int32_t cells;
};

struct krl_instruction {
    uint32_t op;
    int32_t operands[4]; /* a target is the index of an instruction, not of a word */
};

struct krl_code {
    enum krl_code_kind kind;
    int32_t owner;
    int32_t result;
    int32_t stack; /* maximum size of the operand stack, in cells */
    int32_t frame; /* size of the parameters and locals, in cells */
    const struct krl_slot *slots;
    int32_t slot_count;
    int32_t parameter_count;
    int32_t capture_count;
    struct krl_instruction *body;
    int32_t length;
    const int32_t *depths; /* cells on the stack before each instruction, -1 if it is unreachable */
    uint8_t *is_target;    /* whether an instruction is the first or a target */
};

struct krl_value {
    int32_t address;
    krl_cell cell;
};

struct krl_program {
    struct krl_type *types;
    struct krl_letters *texts;
    struct krl_entry *asks;
    struct krl_entry *builtins;
    int32_t data_cells;
    struct krl_value *initial;
    int32_t initial_count;
    struct krl_code *codes;
    int32_t code_count;
    struct krl_block *memory;
};

/* ---------------------------------------------------------------------------- program.c */

/* Returns zeroed memory that is freed with the program, or NULL. */
void *krl_allocate(struct krl_program *program, size_t count, size_t size);
void krl_free_program(struct krl_program *program);

/* ---------------------------------------------------------------------------- types.c */

/* Returns the type of the cell at an offset of a type: a scalar or an enumeration. */
int32_t krl_kind_at(const struct krl_program *program, int32_t number, int32_t offset);

/* Whether a type is a scalar or an enumeration. */
int krl_is_plain(const struct krl_program *program, int32_t type);

/* Returns the cell for a word that is a value of a scalar or an enumeration. */
krl_cell krl_cell_of_word(int32_t word, int32_t type);

/* Returns the parameter or local that contains a cell of the frame. */
const struct krl_slot *krl_slot_at(const struct krl_code *code, int32_t offset);

#endif
