/* What the parts of the verifier share: what lies on the stack where an instruction is looked at.
 *
 * verify.c follows the ways through a code object. stack_effects.c knows what each instruction takes
 * from the stack and leaves there, operand_checks.c what its operands name.
 */
#ifndef KRL_VERIFIER_H
#define KRL_VERIFIER_H

#include "program/program.h"

/* What lies on the stack. Of a view that may be missing, and of a value that was left out (type -1),
 * nothing is ever used but the sizes, which are 0. */
struct item {
    int32_t type;
    uint8_t mode;
    uint8_t cells;
    uint8_t is_missing;
};

/* An argument or an input, as it lies on the stack. */
static inline struct item krl_item_of(const struct krl_handed *handed)
{
    return (struct item){handed->type, (uint8_t)handed->mode, (uint8_t)krl_stack_cells(handed), 0};
}

struct remembered {
    struct item *items; /* NULL where no way leads to it yet */
    int32_t count;
};

struct flow {
    const struct krl_program *program;
    struct krl_code *code;
    struct krl_refusal *why;
    struct krl_program scratch; /* memory for the time of the check */
    struct remembered *at;      /* for targets only */
    int32_t *todo;
    int32_t todo_count;
    int64_t remembered;
    struct item *stack;
    struct item same; /* what stands for any value in the effect of an instruction */
    int32_t count;
    int32_t cells;
    int is_wrong;
};

/* Notes why the code object is refused. The check goes on to where it looks at `is_wrong`: until
 * then whatever is asked gives something harmless. */
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

/* Changes the stack as the instruction does, or refuses the code object. */
void krl_apply(struct flow *flow, const struct krl_instruction *instruction);

/* ---------------------------------------------------------------------------- operand_checks.c */

/* The type of the cell of a variable; INT where there is none. */
int32_t krl_local_kind(struct flow *flow, int32_t place);
int32_t krl_data_kind(struct flow *flow, int32_t address);

/* The parameter of this mode that begins there; any view where there is none. */
struct item krl_parameter(struct flow *flow, int32_t place, enum krl_mode mode);

/* The stack is empty, and where the code object ends there is no result to be given. */
void krl_check_empty(struct flow *flow);
void krl_check_no_result(struct flow *flow);

/* A part of this type, or the whole variable, begins there. */
void krl_check_part_of_local(struct flow *flow, int32_t place, int32_t type);
void krl_check_part_of_data(struct flow *flow, int32_t address, int32_t type);

/* An enumeration has a constant at this place. */
void krl_check_constant(struct flow *flow, int32_t type, int32_t place);

/* Arrays can have so many dimensions; a type is one; so many indices leave a row of it. */
void krl_check_rank(struct flow *flow, int32_t dimensions);
void krl_check_array(struct flow *flow, int32_t type);
void krl_check_row(struct flow *flow, int32_t array, int32_t count);
void krl_check_view_row(struct flow *flow, int32_t place, int32_t count);

/* Of two structures the cells that both have are of the same kinds; both begin with a pose. */
void krl_check_positions(struct flow *flow, int32_t left, int32_t right);
void krl_check_poses(struct flow *flow, int32_t left, int32_t right);

/* The counter and the limit of a loop are INT, and its step is not 0. */
void krl_check_for_local(struct flow *flow, int32_t counter, int32_t limit, int32_t step);
void krl_check_for_data(struct flow *flow, int32_t counter, int32_t limit, int32_t step);

/* ---------------------------------------------------------------------------- verify.c */

/* Checks what the machine relies on, and finds depths and targets. 0 where the program is refused. */
int krl_verify(struct krl_program *program, struct krl_refusal *why);

#endif
