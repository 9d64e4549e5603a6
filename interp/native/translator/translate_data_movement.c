/* Translates data movement: variables, references, elements of arrays, rows and views. */
#include "translate.h"

void krl_load_data(struct translator *at, int32_t address)
{
    /* GET_DATA faults if the cell has no value, as a pending variable does: their order does not
     * matter. A pending element may fault because of its index, so it is settled first. */
    for (int32_t number = 0; number < at->height; number++)
        if (at->stack[number].kind == ELEMENT)
            krl_settle(at, number);
    krl_emit(at, KRL_STEP_GET_DATA)->b = address;
    krl_push_result(at);
}

/* Turns a step that computes the address of an element into the one that reads it. Returns 0 if
 * there is none. */
static int reaches_element(struct krl_step *step)
{
    switch (step->op) {
    case KRL_STEP_INDEX_TWO_LOCAL:
    case KRL_STEP_INDEX_TWO_DATA:
    case KRL_STEP_INDEX_THREE_LOCAL:
    case KRL_STEP_INDEX_THREE_DATA:
    case KRL_STEP_INDEX_VIEW:
    case KRL_STEP_INDEX_VIEW_TWO:
        step->op += KRL_GET_BEHIND_INDEX;
        return 1;
    default:
        return 0;
    }
}

void krl_load(struct translator *at)
{
    struct virtual_value *item = &at->stack[at->height - 1];
    switch (item->kind) {
    case ADDRESS:
        item->kind = VARIABLE;
        return;
    case CONSTANT:
        at->height--;
        krl_load_data(at, item->a);
        return;
    case ELEMENT: {
        struct virtual_value element = *item;
        krl_secure(at, --at->height);
        krl_reach(at, GET, &element, 0);
        krl_push_result(at);
        return;
    }
    default:
        if (!krl_is_fresh(at, at->height - 1) || !reaches_element(&at->steps[at->result]))
            krl_unary(at, KRL_STEP_LOAD);
        return;
    }
}

void krl_store_local(struct translator *at, int32_t place)
{
    int32_t top = at->height - 1;
    krl_secure(at, top);
    const struct virtual_value *item = &at->stack[top];
    if (item->kind == IN_PLACE && krl_is_fresh(at, top)) {
        at->steps[at->result].a = place;
    } else {
        struct virtual_value value = *item;
        struct krl_step *step;
        int32_t b = value.kind == CONSTANT ? value.a : krl_operand(at, top);
        step = krl_emit(at, value.kind == CONSTANT ? KRL_STEP_SET_K : KRL_STEP_MOVE);
        step->a = place;
        step->b = b;
        step->tag = value.tag;
    }
    at->height--;
    at->result = -1;
}

void krl_store_data(struct translator *at, int32_t address)
{
    int32_t top = at->height - 1;
    krl_secure(at, top);
    int has_constant = krl_is_constant(at, top);
    uint16_t tag = at->stack[top].tag;
    int32_t b = has_constant ? at->stack[top].a : krl_operand(at, top);
    struct krl_step *step = krl_emit(at, has_constant ? KRL_STEP_PUT_DATA_K : KRL_STEP_PUT_DATA);
    step->a = address;
    step->b = b;
    step->tag = tag;
    at->height--;
}

/* Stores the address of the assignment, for the trace. */
static void remember(struct translator *at, struct virtual_value where)
{
    if (at->machine->traced & KRL_TRACED_ASSIGN)
        krl_emit(at, where.kind == ADDRESS ? KRL_STEP_REMEMBER_LOCAL : KRL_STEP_REMEMBER_DATA)->a = where.a;
}

void krl_store(struct translator *at)
{
    int32_t target = at->height - 2, value = at->height - 1;
    struct virtual_value where = at->stack[target];
    krl_secure(at, target);
    if (where.kind == ADDRESS || where.kind == CONSTANT) {
        if (where.kind == ADDRESS)
            krl_store_local(at, where.a);
        else
            krl_store_data(at, where.a);
        at->height--;
        remember(at, where);
        return;
    }
    int has_constant = krl_is_constant(at, value);
    uint16_t tag = at->stack[value].tag;
    if (where.kind == ELEMENT) {
        const struct krl_array *array = &at->arrays[where.array];
        int is_short = has_constant && array->dimensions == 1 && array->width == 1;
        int32_t a = is_short ? at->stack[value].a : krl_operand(at, value);
        struct krl_step *step = krl_reach(at, PUT, &where, a);
        if (is_short) {
            step->op = where.is_local ? KRL_STEP_PUT_LOCAL_K : KRL_STEP_PUT_ELEMENT_DATA_K;
            step->tag = tag;
        }
    } else {
        int32_t a = krl_operand(at, target);
        int32_t b = has_constant ? at->stack[value].a : krl_operand(at, value);
        struct krl_step *step = krl_emit(at, has_constant ? KRL_STEP_STORE_K : KRL_STEP_STORE);
        step->a = a;
        step->b = b;
        step->tag = tag;
    }
    at->height -= 2;
}

void krl_member(struct translator *at, int32_t offset)
{
    struct virtual_value *item = &at->stack[at->height - 1];
    if (item->kind == ADDRESS || item->kind == CONSTANT)
        item->a += offset;
    else if (item->kind == ELEMENT) {
        struct krl_array array = at->arrays[item->array];
        array.base += offset;
        item->array = krl_add_array(at, array);
    } else if (offset != 0) {
        krl_unary(at, KRL_STEP_OFFSET);
        at->steps[at->count - 1].c = offset;
    }
}

/* Returns the offset of an element if all indices are valid constants, else -1. */
static int32_t known_place(const struct translator *at, const struct krl_array *array)
{
    int32_t place = 0;
    for (int32_t i = 0; i < array->dimensions; i++) {
        const struct virtual_value *index = &at->stack[at->height - array->dimensions + i];
        if (index->kind != CONSTANT || index->a < 1 || index->a > array->sizes[i])
            return -1;
        place = place * array->sizes[i] + index->a - 1;
    }
    return place * array->width;
}

void krl_element(struct translator *at, int is_local, int32_t base, int32_t type)
{
    struct krl_array array = krl_array_of(at, base, type);
    int32_t first = at->height - array.dimensions, known = known_place(at, &array);
    if (known >= 0) {
        at->height = first;
        if (is_local)
            krl_push(at, (struct virtual_value){ADDRESS, base + known, 0, 0, 0, 0});
        else
            krl_push_constant(at, KRL_TAG_INT, base + known);
        return;
    }
    struct virtual_value item = {ELEMENT, krl_operand(at, first), 0, 0, 0, (uint16_t)(is_local != 0)};
    if (array.dimensions > 1)
        item.b = krl_operand(at, first + 1);
    if (array.dimensions > 2)
        array.third = krl_operand(at, first + 2);
    item.array = krl_add_array(at, array);
    at->height = first;
    krl_push(at, item);
    /* A second or third index in a stack register is above the new top of the stack and would be
     * overwritten. The trace of assignments needs the address itself. */
    int is_above = item.b >= at->code->frame || array.third >= at->code->frame;
    if ((array.dimensions > 1 && is_above) || at->machine->traced & KRL_TRACED_ASSIGN) {
        krl_secure(at, first);
        krl_settle(at, first);
    }
}

void krl_view_index(struct translator *at, int32_t place)
{
    const struct krl_slot *slot = krl_slot_at(at->code, place);
    int32_t width = at->program->types[slot->passed.type].size, dimensions = slot->passed.dimensions;
    int32_t first = at->height - dimensions;
    struct krl_step *step;
    if (dimensions == 1 || (dimensions == 2 && width <= UINT16_MAX)) {
        krl_secure(at, first);
        int32_t b = krl_operand(at, first), d = dimensions == 2 ? krl_operand(at, first + 1) : width;
        step = krl_emit(at, dimensions == 2 ? KRL_STEP_INDEX_VIEW_TWO : KRL_STEP_INDEX_VIEW);
        step->b = b;
        step->c = place;
        step->d = d;
        step->tag = (uint16_t)width;
        at->height = first;
        krl_push_result(at);
        return;
    }
    krl_row_of_view(at, place, dimensions);
}

/* The dimensions without an index are a view; with all indices, it is the address of an element. */
void krl_row(struct translator *at, int32_t type, int32_t count)
{
    int32_t number = krl_add_array(at, krl_array_of(at, 0, type));
    struct krl_step *step = krl_consume(at, KRL_STEP_ROW, 1 + count);
    step->b = count;
    step->c = number;
    krl_push_places(at, 1 + at->program->types[type].count - count);
}

void krl_row_of_view(struct translator *at, int32_t place, int32_t count)
{
    const struct krl_passed *passed = &krl_slot_at(at->code, place)->passed;
    struct krl_step *step = krl_consume(at, KRL_STEP_ROW_VIEW, count);
    step->b = count;
    step->c = place;
    step->d = at->program->types[passed->type].size;
    step->tag = (uint16_t)passed->dimensions;
    krl_push_places(at, 1 + passed->dimensions - count);
}

void krl_view(struct translator *at, const struct krl_type *type)
{
    for (int32_t i = 0; i < type->count; i++)
        krl_push_constant(at, KRL_TAG_INT, type->sizes[i]);
}

struct krl_step *krl_consume(struct translator *at, enum krl_step_op op, int32_t count)
{
    krl_settle_all(at);
    at->height -= count;
    struct krl_step *step = krl_emit(at, op);
    step->a = krl_place_of(at, at->height);
    return step;
}
