/* What the parts of the verifier share: what lies on the stack where an instruction is looked at.
 *
 * verify.c follows the ways through a code object. stack_effects.c knows what each instruction takes
 * from the stack and leaves there, places.c what its operands name.
 */
#ifndef KRL_FLOW_H
#define KRL_FLOW_H

#include "program.h"

/* What lies on the stack. Of a view that may be missing, and of a value that was left out (type -1),
 * nothing is ever used but the sizes, which are 0. */
struct item {
    int32_t type;
    uint8_t mode;
    uint8_t cells;
    uint8_t is_missing;
};

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

/* ---------------------------------------------------------------------------- places.c */

/* The type of the cell of a variable; INT where there is none. */
int32_t krl_local_kind(struct flow *flow, int32_t place);
int32_t krl_data_kind(struct flow *flow, int32_t address);

/* A part of this type, or the whole variable, begins there. */
void krl_check_local_part(struct flow *flow, int32_t place, int32_t type);
void krl_check_data_part(struct flow *flow, int32_t address, int32_t type);

/* The array type that has this number, or NULL. */
const struct krl_type *krl_array_named(struct flow *flow, int32_t number);

/* Whether arrays can have so many dimensions. */
int krl_is_rank(struct flow *flow, int32_t dimensions);

/* Of two structures the cells that both have are of the same kinds. */
void krl_check_alike(struct flow *flow, int32_t left, int32_t right);

/* A structure begins with the six numbers of a pose. */
void krl_check_pose(struct flow *flow, int32_t type);

#endif
