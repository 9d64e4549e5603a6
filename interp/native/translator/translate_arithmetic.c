/* Translates arithmetic and comparisons. A constant becomes part of the step if there is a variant
 * of the step for that. */
#include "translate.h"

void krl_unary(struct translator *at, enum krl_step_op op)
{
    krl_secure(at, at->height - 1);
    int32_t b = krl_operand(at, at->height - 1);
    at->height--;
    krl_emit(at, op)->b = b;
    krl_push_result(at);
}

void krl_binary(struct translator *at, enum krl_step_op op, enum krl_step_op constant, int commutes)
{
    int32_t left = at->height - 2, right = at->height - 1;
    krl_secure(at, left);
    if (commutes && krl_is_constant(at, left) && !krl_is_constant(at, right)) {
        struct virtual_value swapped = at->stack[left];
        if (at->stack[right].kind == IN_PLACE) {
            /* the value stays in its place, the upper one */
            at->stack[left] = (struct virtual_value){VARIABLE, krl_place_of(at, right), 0, 0, 0, 0};
        } else
            at->stack[left] = at->stack[right];
        at->stack[right] = swapped;
    }
    int32_t b = krl_operand(at, left);
    int32_t c = 0;
    if (constant != KRL_STEP_COUNT && krl_is_constant(at, right)) {
        op = constant;
        c = at->stack[right].a;
    } else
        c = krl_operand(at, right);
    at->height -= 2;
    struct krl_step *step = krl_emit(at, op);
    step->b = b;
    step->c = c;
    krl_push_result(at);
}

static const int mirrored[] = {0, 1, 3, 2, 5, 4}; /* EQ NE GT LT GE LE */

struct krl_step *krl_relate(struct translator *at, enum krl_step_op first, int relation)
{
    int32_t left = at->height - 2, right = at->height - 1;
    krl_secure(at, left);
    int is_swapped = krl_is_constant(at, left) && !krl_is_constant(at, right);
    int32_t b = krl_operand(at, is_swapped ? right : left), c;
    if (is_swapped)
        relation = mirrored[relation];
    int32_t other = is_swapped ? left : right;
    int has_constant = krl_is_constant(at, other);
    c = has_constant ? at->stack[other].a : krl_operand(at, other);
    at->height -= 2;
    krl_settle_to(at, first < KRL_STEP_EQ_INT ? at->height : 0); /* all is in place before a jump */
    struct krl_step *step = krl_emit(at, (enum krl_step_op)((int)first + 6 * has_constant + relation));
    step->b = b;
    step->c = c;
    return step;
}

void krl_relation(struct translator *at, enum krl_step_op first, int relation)
{
    krl_relate(at, first, relation);
    krl_push_result(at);
}

void krl_division(struct translator *at)
{
    int32_t right = at->height - 1;
    int is_plain = krl_is_constant(at, right) && at->stack[right].a != 0 && at->stack[right].a != -1;
    krl_binary(at, KRL_STEP_DIV_INT, is_plain ? KRL_STEP_DIV_INT_K : KRL_STEP_COUNT, 0);
}

void krl_subtraction(struct translator *at)
{
    struct virtual_value *right = &at->stack[at->height - 1];
    if (right->kind == CONSTANT && right->a != INT32_MIN) {
        right->a = -right->a;
        krl_binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 0);
    } else
        krl_binary(at, KRL_STEP_SUB_INT, KRL_STEP_COUNT, 0);
}

void krl_quotient(struct translator *at)
{
    const struct virtual_value *right = &at->stack[at->height - 1];
    int is_plain = right->kind == CONSTANT && (right->a & 0x7fffffff) != 0;
    krl_binary(at, KRL_STEP_DIV_REAL, is_plain ? KRL_STEP_DIV_REAL_K : KRL_STEP_COUNT, 0);
}
