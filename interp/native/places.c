/* What the operands of instructions name, for the verifier: variables, their parts, types. Whatever
 * is not there refuses the code object. */
#include "flow.h"

/* The variable that a cell of the frame belongs to, and the offset within it. */
static const struct krl_slot *variable(struct flow *flow, int32_t *place)
{
    const struct krl_slot *slot = krl_slot_at(flow->code, *place);
    if (slot == NULL || slot->handed.mode != KRL_BY_VALUE) {
        krl_refuse_code(flow, "there is no such variable in the frame");
        return NULL;
    }
    *place -= slot->offset;
    return slot;
}

int32_t krl_local_kind(struct flow *flow, int32_t place)
{
    const struct krl_slot *slot = variable(flow, &place);
    return slot == NULL ? KRL_TYPE_INT : krl_kind_at(flow->program, slot->handed.type, place);
}

int32_t krl_data_kind(struct flow *flow, int32_t address)
{
    const struct krl_variable *found = krl_data_at(flow->program, address);
    if (found == NULL) {
        krl_refuse_code(flow, "there is no such variable in the data lists");
        return KRL_TYPE_INT;
    }
    return krl_kind_at(flow->program, found->type, address - found->address);
}

void krl_check_local_part(struct flow *flow, int32_t place, int32_t type)
{
    const struct krl_slot *slot = variable(flow, &place);
    if (slot != NULL && !krl_has_part(flow->program, slot->handed.type, place, type))
        krl_refuse_code(flow, "no such part of a variable is there");
}

void krl_check_data_part(struct flow *flow, int32_t address, int32_t type)
{
    const struct krl_variable *found = krl_data_at(flow->program, address);
    if (found == NULL || !krl_has_part(flow->program, found->type, address - found->address, type))
        krl_refuse_code(flow, "no such part of a variable is there");
}

const struct krl_type *krl_array_named(struct flow *flow, int32_t number)
{
    const struct krl_type *type = &flow->program->types[number];
    if (type->form != KRL_ARRAY) {
        krl_refuse_code(flow, "an array is needed");
        return NULL;
    }
    return type;
}

int krl_is_rank(struct flow *flow, int32_t dimensions)
{
    if (dimensions >= 1 && dimensions <= KRL_MOST_DIMENSIONS)
        return 1;
    krl_refuse_code(flow, "arrays have 1 to 3 dimensions");
    return 0;
}

void krl_check_alike(struct flow *flow, int32_t left, int32_t right)
{
    const struct krl_type *types = flow->program->types;
    int32_t count = types[left].size < types[right].size ? types[left].size : types[right].size;
    /* No position has more cells; the names that tell positions apart are not looked at here. */
    if (types[left].form != KRL_STRUCTURE || types[right].form != KRL_STRUCTURE || count > 64) {
        krl_refuse_code(flow, "positions are needed");
        return;
    }
    for (int32_t place = 0; place < count; place++)
        if (krl_kind_at(flow->program, left, place) != krl_kind_at(flow->program, right, place))
            krl_refuse_code(flow, "positions of one family are needed");
}

void krl_check_pose(struct flow *flow, int32_t type)
{
    for (int32_t place = 0; place < 6; place++)
        if (flow->program->types[type].size < 6 ||
            krl_kind_at(flow->program, type, place) != KRL_TYPE_REAL) {
            krl_refuse_code(flow, "poses are needed");
            return;
        }
}
