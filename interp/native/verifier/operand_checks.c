/* Checks of operands, by interp/bytecode/instructions.tsv: what they refer to, and the conditions
 * on that. A check that fails refuses the code object. */
#include "verifier.h"

/* ---------------------------------------------------------------------------- variables */

/* Returns the variable that contains cell `place` of the frame, and sets `place` to the offset in
 * it. Returns NULL, with the code object refused, if there is none. */
static const struct krl_slot *variable(struct flow *flow, int32_t *place)
{
    const struct krl_slot *slot = krl_slot_at(flow->code, *place);
    if (slot == NULL || slot->passed.mode != KRL_BY_VALUE) {
        krl_refuse_code(flow, slot == NULL ? "the frame has no such cell" : "the cell holds a reference");
        return NULL;
    }
    *place -= slot->offset;
    return slot;
}

int32_t krl_local_kind(struct flow *flow, int32_t place)
{
    const struct krl_slot *slot = variable(flow, &place);
    return slot == NULL ? KRL_TYPE_INT : krl_kind_at(flow->program, slot->passed.type, place);
}

int32_t krl_data_kind(struct flow *flow, int32_t address)
{
    const struct krl_variable *found = krl_data_at(flow->program, address);
    if (found == NULL) {
        krl_refuse_code(flow, "the data lists have no such cell");
        return KRL_TYPE_INT;
    }
    return krl_kind_at(flow->program, found->type, address - found->address);
}

struct item krl_parameter(struct flow *flow, int32_t place, enum krl_mode mode)
{
    const struct krl_slot *slot = krl_slot_at(flow->code, place);
    if (slot == NULL)
        krl_refuse_code(flow, "the frame has no such cell");
    else if (slot->offset != place || slot->is_local)
        krl_refuse_code(flow, "no parameter begins at this cell");
    else if (slot->passed.mode != mode)
        krl_refuse_code(flow, "the parameter is passed in another way");
    else
        return krl_item_of(&slot->passed);
    return (struct item){KRL_TYPE_INT, KRL_BY_VIEW, 2, 0};
}

void krl_check_part_of_local(struct flow *flow, int32_t place, int32_t type)
{
    const struct krl_slot *slot = variable(flow, &place);
    if (slot != NULL && !krl_has_part(flow->program, slot->passed.type, place, type))
        krl_refuse_code(flow, "no part of this type begins here");
}

void krl_check_part_of_data(struct flow *flow, int32_t address, int32_t type)
{
    const struct krl_variable *found = krl_data_at(flow->program, address);
    if (found == NULL || !krl_has_part(flow->program, found->type, address - found->address, type))
        krl_refuse_code(flow, "no part of this type begins here");
}

/* ---------------------------------------------------------------------------- the stack */

void krl_check_empty(struct flow *flow)
{
    if (flow->count > 0)
        krl_refuse_code(flow, "the stack must be empty here");
}

void krl_check_no_result(struct flow *flow)
{
    if (flow->code->result >= 0 || flow->code->kind == KRL_CONDITION)
        krl_refuse_code(flow, "the code object must return a result");
    else if (flow->count > 0)
        krl_refuse_code(flow, "the stack must be empty here");
}

/* ---------------------------------------------------------------------------- types */

void krl_check_constant(struct flow *flow, int32_t type, int32_t place)
{
    if (flow->program->types[type].form != KRL_ENUMERATION || place >= flow->program->types[type].count)
        krl_refuse_code(flow, "the enumeration has no such constant");
}

void krl_check_rank(struct flow *flow, int32_t dimensions)
{
    if (dimensions < 1 || dimensions > KRL_MOST_DIMENSIONS)
        krl_refuse_code(flow, "an array has 1 to 3 dimensions");
}

void krl_check_array(struct flow *flow, int32_t type)
{
    if (flow->program->types[type].form != KRL_ARRAY)
        krl_refuse_code(flow, "an array is required");
}

static void check_indices(struct flow *flow, int32_t count, int32_t dimensions)
{
    if (count < 1 || count >= dimensions)
        krl_refuse_code(flow, "a row needs at least one index, but not all of them");
}

void krl_check_row(struct flow *flow, int32_t array, int32_t count)
{
    krl_check_array(flow, array);
    check_indices(flow, count, flow->program->types[array].count);
}

void krl_check_view_row(struct flow *flow, int32_t place, int32_t count)
{
    check_indices(flow, count, krl_parameter(flow, place, KRL_BY_VIEW).cells - 1);
}

void krl_check_positions(struct flow *flow, int32_t left, int32_t right)
{
    const struct krl_type *types = flow->program->types;
    int32_t count = types[left].size < types[right].size ? types[left].size : types[right].size;
    /* No position has more than 64 cells. Only the types of the cells are compared, not the names
     * of the members. */
    if (types[left].form != KRL_STRUCTURE || types[right].form != KRL_STRUCTURE || count > 64) {
        krl_refuse_code(flow, "positions of the same family are required");
        return;
    }
    for (int32_t place = 0; place < count; place++)
        if (krl_kind_at(flow->program, left, place) != krl_kind_at(flow->program, right, place))
            krl_refuse_code(flow, "positions of the same family are required");
}

static void check_pose(struct flow *flow, int32_t type)
{
    for (int32_t place = 0; place < 6; place++)
        if (flow->program->types[type].size < 6 ||
            krl_kind_at(flow->program, type, place) != KRL_TYPE_REAL) {
            krl_refuse_code(flow, "Cartesian positions are required");
            return;
        }
}

void krl_check_poses(struct flow *flow, int32_t left, int32_t right)
{
    krl_check_positions(flow, left, right);
    check_pose(flow, left);
    check_pose(flow, right);
}

/* ---------------------------------------------------------------------------- loops */

static void check_counter(struct flow *flow, int32_t kind, int32_t limit, int32_t step)
{
    if (kind != KRL_TYPE_INT || krl_local_kind(flow, limit) != KRL_TYPE_INT || step == 0)
        krl_refuse_code(flow, "counter and limit must be INT, and the step must not be 0");
}

void krl_check_for_local(struct flow *flow, int32_t counter, int32_t limit, int32_t step)
{
    check_counter(flow, krl_local_kind(flow, counter), limit, step);
}

void krl_check_for_data(struct flow *flow, int32_t counter, int32_t limit, int32_t step)
{
    check_counter(flow, krl_data_kind(flow, counter), limit, step);
}
