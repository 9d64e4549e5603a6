/* Shared declarations of the verifier: the abstract stack at an instruction.
 *
 * verify.c walks through the control flow of a code object. stack_effects.c has the stack effect of
 * each instruction, operand_checks.c the checks of operands.
 */
#ifndef KRL_VERIFIER_H
#define KRL_VERIFIER_H

#include "program/program.h"

/* An item of the abstract stack. A value that was left out has the type -1. An item that
 * `is_missing` may have been left out: it can only be passed on, to a routine or to a predefined
 * function that reads it as a text. The sizes of a missing view are 0, and nothing else is used. */
struct item {
    int32_t type;
    uint8_t mode;
    uint8_t cells;
    uint8_t is_missing;
};

/* Returns the item of an argument or an input. */
static inline struct item krl_item_of(const struct krl_passed *passed)
{
    return (struct item){passed->type, (uint8_t)passed->mode, (uint8_t)krl_stack_cells(passed), 0};
}

struct remembered {
    struct item *items; /* NULL until a path reaches it */
    int32_t count;
};

struct flow {
    const struct krl_program *program;
    struct krl_code *code;
    struct krl_refusal *why;
    struct krl_program scratch; /* memory that is freed after the check */
    struct remembered *at;      /* the stack at each target */
    int32_t *todo;
    int32_t todo_count;
    int64_t remembered;
    struct item *stack;
    struct item same; /* the value that an instruction has popped or referred to, for its later primitives */
    int32_t count;
    int32_t cells;
    int is_wrong;
};

/* Refuses the code object. The check continues until it looks at `is_wrong`; until then all
 * functions return harmless values. */
static inline void krl_refuse_code(struct flow *flow, const char *reason)
{
    krl_refuse(flow->why, reason);
    flow->is_wrong = 1;
}

static inline int krl_is_same(struct item left, struct item right)
{
    return left.type == right.type && left.mode == right.mode && left.cells == right.cells &&
           left.is_missing == right.is_missing;
}

/* ---------------------------------------------------------------------------- stack_effects.c */

/* Applies the stack effect of an instruction, or refuses the code object. */
void krl_apply(struct flow *flow, const struct krl_instruction *instruction);

/* ---------------------------------------------------------------------------- operand_checks.c */

/* Return the type of a cell of the frame, or of the data lists. Refuse the code object and return
 * INT if the cell belongs to no variable. */
int32_t krl_local_kind(struct flow *flow, int32_t place);
int32_t krl_data_kind(struct flow *flow, int32_t address);

/* Returns the item of the parameter of this mode that begins at a cell. Refuses the code object and
 * returns some view if there is none. */
struct item krl_parameter(struct flow *flow, int32_t place, enum krl_mode mode);

/* Check that the stack is empty; that it is empty at a RETURN, and the code object has no result. */
void krl_check_empty(struct flow *flow);
void krl_check_no_result(struct flow *flow);

/* Check that a part of this type, or the whole variable, begins at a cell. */
void krl_check_part_of_local(struct flow *flow, int32_t place, int32_t type);
void krl_check_part_of_data(struct flow *flow, int32_t address, int32_t type);

/* Checks that a type is an enumeration with a constant of this index. */
void krl_check_constant(struct flow *flow, int32_t type, int32_t place);

/* Check that arrays can have this number of dimensions; that a type is an array; that this number
 * of indices leaves a row: at least one, and not all. */
void krl_check_rank(struct flow *flow, int32_t dimensions);
void krl_check_array(struct flow *flow, int32_t type);
void krl_check_row(struct flow *flow, int32_t array, int32_t count);
void krl_check_view_row(struct flow *flow, int32_t place, int32_t count);

/* Check that the cells that two structures have in common are of the same types; that both begin
 * with a pose, too. */
void krl_check_positions(struct flow *flow, int32_t left, int32_t right);
void krl_check_poses(struct flow *flow, int32_t left, int32_t right);

/* Check that counter and limit of a FOR loop are INT, and the step is not 0. */
void krl_check_for_local(struct flow *flow, int32_t counter, int32_t limit, int32_t step);
void krl_check_for_data(struct flow *flow, int32_t counter, int32_t limit, int32_t step);

/* ---------------------------------------------------------------------------- verify.c */

/* Checks the rules that the machine relies on, and sets depths and targets. Returns 0, with the
 * reason in `why`, if the program is refused. */
int krl_verify(struct krl_program *program, struct krl_refusal *why);

#endif
