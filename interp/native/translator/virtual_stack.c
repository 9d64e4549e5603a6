/* The virtual stack: what is on the stack while a code object is translated, and the steps that put
 * it in place. */
#include "translate.h"

#include <stdlib.h>

static struct krl_step spare; /* written to when there is no more memory */

struct krl_step *krl_emit(struct translator *at, enum krl_step_op op)
{
    if (at->count == at->capacity) {
        int32_t capacity = 2 * at->capacity + 256;
        struct krl_step *steps = capacity < INT32_MAX / (int32_t)sizeof *steps
                                     ? realloc(at->steps, (size_t)capacity * sizeof *steps)
                                     : NULL;
        if (steps == NULL) {
            at->is_wrong = 1;
            return &spare;
        }
        at->steps = steps;
        at->capacity = capacity;
    }
    struct krl_step *step = &at->steps[at->count++];
    memset(step, 0, sizeof *step);
    step->op = (uint16_t)op;
    step->statement = at->line;
    at->line = -1;
    at->result = -1;
    return step;
}

int32_t krl_place_of(const struct translator *at, int32_t number)
{
    return at->code->frame + number;
}

int32_t krl_add_array(struct translator *at, struct krl_array array)
{
    if (at->array_count == at->array_capacity) {
        int32_t capacity = 2 * at->array_capacity + 64;
        struct krl_array *arrays = realloc(at->arrays, (size_t)capacity * sizeof *arrays);
        if (arrays == NULL) {
            at->is_wrong = 1;
            return 0;
        }
        at->arrays = arrays;
        at->array_capacity = capacity;
    }
    at->arrays[at->array_count] = array;
    return at->array_count++;
}

struct krl_array krl_array_of(const struct translator *at, int32_t base, int32_t number)
{
    const struct krl_type *type = &at->program->types[number];
    struct krl_array array = {base, at->program->types[type->element].size, type->count, {1, 1, 1}, 0};
    for (int32_t i = 0; i < type->count; i++)
        array.sizes[i] = type->sizes[i];
    return array;
}

/* ---------------------------------------------------------------------------- elements */

struct krl_step *krl_reach(struct translator *at, enum access access, const struct virtual_value *element,
                           int32_t a)
{
    static const uint16_t steps[3][4][2] = {
        {{KRL_STEP_INDEX_DATA, KRL_STEP_INDEX_LOCAL},
         {KRL_STEP_INDEX_WIDE_DATA, KRL_STEP_INDEX_WIDE_LOCAL},
         {KRL_STEP_INDEX_TWO_DATA, KRL_STEP_INDEX_TWO_LOCAL},
         {KRL_STEP_INDEX_THREE_DATA, KRL_STEP_INDEX_THREE_LOCAL}},
        {{KRL_STEP_GET_ELEMENT_DATA, KRL_STEP_GET_LOCAL},
         {KRL_STEP_GET_WIDE_DATA, KRL_STEP_GET_WIDE_LOCAL},
         {KRL_STEP_GET_TWO_DATA, KRL_STEP_GET_TWO_LOCAL},
         {KRL_STEP_GET_THREE_DATA, KRL_STEP_GET_THREE_LOCAL}},
        {{KRL_STEP_PUT_ELEMENT_DATA, KRL_STEP_PUT_LOCAL},
         {KRL_STEP_PUT_WIDE_DATA, KRL_STEP_PUT_WIDE_LOCAL},
         {KRL_STEP_PUT_TWO_DATA, KRL_STEP_PUT_TWO_LOCAL},
         {KRL_STEP_PUT_THREE_DATA, KRL_STEP_PUT_THREE_LOCAL}},
    };
    const struct krl_array *array = &at->arrays[element->array];
    int form = array->dimensions > 1 ? array->dimensions : array->width > 1;
    struct krl_step *step = krl_emit(at, (enum krl_step_op)steps[access][form][element->is_local]);
    step->a = a;
    step->b = element->a;
    if (form == 0) {
        step->c = array->base;
        step->d = array->sizes[0];
    } else {
        step->c = element->array;
        step->d = element->b;
    }
    return step;
}

/* ---------------------------------------------------------------------------- settling */

void krl_settle(struct translator *at, int32_t number)
{
    struct virtual_value *item = &at->stack[number];
    struct krl_step *step;
    switch (item->kind) {
    case IN_PLACE:
        return;
    case VARIABLE:
        step = krl_emit(at, KRL_STEP_MOVE);
        step->b = item->a;
        step->a = krl_place_of(at, number);
        break;
    case CONSTANT:
        step = krl_emit(at, KRL_STEP_SET_K);
        step->b = item->a;
        step->tag = item->tag;
        step->a = krl_place_of(at, number);
        break;
    case ADDRESS:
        step = krl_emit(at, KRL_STEP_REFER);
        step->b = item->a;
        step->a = krl_place_of(at, number);
        break;
    case ELEMENT:
        krl_reach(at, INDEX, item, krl_place_of(at, number));
        break;
    }
    item->kind = IN_PLACE;
    at->result = number == at->height - 1 ? at->count - 1 : -1;
}

void krl_settle_to(struct translator *at, int32_t height)
{
    for (int32_t number = 0; number < height; number++)
        krl_settle(at, number);
}

void krl_secure(struct translator *at, int32_t height)
{
    for (int32_t number = 0; number < height; number++)
        if (at->stack[number].kind == VARIABLE || at->stack[number].kind == ELEMENT)
            krl_settle(at, number);
}

int krl_is_constant(const struct translator *at, int32_t number)
{
    return at->stack[number].kind == CONSTANT;
}

int32_t krl_operand(struct translator *at, int32_t number)
{
    if (at->stack[number].kind == VARIABLE)
        return at->stack[number].a;
    krl_settle(at, number);
    return krl_place_of(at, number);
}

void krl_push(struct translator *at, struct virtual_value item)
{
    at->stack[at->height++] = item;
}

void krl_push_constant(struct translator *at, enum krl_tag tag, int32_t bits)
{
    krl_push(at, (struct virtual_value){CONSTANT, bits, 0, 0, (uint16_t)tag, 0});
}

void krl_push_places(struct translator *at, int32_t count)
{
    while (count-- > 0)
        krl_push(at, (struct virtual_value){IN_PLACE, 0, 0, 0, 0, 0});
}

void krl_push_result(struct translator *at)
{
    if (!at->is_wrong)
        at->steps[at->count - 1].a = krl_place_of(at, at->height);
    krl_push_places(at, 1);
    at->result = at->count - 1;
}

int krl_is_fresh(const struct translator *at, int32_t number)
{
    return at->result >= 0 && at->result == at->count - 1 && at->steps[at->result].a == krl_place_of(at, number);
}

void krl_settle_all(struct translator *at)
{
    krl_settle_to(at, at->height);
}
