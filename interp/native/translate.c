/* From instructions on a stack to steps on registers.
 *
 * A code object is walked through once, with a description of what lies on the stack: mostly in its
 * own place there, but a variable, a constant or an element of an array that was put on it stays
 * where it is until it is used, and the step that uses it takes it from there. The walk keeps the
 * order of all that can be noticed: what may still fault (a variable may have no value, an index may
 * be wrong) is settled, that is put in its place, before any step that faults in other ways, writes,
 * or leaves. Where ways meet everything is in its place.
 *
 * A LINE becomes no step: it is noted in the step that comes next.
 */
#include "translate.h"

#include <stdlib.h>

/* ---------------------------------------------------------------------------- computing */

void krl_unary(struct translator *at, enum krl_step_op op)
{
    krl_secure(at, at->height - 1);
    int32_t b = krl_operand(at, at->height - 1);
    at->height--;
    krl_emit(at, op)->b = b;
    krl_push_result(at);
}

/* `constant` is the step for a constant at the right, or KRL_STEP_COUNT. */
void krl_binary(struct translator *at, enum krl_step_op op, enum krl_step_op constant, int commutes)
{
    int32_t left = at->height - 2, right = at->height - 1;
    krl_secure(at, left);
    if (commutes && krl_is_constant(at, left) && !krl_is_constant(at, right)) {
        struct held swapped = at->stack[left];
        if (at->stack[right].kind == IN_PLACE) {
            /* what lies in the upper place is read from there */
            at->stack[left] = (struct held){VARIABLE, krl_place_of(at, right), 0, 0, 0, 0};
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
static const int opposite[] = {1, 0, 5, 4, 3, 2}; /* NE EQ GE LE GT LT */

/* A relation, by its place in EQ NE LT GT LE GE, from the step of EQ on; or a jump unless it holds. */
static struct krl_step *relate(struct translator *at, enum krl_step_op first, int relation)
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
    krl_settle_to(at, first < KRL_STEP_EQ_INT ? at->height : 0); /* a jump */
    struct krl_step *step = krl_emit(at, (enum krl_step_op)((int)first + 6 * has_constant + relation));
    step->b = b;
    step->c = c;
    return step;
}

static void relation(struct translator *at, enum krl_step_op first, int relation)
{
    relate(at, first, relation);
    krl_push_result(at);
}

static void division(struct translator *at)
{
    int32_t right = at->height - 1;
    int is_plain = krl_is_constant(at, right) && at->stack[right].a != 0 && at->stack[right].a != -1;
    krl_binary(at, KRL_STEP_DIV_INT, is_plain ? KRL_STEP_DIV_INT_K : KRL_STEP_COUNT, 0);
}

static void subtraction(struct translator *at)
{
    struct held *right = &at->stack[at->height - 1];
    if (right->kind == CONSTANT && right->a != INT32_MIN) {
        right->a = -right->a;
        krl_binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 0);
    } else
        krl_binary(at, KRL_STEP_SUB_INT, KRL_STEP_COUNT, 0);
}

/* Only where the divisor is no constant it has to be looked at. */
static void quotient(struct translator *at)
{
    const struct held *right = &at->stack[at->height - 1];
    int is_plain = right->kind == CONSTANT && (right->a & 0x7fffffff) != 0;
    krl_binary(at, KRL_STEP_DIV_REAL, is_plain ? KRL_STEP_DIV_REAL_K : KRL_STEP_COUNT, 0);
}

/* ---------------------------------------------------------------------------- control */

static struct krl_step *python(struct translator *at, enum krl_matter matter, int32_t place)
{
    krl_settle_all(at);
    struct krl_step *step = krl_emit(at, KRL_STEP_PYTHON);
    step->a = krl_place_of(at, at->height);
    step->b = place;
    step->tag = (uint16_t)matter;
    return step;
}

static void jump_on(struct translator *at, int is_if, int32_t target)
{
    int32_t top = at->height - 1;
    if (at->stack[top].kind == IN_PLACE && krl_is_fresh(at, top) && KRL_IS_RELATION(at->steps[at->result].op)) {
        struct krl_step relation = at->steps[at->result];
        int number = relation.op - KRL_STEP_EQ_INT, kind = number % 6;
        at->count--;
        at->height--;
        at->line = relation.statement;
        krl_settle_to(at, at->height);
        struct krl_step *step = krl_emit(
            at, (enum krl_step_op)(KRL_STEP_UNLESS_EQ_INT + number - kind + (is_if ? opposite[kind] : kind)));
        step->b = relation.b;
        step->c = relation.c;
        step->d = target;
        return;
    }
    int32_t b = krl_operand(at, top);
    at->height--;
    krl_settle_to(at, at->height);
    struct krl_step *step = krl_emit(at, is_if ? KRL_STEP_JUMP_IF : KRL_STEP_JUMP_UNLESS);
    step->b = b;
    step->d = target;
}

static void unless(struct translator *at, int is_real, int relation, int32_t target)
{
    relate(at, is_real ? KRL_STEP_UNLESS_EQ_REAL : KRL_STEP_UNLESS_EQ_INT, relation)->d = target;
}

static void call(struct translator *at, int32_t place)
{
    int32_t number = at->code->body[place].operands[0];
    const struct krl_code *callee = &at->program->codes[number];
    int32_t count = 0;
    int is_copied = 0;
    for (int32_t i = 0; i < callee->parameter_count; i++) {
        const struct krl_handed *handed = &callee->slots[i].handed;
        count += krl_stack_cells(handed);
        is_copied |= handed->mode == KRL_BY_VALUE && !krl_is_plain(at->program, handed->type);
    }
    krl_settle_all(at);
    if (at->machine->told & KRL_TOLD_CALL) {
        struct krl_step *check = krl_emit(at, KRL_STEP_CHECK_CALL);
        check->b = number;
        check->c = at->code->frame;
        python(at, KRL_MATTER_CALL, place);
    }
    struct krl_step *step = krl_consume(at, is_copied ? KRL_STEP_CALL_COPY : KRL_STEP_CALL, count);
    step->b = number;
    step->c = at->code->frame;
    step->d = at->code->frame + at->code->stack;
    krl_push_places(at, callee->result >= 0);
}

static void leave(struct translator *at, int32_t place)
{
    int has_value = at->code->body[place].op == KRL_RETURN_VALUE;
    int32_t b = 0;
    if (has_value)
        b = krl_operand(at, at->height - 1);
    if (at->machine->told & KRL_TOLD_RETURN && at->code->kind == KRL_ROUTINE)
        python(at, KRL_MATTER_LEAVE, place);
    at->height = 0;
    if (at->code->kind == KRL_ACTION)
        krl_emit(at, KRL_STEP_END_ACTION);
    else
        krl_emit(at, has_value ? KRL_STEP_RETURN_VALUE : KRL_STEP_RETURN)->b = b;
}

static void cross(struct translator *at, const struct krl_entry *entry, int32_t place)
{
    int is_large = entry->result >= 0 && !krl_is_plain(at->program, entry->result);
    python(at, KRL_MATTER_INSTRUCTION, place);
    at->height -= entry->input_cells + is_large;
    krl_push_places(at, entry->result >= 0 && !is_large);
}

static int all_reals(const struct krl_entry *entry)
{
    for (int32_t i = 0; i < entry->part_count; i++)
        if (entry->parts[i].kind != KRL_PART_INPUT ||
            entry->parts[i].handed.mode != KRL_BY_VALUE || entry->parts[i].handed.type != KRL_TYPE_REAL)
            return 0;
    return entry->result == KRL_TYPE_REAL;
}

/* INV_POS of a pose, into a pose. */
static int is_inversion(const struct translator *at, const struct krl_entry *entry)
{
    static const char name[] = "INV_POS";
    if (entry->name.length != sizeof name - 1 || memcmp(entry->name.bytes, name, sizeof name - 1) != 0 ||
        entry->part_count != 1 || entry->parts[0].kind != KRL_PART_INPUT ||
        entry->parts[0].handed.mode != KRL_BY_REFERENCE || entry->result < 0 ||
        at->program->types[entry->result].size < 6)
        return 0;
    for (int32_t place = 0; place < 6; place++)
        if (krl_kind_at(at->program, entry->result, place) != KRL_TYPE_REAL ||
            place >= at->program->types[entry->parts[0].handed.type].size ||
            krl_kind_at(at->program, entry->parts[0].handed.type, place) != KRL_TYPE_REAL)
            return 0;
    return 1;
}

static void builtin(struct translator *at, int32_t place)
{
    int32_t number = at->code->body[place].operands[0];
    const struct krl_entry *entry = &at->program->builtins[number];
    if (all_reals(entry)) {
        enum krl_function function = krl_function_of(entry->name, entry->part_count);
        if (function != KRL_FUNCTIONS) {
            if (entry->part_count == 2)
                krl_binary(at, KRL_STEP_FUNCTION, KRL_STEP_COUNT, 0);
            else
                krl_unary(at, KRL_STEP_FUNCTION);
            at->steps[at->count - 1].tag = (uint16_t)function;
            return;
        }
    }
    if (is_inversion(at, entry)) {
        struct krl_step *step = krl_consume(at, KRL_STEP_INVERT, 2);
        step->b = step->a + 1;
        step->c = at->program->types[entry->result].size;
        return;
    }
    enum krl_text_function function = krl_text_function_of(at->program, entry);
    if (function != KRL_TEXT_FUNCTIONS && !(at->machine->told & KRL_TOLD_ASSIGN)) {
        struct krl_step *step = krl_consume(at, KRL_STEP_TEXT, entry->input_cells);
        step->b = number;
        step->tag = (uint16_t)function;
        krl_push_places(at, 1);
        return;
    }
    cross(at, entry, place);
}

/* The program can be told to go on at any statement, where the stack is empty. */
static void start_here(struct translator *at, int32_t place)
{
    at->result = -1;
    at->routine->steps[place] = at->count;
}

static void line(struct translator *at, int32_t place)
{
    if (at->machine->told & KRL_TOLD_LINE) {
        start_here(at, place);
        python(at, KRL_MATTER_INSTRUCTION, place);
    } else {
        if (at->line >= 0)
            krl_emit(at, KRL_STEP_NOP);
        at->line = place;
        start_here(at, place);
    }
}

static void count_up(struct translator *at, const struct krl_instruction *instruction)
{
    const int32_t *operands = instruction->operands;
    int is_data = instruction->op == KRL_FOR_DATA, is_down = operands[2] < 0;
    krl_settle_all(at);
    struct krl_step *step = krl_emit(at, is_data ? (is_down ? KRL_STEP_FOR_DATA_DOWN : KRL_STEP_FOR_DATA_UP)
                                             : (is_down ? KRL_STEP_FOR_DOWN : KRL_STEP_FOR_UP));
    step->a = operands[0];
    step->b = operands[1];
    step->c = operands[2];
    step->d = operands[3];
}

/* ---------------------------------------------------------------------------- instructions */

static void instruction(struct translator *at, int32_t place)
{
    const struct krl_instruction *now = &at->code->body[place];
    const int32_t *operands = now->operands;
    const struct krl_type *types = at->program->types;
    struct krl_step *step;
    switch ((enum krl_opcode)now->op) {
    case KRL_LINE: line(at, place); break;
    case KRL_AT:
        krl_secure(at, at->height);
        krl_emit(at, KRL_STEP_AT)->b = place;
        break;
    case KRL_JUMP:
        krl_settle_all(at);
        krl_emit(at, KRL_STEP_JUMP)->d = operands[0];
        break;
    case KRL_JUMP_IF: jump_on(at, 1, operands[0]); break;
    case KRL_JUMP_UNLESS: jump_on(at, 0, operands[0]); break;
    case KRL_CASE:
        krl_settle_to(at, at->height - 1);
        if (krl_is_constant(at, at->height - 1))
            krl_settle(at, at->height - 1);
        step = krl_emit(at, KRL_STEP_CASE);
        step->b = at->stack[at->height - 1].kind == VARIABLE ? at->stack[at->height - 1].a
                                                             : krl_place_of(at, at->height - 1);
        step->c = operands[0];
        step->d = operands[1];
        break;
    case KRL_CALL: call(at, place); break;
    case KRL_RETURN: case KRL_RETURN_VALUE: leave(at, place); break;
    case KRL_ASK: cross(at, &at->program->asks[operands[0]], place); break;
    case KRL_BUILTIN: builtin(at, place); break;
    case KRL_PROCEED: case KRL_UNLINKED: python(at, KRL_MATTER_INSTRUCTION, place); break;
    case KRL_FAIL:
        krl_secure(at, at->height);
        krl_emit(at, KRL_STEP_FAIL)->b = operands[0];
        break;
    case KRL_PUSH_INT: case KRL_PUSH_CHAR: krl_push_constant(at, KRL_TAG_INT, operands[0]); break;
    case KRL_PUSH_REAL: krl_push_constant(at, KRL_TAG_REAL, operands[0]); break;
    case KRL_PUSH_BOOL: krl_push_constant(at, KRL_TAG_BOOL, operands[0]); break;
    case KRL_PUSH_ENUM: krl_push_constant(at, KRL_TAG_INT, operands[1]); break;
    case KRL_PUSH_NOTHING: krl_push_constant(at, KRL_TAG_NONE, 0); break;
    case KRL_PUSH_NO_VIEW:
        krl_push_constant(at, KRL_TAG_NONE, 0);
        for (int32_t i = 0; i < operands[1]; i++)
            krl_push_constant(at, KRL_TAG_INT, 0);
        break;
    case KRL_DROP: /* a variable without a value faults all the same */
        krl_secure(at, at->height);
        at->height--;
        break;
    case KRL_LOAD_LOCAL: case KRL_LOAD_REF:
        krl_push(at, (struct held){VARIABLE, operands[0], 0, 0, 0, 0});
        break;
    case KRL_LOAD_VIEW:
        for (int32_t i = 0; i <= krl_slot_at(at->code, operands[0])->handed.dimensions; i++)
            krl_push(at, (struct held){VARIABLE, operands[0] + i, 0, 0, 0, 0});
        break;
    case KRL_PASS_VIEW: /* what was left out has sizes */
        krl_emit(at, KRL_STEP_PASS)->b = operands[0];
        krl_push_result(at);
        for (int32_t i = 1; i <= krl_slot_at(at->code, operands[0])->handed.dimensions; i++)
            krl_push(at, (struct held){VARIABLE, operands[0] + i, 0, 0, 0, 0});
        break;
    case KRL_LOAD_DATA:
        krl_emit(at, KRL_STEP_GET_DATA)->b = operands[0];
        krl_push_result(at);
        break;
    case KRL_STORE_LOCAL: krl_store_local(at, operands[0]); break;
    case KRL_STORE_DATA: krl_store_data(at, operands[0]); break;
    case KRL_REF_LOCAL: krl_push(at, (struct held){ADDRESS, operands[0], 0, 0, 0, 0}); break;
    case KRL_REF_DATA: krl_push_constant(at, KRL_TAG_INT, operands[0]); break;
    case KRL_LOAD: krl_load(at); break;
    case KRL_STORE: krl_store(at); break;
    case KRL_MEMBER: krl_member(at, operands[0]); break;
    case KRL_INDEX: {
        int32_t number = krl_add_array(at, krl_array_of(at, 0, operands[0]));
        step = krl_consume(at, KRL_STEP_INDEX_ANY, types[operands[0]].count + 1);
        step->b = step->a + 1;
        step->c = number;
        krl_push_places(at, 1);
        break;
    }
    case KRL_INDEX_LOCAL: krl_element(at, 1, operands[0], operands[1]); break;
    case KRL_INDEX_DATA: krl_element(at, 0, operands[0], operands[1]); break;
    case KRL_ELEMENT_LOCAL: krl_element(at, 1, operands[0], operands[1]), krl_load(at); break;
    case KRL_ELEMENT_DATA: krl_element(at, 0, operands[0], operands[1]), krl_load(at); break;
    case KRL_INDEX_VIEW: krl_view_index(at, operands[0]); break;
    case KRL_VIEW: krl_view(at, &types[operands[0]]); break;
    case KRL_ROW: case KRL_ROW_VIEW: krl_row(at, now); break;
    case KRL_COPY:
        step = krl_consume(at, KRL_STEP_COPY, 2);
        step->b = step->a + 1;
        step->c = types[operands[0]].size;
        break;
    case KRL_CLEAR: krl_consume(at, KRL_STEP_CLEAR, 1)->c = types[operands[0]].size; break;
    case KRL_FILL_POSE: {
        int32_t to = types[operands[0]].size, of = types[operands[1]].size;
        step = krl_consume(at, KRL_STEP_FILL_POSE, 2);
        step->b = step->a + 1;
        step->c = to;
        step->d = to < of ? to : of;
        break;
    }
    case KRL_FILL_ARRAY:
        step = krl_consume(at, KRL_STEP_FILL_ARRAY, 2 + 2 * operands[1]);
        step->b = step->a + 1 + operands[1];
        step->c = types[operands[0]].size;
        step->d = operands[1];
        break;
    case KRL_COPY_VIEW: {
        const struct krl_type *room = &types[operands[1]];
        step = krl_consume(at, KRL_STEP_COPY_VIEW, 1 + room->count);
        step->b = operands[0];
        step->c = room->size;
        step->d = types[room->element].size;
        step->tag = (uint16_t)room->count;
        krl_push_places(at, 1 + room->count);
        break;
    }
    case KRL_SET_TEXT: krl_consume(at, KRL_STEP_SET_TEXT, 2)->b = operands[0]; break;
    case KRL_COMPOSE:
        step = krl_consume(at, KRL_STEP_COMPOSE, 3);
        step->b = step->a + 1;
        step->c = step->a + 2;
        step->d = types[operands[1]].size;
        break;
    case KRL_ADD_INT: krl_binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 1); break;
    case KRL_SUB_INT: subtraction(at); break;
    case KRL_MUL_INT: krl_binary(at, KRL_STEP_MUL_INT, KRL_STEP_MUL_INT_K, 1); break;
    case KRL_DIV_INT: division(at); break;
    case KRL_NEG_INT: krl_unary(at, KRL_STEP_NEG_INT); break;
    case KRL_ADD_REAL: krl_binary(at, KRL_STEP_ADD_REAL, KRL_STEP_ADD_REAL_K, 1); break;
    case KRL_SUB_REAL: krl_binary(at, KRL_STEP_SUB_REAL, KRL_STEP_SUB_REAL_K, 0); break;
    case KRL_MUL_REAL: krl_binary(at, KRL_STEP_MUL_REAL, KRL_STEP_MUL_REAL_K, 1); break;
    case KRL_DIV_REAL: quotient(at); break;
    case KRL_NEG_REAL: krl_unary(at, KRL_STEP_NEG_REAL); break;
    case KRL_EQ_INT: case KRL_NE_INT: case KRL_LT_INT: case KRL_GT_INT: case KRL_LE_INT: case KRL_GE_INT:
        relation(at, KRL_STEP_EQ_INT, (int)now->op - KRL_EQ_INT);
        break;
    case KRL_EQ_REAL: case KRL_NE_REAL: case KRL_LT_REAL: case KRL_GT_REAL: case KRL_LE_REAL: case KRL_GE_REAL:
        relation(at, KRL_STEP_EQ_REAL, (int)now->op - KRL_EQ_REAL);
        break;
    case KRL_EQ_BOOL: case KRL_EQ_ENUM: relation(at, KRL_STEP_EQ_INT, 0); break;
    case KRL_NE_BOOL: case KRL_NE_ENUM: relation(at, KRL_STEP_EQ_INT, 1); break;
    case KRL_NOT_BOOL: krl_unary(at, KRL_STEP_NOT_BOOL); break;
    case KRL_AND_BOOL: krl_binary(at, KRL_STEP_AND_BOOL, KRL_STEP_COUNT, 0); break;
    case KRL_OR_BOOL: krl_binary(at, KRL_STEP_OR_BOOL, KRL_STEP_COUNT, 0); break;
    case KRL_EXOR_BOOL: krl_binary(at, KRL_STEP_EXOR_BOOL, KRL_STEP_COUNT, 0); break;
    case KRL_NOT_BITS: krl_unary(at, KRL_STEP_NOT_BITS); break;
    case KRL_AND_BITS: krl_binary(at, KRL_STEP_AND_BITS, KRL_STEP_AND_BITS_K, 1); break;
    case KRL_OR_BITS: krl_binary(at, KRL_STEP_OR_BITS, KRL_STEP_COUNT, 0); break;
    case KRL_EXOR_BITS: krl_binary(at, KRL_STEP_EXOR_BITS, KRL_STEP_COUNT, 0); break;
    case KRL_INT_TO_REAL: krl_unary(at, KRL_STEP_INT_TO_REAL); break;
    case KRL_REAL_TO_INT: krl_unary(at, KRL_STEP_REAL_TO_INT); break;
    case KRL_CHAR_TO_INT: break; /* a cell holds the code */
    case KRL_INT_TO_CHAR: krl_unary(at, KRL_STEP_INT_TO_CHAR); break;
    case KRL_ADD_CONSTANT:
        krl_push_constant(at, KRL_TAG_INT, operands[0]);
        krl_binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 0);
        break;
    case KRL_UNLESS_EQ_INT: case KRL_UNLESS_NE_INT: case KRL_UNLESS_LT_INT:
    case KRL_UNLESS_GT_INT: case KRL_UNLESS_LE_INT: case KRL_UNLESS_GE_INT:
        unless(at, 0, (int)now->op - KRL_UNLESS_EQ_INT, operands[0]);
        break;
    case KRL_UNLESS_LT_REAL: case KRL_UNLESS_GT_REAL: case KRL_UNLESS_LE_REAL: case KRL_UNLESS_GE_REAL:
        unless(at, 1, 2 + (int)now->op - KRL_UNLESS_LT_REAL, operands[0]);
        break;
    case KRL_FOR_LOCAL: case KRL_FOR_DATA: count_up(at, now); break;
    case KRL_TELL_LOCAL: case KRL_TELL_DATA: case KRL_TELL_REF: case KRL_TELL:
        if (at->machine->told & KRL_TOLD_ASSIGN)
            python(at, KRL_MATTER_INSTRUCTION, place);
        break;
    case KRL_TELL_BRANCH:
        if (at->machine->told & KRL_TOLD_BRANCH)
            python(at, KRL_MATTER_INSTRUCTION, place);
        break;
    case KRL_OPCODE_COUNT: break;
    }
}

/* ---------------------------------------------------------------------------- code objects */

static void code(struct translator *at)
{
    const struct krl_code *code = at->code;
    struct krl_routine *routine = at->routine;
    int is_reached = 0;
    at->height = 0;
    at->line = at->result = -1;
    for (int32_t place = 0; place < code->length && !at->is_wrong; place++) {
        routine->steps[place] = -1;
        if (code->depths[place] < 0)
            continue;
        if (code->leads[place]) {
            if (is_reached) {
                krl_settle_all(at);
                if (at->line >= 0)
                    krl_emit(at, KRL_STEP_NOP);
            }
            at->height = 0;
            krl_push_places(at, code->depths[place]);
            at->line = at->result = -1;
            routine->steps[place] = at->count;
        }
        instruction(at, place);
        uint32_t op = code->body[place].op;
        is_reached = !(op == KRL_JUMP || op == KRL_RETURN || op == KRL_RETURN_VALUE || op == KRL_FAIL ||
                       op == KRL_UNLINKED);
    }
}

/* Targets become distances. */
static void land(struct krl_machine *machine)
{
    for (int32_t number = 0; number < machine->program.code_count; number++) {
        struct krl_routine *routine = &machine->routines[number];
        int32_t first = routine->steps[0];
        int32_t end = number + 1 < machine->program.code_count ? machine->routines[number + 1].steps[0]
                                                               : machine->step_count;
        routine->entry = &machine->steps[first];
        for (int32_t i = first; i < end; i++) {
            struct krl_step *step = &machine->steps[i];
            if (KRL_IS_JUMP(step->op))
                step->d = (routine->steps[step->d] - i) * (int32_t)sizeof *step;
        }
    }
}

int krl_translate(struct krl_machine *machine, struct krl_refusal *why)
{
    struct translator at = {0};
    struct krl_program *program = &machine->program;
    int32_t most = 0;
    for (int32_t number = 0; number < program->code_count; number++)
        most = program->codes[number].stack > most ? program->codes[number].stack : most;
    at.machine = machine;
    at.program = program;
    at.why = why;
    at.stack = krl_allot(program, (size_t)most + 8, sizeof *at.stack);
    at.capacity = 256;
    at.steps = malloc((size_t)at.capacity * sizeof *at.steps);
    at.array_capacity = 64;
    at.arrays = malloc((size_t)at.array_capacity * sizeof *at.arrays);
    machine->routines = krl_allot(program, (size_t)program->code_count, sizeof *machine->routines);
    machine->steps = at.steps;
    machine->arrays = at.arrays;
    if (at.stack == NULL || machine->routines == NULL || at.steps == NULL || at.arrays == NULL)
        return krl_refuse(why, "there is not enough memory for the program");
    for (int32_t number = 0; number < program->code_count; number++) {
        const struct krl_code *body = &program->codes[number];
        struct krl_routine *routine = &machine->routines[number];
        routine->code = body;
        routine->frame = body->frame;
        routine->whole = body->frame + body->stack;
        for (int32_t i = 0; i < body->parameter_count; i++) {
            routine->received += body->slots[i].cells;
            routine->arguments += krl_stack_cells(&body->slots[i].handed);
        }
        if (body->owner >= 0 && body->capture_count > 0)
            machine->routines[body->owner].is_owner = 1;
        routine->steps = krl_allot(program, (size_t)body->length, sizeof *routine->steps);
        if (routine->steps == NULL)
            return krl_refuse(why, "there is not enough memory for the program");
    }
    for (int32_t number = 0; number < program->code_count && !at.is_wrong; number++) {
        at.code = &program->codes[number];
        at.routine = &machine->routines[number];
        code(&at);
    }
    machine->steps = at.steps;
    machine->step_count = at.count;
    machine->arrays = at.arrays;
    if (at.is_wrong)
        return 0;
    land(machine);
    krl_thread(machine->steps, machine->step_count);
    return 1;
}
