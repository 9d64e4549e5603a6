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
#include "machine.h"
#include "steps.h"

#include <stdlib.h>

enum held_kind {
    IN_PLACE,
    VARIABLE, /* of the frame: `a` is its register; it may have no value */
    CONSTANT, /* `a` bits, `tag` */
    ADDRESS,  /* of a register: `a` */
    ELEMENT   /* the address of an element: indices in the registers `a` and `b`, array `array` */
};

struct held {
    enum held_kind kind;
    int32_t a, b;
    int32_t array;
    uint16_t tag;
    uint16_t is_local; /* an element of the frame, not of the data lists */
};

struct translator {
    struct krl_machine *machine;
    const struct krl_program *program;
    const struct krl_code *code;
    struct krl_routine *routine;
    struct krl_refusal *why;
    struct krl_step *steps;
    int32_t count;
    int32_t capacity;
    struct krl_array *arrays;
    int32_t array_count;
    int32_t array_capacity;
    struct held *stack;
    int32_t height;
    int32_t line;      /* the place of a LINE that no step has noted yet, -1 for none */
    int32_t result;    /* the step that put what is on top there, if the one behind has not begun */
    int is_wrong;
};

static struct krl_step spare; /* takes what is written when there is no memory */

static struct krl_step *emit(struct translator *at, enum krl_step_op op)
{
    if (at->count == at->capacity) {
        int32_t capacity = 2 * at->capacity + 256;
        struct krl_step *steps = capacity < INT32_MAX / (int32_t)sizeof *steps
                                     ? realloc(at->steps, (size_t)capacity * sizeof *steps)
                                     : NULL;
        if (steps == NULL) {
            krl_refuse(at->why, "there is not enough memory for the program");
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

static int32_t place_of(const struct translator *at, int32_t number)
{
    return at->code->frame + number;
}

static int32_t add_array(struct translator *at, struct krl_array array)
{
    if (at->array_count == at->array_capacity) {
        int32_t capacity = 2 * at->array_capacity + 64;
        struct krl_array *arrays = realloc(at->arrays, (size_t)capacity * sizeof *arrays);
        if (arrays == NULL) {
            krl_refuse(at->why, "there is not enough memory for the program");
            at->is_wrong = 1;
            return 0;
        }
        at->arrays = arrays;
        at->array_capacity = capacity;
    }
    at->arrays[at->array_count] = array;
    return at->array_count++;
}

static struct krl_array array_of(const struct translator *at, int32_t base, int32_t number)
{
    const struct krl_type *type = &at->program->types[number];
    struct krl_array array = {base, at->program->types[type->element].size, type->count, {1, 1, 1}};
    for (int32_t i = 0; i < type->count; i++)
        array.sizes[i] = type->sizes[i];
    return array;
}

/* ---------------------------------------------------------------------------- elements */

enum access { INDEX, GET, PUT };

/* The step that reaches an element; `a` is the register that gets or has the value or address. */
static struct krl_step *reach(struct translator *at, enum access access, const struct held *element,
                              int32_t a)
{
    static const uint16_t steps[3][3][2] = {
        {{KRL_STEP_INDEX_DATA, KRL_STEP_INDEX_LOCAL},
         {KRL_STEP_INDEX_WIDE_DATA, KRL_STEP_INDEX_WIDE_LOCAL},
         {KRL_STEP_INDEX_TWO_DATA, KRL_STEP_INDEX_TWO_LOCAL}},
        {{KRL_STEP_GET_ELEMENT_DATA, KRL_STEP_GET_LOCAL},
         {KRL_STEP_GET_WIDE_DATA, KRL_STEP_GET_WIDE_LOCAL},
         {KRL_STEP_GET_TWO_DATA, KRL_STEP_GET_TWO_LOCAL}},
        {{KRL_STEP_PUT_ELEMENT_DATA, KRL_STEP_PUT_LOCAL},
         {KRL_STEP_PUT_WIDE_DATA, KRL_STEP_PUT_WIDE_LOCAL},
         {KRL_STEP_PUT_TWO_DATA, KRL_STEP_PUT_TWO_LOCAL}},
    };
    const struct krl_array *array = &at->arrays[element->array];
    int form = array->dimensions == 2 ? 2 : array->width > 1;
    struct krl_step *step = emit(at, (enum krl_step_op)steps[access][form][element->is_local]);
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

/* Puts what lies there into its place. */
static void settle(struct translator *at, int32_t number)
{
    struct held *held = &at->stack[number];
    struct krl_step *step;
    switch (held->kind) {
    case IN_PLACE:
        return;
    case VARIABLE:
        step = emit(at, KRL_STEP_MOVE);
        step->b = held->a;
        step->a = place_of(at, number);
        break;
    case CONSTANT:
        step = emit(at, KRL_STEP_SET_K);
        step->b = held->a;
        step->tag = held->tag;
        step->a = place_of(at, number);
        break;
    case ADDRESS:
        step = emit(at, KRL_STEP_REFER);
        step->b = held->a;
        step->a = place_of(at, number);
        break;
    case ELEMENT:
        reach(at, INDEX, held, place_of(at, number));
        break;
    }
    held->kind = IN_PLACE;
    at->result = number == at->height - 1 ? at->count - 1 : -1;
}

static void settle_to(struct translator *at, int32_t height)
{
    for (int32_t number = 0; number < height; number++)
        settle(at, number);
}

/* Puts what can fault into its place, up to a height. */
static void secure(struct translator *at, int32_t height)
{
    for (int32_t number = 0; number < height; number++)
        if (at->stack[number].kind == VARIABLE || at->stack[number].kind == ELEMENT)
            settle(at, number);
}

static int is_constant(const struct translator *at, int32_t number)
{
    return at->stack[number].kind == CONSTANT;
}

/* The register that has what lies there. */
static int32_t operand(struct translator *at, int32_t number)
{
    if (at->stack[number].kind == VARIABLE)
        return at->stack[number].a;
    settle(at, number);
    return place_of(at, number);
}

static void push(struct translator *at, struct held held)
{
    at->stack[at->height++] = held;
}

static void push_constant(struct translator *at, enum krl_tag tag, int32_t bits)
{
    push(at, (struct held){CONSTANT, bits, 0, 0, (uint16_t)tag, 0});
}

static void push_places(struct translator *at, int32_t count)
{
    while (count-- > 0)
        push(at, (struct held){IN_PLACE, 0, 0, 0, 0, 0});
}

/* The last step gives the value of the place that is put on the stack now. */
static void push_result(struct translator *at)
{
    if (!at->is_wrong)
        at->steps[at->count - 1].a = place_of(at, at->height);
    push_places(at, 1);
    at->result = at->count - 1;
}

/* ---------------------------------------------------------------------------- computing */

static void unary(struct translator *at, enum krl_step_op op)
{
    secure(at, at->height - 1);
    int32_t b = operand(at, at->height - 1);
    at->height--;
    emit(at, op)->b = b;
    push_result(at);
}

/* `constant` is the step for a constant at the right, or KRL_STEP_COUNT. */
static void binary(struct translator *at, enum krl_step_op op, enum krl_step_op constant, int commutes)
{
    int32_t left = at->height - 2, right = at->height - 1;
    secure(at, left);
    if (commutes && is_constant(at, left) && !is_constant(at, right)) {
        struct held swapped = at->stack[left];
        if (at->stack[right].kind == IN_PLACE) {
            /* what lies in the upper place is read from there */
            at->stack[left] = (struct held){VARIABLE, place_of(at, right), 0, 0, 0, 0};
        } else
            at->stack[left] = at->stack[right];
        at->stack[right] = swapped;
    }
    int32_t b = operand(at, left);
    int32_t c = 0;
    if (constant != KRL_STEP_COUNT && is_constant(at, right)) {
        op = constant;
        c = at->stack[right].a;
    } else
        c = operand(at, right);
    at->height -= 2;
    struct krl_step *step = emit(at, op);
    step->b = b;
    step->c = c;
    push_result(at);
}

static const int mirrored[] = {0, 1, 3, 2, 5, 4}; /* EQ NE GT LT GE LE */
static const int opposite[] = {1, 0, 5, 4, 3, 2}; /* NE EQ GE LE GT LT */

/* A relation, by its place in EQ NE LT GT LE GE, from the step of EQ on; or a jump unless it holds. */
static struct krl_step *relate(struct translator *at, enum krl_step_op first, int relation)
{
    int32_t left = at->height - 2, right = at->height - 1;
    secure(at, left);
    int is_swapped = is_constant(at, left) && !is_constant(at, right);
    int32_t b = operand(at, is_swapped ? right : left), c;
    if (is_swapped)
        relation = mirrored[relation];
    int32_t other = is_swapped ? left : right;
    int has_constant = is_constant(at, other);
    c = has_constant ? at->stack[other].a : operand(at, other);
    at->height -= 2;
    settle_to(at, first < KRL_STEP_EQ_INT ? at->height : 0); /* a jump */
    struct krl_step *step = emit(at, (enum krl_step_op)((int)first + 6 * has_constant + relation));
    step->b = b;
    step->c = c;
    return step;
}

static void relation(struct translator *at, enum krl_step_op first, int relation)
{
    relate(at, first, relation);
    push_result(at);
}

static void division(struct translator *at)
{
    int32_t right = at->height - 1;
    int is_plain = is_constant(at, right) && at->stack[right].a != 0 && at->stack[right].a != -1;
    binary(at, KRL_STEP_DIV_INT, is_plain ? KRL_STEP_DIV_INT_K : KRL_STEP_COUNT, 0);
}

static void subtraction(struct translator *at)
{
    struct held *right = &at->stack[at->height - 1];
    if (right->kind == CONSTANT && right->a != INT32_MIN) {
        right->a = -right->a;
        binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 0);
    } else
        binary(at, KRL_STEP_SUB_INT, KRL_STEP_COUNT, 0);
}

/* Only where the divisor is no constant it has to be looked at. */
static void quotient(struct translator *at)
{
    const struct held *right = &at->stack[at->height - 1];
    int is_plain = right->kind == CONSTANT && (right->a & 0x7fffffff) != 0;
    binary(at, KRL_STEP_DIV_REAL, is_plain ? KRL_STEP_DIV_REAL_K : KRL_STEP_COUNT, 0);
}

/* ---------------------------------------------------------------------------- moving */

static void load(struct translator *at)
{
    struct held *held = &at->stack[at->height - 1];
    switch (held->kind) {
    case ADDRESS:
        held->kind = VARIABLE;
        return;
    case CONSTANT: {
        int32_t address = held->a;
        at->height--;
        emit(at, KRL_STEP_GET_DATA)->b = address;
        break;
    }
    case ELEMENT: {
        struct held element = *held;
        secure(at, --at->height);
        reach(at, GET, &element, 0);
        break;
    }
    default:
        unary(at, KRL_STEP_LOAD);
        return;
    }
    push_result(at);
}

/* Whether the last step has put there what lies there. */
static int is_fresh(const struct translator *at, int32_t number)
{
    return at->result >= 0 && at->result == at->count - 1 && at->steps[at->result].a == place_of(at, number);
}

/* The value on top goes into a register. */
static void store_local(struct translator *at, int32_t place)
{
    int32_t top = at->height - 1;
    secure(at, top);
    const struct held *held = &at->stack[top];
    if (held->kind == IN_PLACE && is_fresh(at, top)) {
        at->steps[at->result].a = place;
    } else {
        struct held value = *held;
        struct krl_step *step;
        int32_t b = value.kind == CONSTANT ? value.a : operand(at, top);
        step = emit(at, value.kind == CONSTANT ? KRL_STEP_SET_K : KRL_STEP_MOVE);
        step->a = place;
        step->b = b;
        step->tag = value.tag;
    }
    at->height--;
    at->result = -1;
}

static void store_data(struct translator *at, int32_t address)
{
    int32_t top = at->height - 1;
    secure(at, top);
    int has_constant = is_constant(at, top);
    uint16_t tag = at->stack[top].tag;
    int32_t b = has_constant ? at->stack[top].a : operand(at, top);
    struct krl_step *step = emit(at, has_constant ? KRL_STEP_PUT_DATA_K : KRL_STEP_PUT_DATA);
    step->a = address;
    step->b = b;
    step->tag = tag;
    at->height--;
}

/* For the trace: what was written last. */
static void remember(struct translator *at, struct held where)
{
    if (at->machine->is_told)
        emit(at, where.kind == ADDRESS ? KRL_STEP_REMEMBER_LOCAL : KRL_STEP_REMEMBER_DATA)->a = where.a;
}

static void store(struct translator *at)
{
    int32_t target = at->height - 2, value = at->height - 1;
    struct held where = at->stack[target];
    secure(at, target);
    if (where.kind == ADDRESS || where.kind == CONSTANT) {
        if (where.kind == ADDRESS)
            store_local(at, where.a);
        else
            store_data(at, where.a);
        at->height--;
        remember(at, where);
        return;
    }
    int has_constant = is_constant(at, value);
    uint16_t tag = at->stack[value].tag;
    if (where.kind == ELEMENT) {
        const struct krl_array *array = &at->arrays[where.array];
        int is_short = has_constant && array->dimensions == 1 && array->width == 1;
        int32_t a = is_short ? at->stack[value].a : operand(at, value);
        struct krl_step *step = reach(at, PUT, &where, a);
        if (is_short) {
            step->op = where.is_local ? KRL_STEP_PUT_LOCAL_K : KRL_STEP_PUT_ELEMENT_DATA_K;
            step->tag = tag;
        }
    } else {
        int32_t a = operand(at, target);
        int32_t b = has_constant ? at->stack[value].a : operand(at, value);
        struct krl_step *step = emit(at, has_constant ? KRL_STEP_STORE_K : KRL_STEP_STORE);
        step->a = a;
        step->b = b;
        step->tag = tag;
    }
    at->height -= 2;
}

static void member(struct translator *at, int32_t offset)
{
    struct held *held = &at->stack[at->height - 1];
    if (held->kind == ADDRESS || held->kind == CONSTANT)
        held->a += offset;
    else if (held->kind == ELEMENT) {
        struct krl_array array = at->arrays[held->array];
        array.base += offset;
        held->array = add_array(at, array);
    } else if (offset != 0) {
        unary(at, KRL_STEP_OFFSET);
        at->steps[at->count - 1].c = offset;
    }
}

/* The place of an element in its array where all indices are constants and right; else -1. */
static int32_t known_place(const struct translator *at, const struct krl_array *array)
{
    int32_t place = 0;
    for (int32_t i = 0; i < array->dimensions; i++) {
        const struct held *index = &at->stack[at->height - array->dimensions + i];
        if (index->kind != CONSTANT || index->a < 1 || index->a > array->sizes[i])
            return -1;
        place = place * array->sizes[i] + index->a - 1;
    }
    return place * array->width;
}

/* An element of an array in the frame or the data lists. */
static void element(struct translator *at, int is_local, int32_t base, int32_t type)
{
    struct krl_array array = array_of(at, base, type);
    int32_t first = at->height - array.dimensions, known = known_place(at, &array);
    if (known >= 0) {
        at->height = first;
        if (is_local)
            push(at, (struct held){ADDRESS, base + known, 0, 0, 0, 0});
        else
            push_constant(at, KRL_TAG_INT, base + known);
        return;
    }
    int32_t number = add_array(at, array);
    if (array.dimensions > 2) {
        secure(at, first);
        for (int32_t i = first; i < at->height; i++)
            settle(at, i);
        struct krl_step *step = emit(at, KRL_STEP_INDEX_ANY);
        step->a = step->b = place_of(at, first);
        step->c = number;
        step->tag = is_local ? 1 : 2;
        at->height = first;
        push_places(at, 1);
        return;
    }
    struct held held = {ELEMENT, operand(at, first), 0, number, 0, (uint16_t)(is_local != 0)};
    if (array.dimensions == 2)
        held.b = operand(at, first + 1);
    at->height = first;
    push(at, held);
    /* An index in a place that is no longer the stack's would not stay; the trace needs addresses. */
    if ((array.dimensions == 2 && held.b >= at->code->frame) || at->machine->is_told) {
        secure(at, first);
        settle(at, first);
    }
}

/* What is below is settled, then the places from there up to the top. */
static void settle_all(struct translator *at)
{
    settle_to(at, at->height);
}

static void view_index(struct translator *at, int32_t place)
{
    const struct krl_slot *slot = krl_slot_at(at->code, place);
    int32_t width = at->program->types[slot->handed.type].size, dimensions = slot->handed.dimensions;
    struct krl_step *step;
    if (dimensions == 1) {
        secure(at, at->height - 1);
        int32_t b = operand(at, --at->height);
        step = emit(at, KRL_STEP_INDEX_VIEW);
        step->b = b;
        step->c = place;
        step->d = width;
        push_result(at);
        return;
    }
    settle_all(at);
    at->height -= dimensions;
    step = emit(at, KRL_STEP_INDEX_VIEW_ANY);
    step->a = place_of(at, at->height);
    step->c = place;
    step->d = width;
    step->tag = (uint16_t)dimensions;
    push_places(at, 1);
}

static void row(struct translator *at, const struct krl_instruction *instruction)
{
    const int32_t *operands = instruction->operands;
    int32_t count = operands[1], dimensions, width = 0, number = 0, tag = 0;
    settle_all(at);
    at->height -= count;
    if (instruction->op == KRL_ROW) {
        number = add_array(at, array_of(at, 0, operands[0]));
        dimensions = at->program->types[operands[0]].count;
        at->height--; /* the address of the array */
    } else {
        const struct krl_slot *slot = krl_slot_at(at->code, operands[0]);
        dimensions = slot->handed.dimensions;
        width = at->program->types[slot->handed.type].size;
        number = operands[0];
        tag = dimensions;
    }
    struct krl_step *step = emit(at, instruction->op == KRL_ROW ? KRL_STEP_ROW : KRL_STEP_ROW_VIEW);
    step->a = place_of(at, at->height);
    step->b = count;
    step->c = number;
    step->d = width;
    step->tag = (uint16_t)tag;
    push_places(at, 1 + dimensions - count);
}

static void view(struct translator *at, const struct krl_type *type)
{
    for (int32_t i = 0; i < type->count; i++)
        push_constant(at, KRL_TAG_INT, type->sizes[i]);
}

/* A step that takes so many places of the stack, all in place. */
static struct krl_step *consume(struct translator *at, enum krl_step_op op, int32_t count)
{
    settle_all(at);
    at->height -= count;
    struct krl_step *step = emit(at, op);
    step->a = place_of(at, at->height);
    return step;
}

/* ---------------------------------------------------------------------------- control */

static struct krl_step *python(struct translator *at, enum krl_matter matter, int32_t place)
{
    settle_all(at);
    struct krl_step *step = emit(at, KRL_STEP_PYTHON);
    step->a = place_of(at, at->height);
    step->b = place;
    step->tag = (uint16_t)matter;
    return step;
}

static void jump_on(struct translator *at, int is_if, int32_t target)
{
    int32_t top = at->height - 1;
    if (at->stack[top].kind == IN_PLACE && is_fresh(at, top) && KRL_IS_RELATION(at->steps[at->result].op)) {
        struct krl_step relation = at->steps[at->result];
        int number = relation.op - KRL_STEP_EQ_INT, kind = number % 6;
        at->count--;
        at->height--;
        at->line = relation.statement;
        settle_to(at, at->height);
        struct krl_step *step = emit(
            at, (enum krl_step_op)(KRL_STEP_UNLESS_EQ_INT + number - kind + (is_if ? opposite[kind] : kind)));
        step->b = relation.b;
        step->c = relation.c;
        step->d = target;
        return;
    }
    int32_t b = operand(at, top);
    at->height--;
    settle_to(at, at->height);
    struct krl_step *step = emit(at, is_if ? KRL_STEP_JUMP_IF : KRL_STEP_JUMP_UNLESS);
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
    settle_all(at);
    if (at->machine->is_told) {
        struct krl_step *check = emit(at, KRL_STEP_CHECK_CALL);
        check->b = number;
        check->c = at->code->frame;
        python(at, KRL_MATTER_CALL, place);
    }
    struct krl_step *step = consume(at, is_copied ? KRL_STEP_CALL_COPY : KRL_STEP_CALL, count);
    step->b = number;
    step->c = at->code->frame;
    step->d = at->code->frame + at->code->stack;
    push_places(at, callee->result >= 0);
}

static void leave(struct translator *at, int32_t place)
{
    int has_value = at->code->body[place].op == KRL_RETURN_VALUE;
    int32_t b = 0;
    if (has_value)
        b = operand(at, at->height - 1);
    if (at->machine->is_told && at->code->kind == KRL_ROUTINE)
        python(at, KRL_MATTER_LEAVE, place);
    at->height = 0;
    if (at->code->kind == KRL_ACTION)
        emit(at, KRL_STEP_END_ACTION);
    else
        emit(at, has_value ? KRL_STEP_RETURN_VALUE : KRL_STEP_RETURN)->b = b;
}

static void cross(struct translator *at, const struct krl_entry *entry, int32_t place)
{
    int is_large = entry->result >= 0 && !krl_is_plain(at->program, entry->result);
    python(at, KRL_MATTER_INSTRUCTION, place);
    at->height -= entry->input_cells + is_large;
    push_places(at, entry->result >= 0 && !is_large);
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
                binary(at, KRL_STEP_FUNCTION, KRL_STEP_COUNT, 0);
            else
                unary(at, KRL_STEP_FUNCTION);
            at->steps[at->count - 1].tag = (uint16_t)function;
            return;
        }
    }
    if (is_inversion(at, entry)) {
        struct krl_step *step = consume(at, KRL_STEP_INVERT, 2);
        step->b = step->a + 1;
        step->c = at->program->types[entry->result].size;
        return;
    }
    enum krl_text_function function = krl_text_function_of(at->program, entry);
    if (function != KRL_TEXT_FUNCTIONS && !at->machine->is_told) {
        struct krl_step *step = consume(at, KRL_STEP_TEXT, entry->input_cells);
        step->b = number;
        step->tag = (uint16_t)function;
        push_places(at, 1);
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
    if (at->machine->is_told) {
        start_here(at, place);
        python(at, KRL_MATTER_INSTRUCTION, place);
    } else {
        if (at->line >= 0)
            emit(at, KRL_STEP_NOP);
        at->line = place;
        start_here(at, place);
    }
}

static void count_up(struct translator *at, const struct krl_instruction *instruction)
{
    const int32_t *operands = instruction->operands;
    int is_data = instruction->op == KRL_FOR_DATA, is_down = operands[2] < 0;
    settle_all(at);
    struct krl_step *step = emit(at, is_data ? (is_down ? KRL_STEP_FOR_DATA_DOWN : KRL_STEP_FOR_DATA_UP)
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
        secure(at, at->height);
        emit(at, KRL_STEP_AT)->b = place;
        break;
    case KRL_JUMP:
        settle_all(at);
        emit(at, KRL_STEP_JUMP)->d = operands[0];
        break;
    case KRL_JUMP_IF: jump_on(at, 1, operands[0]); break;
    case KRL_JUMP_UNLESS: jump_on(at, 0, operands[0]); break;
    case KRL_CASE:
        settle_to(at, at->height - 1);
        if (is_constant(at, at->height - 1))
            settle(at, at->height - 1);
        step = emit(at, KRL_STEP_CASE);
        step->b = at->stack[at->height - 1].kind == VARIABLE ? at->stack[at->height - 1].a
                                                             : place_of(at, at->height - 1);
        step->c = operands[0];
        step->d = operands[1];
        break;
    case KRL_CALL: call(at, place); break;
    case KRL_RETURN: case KRL_RETURN_VALUE: leave(at, place); break;
    case KRL_ASK: cross(at, &at->program->asks[operands[0]], place); break;
    case KRL_BUILTIN: builtin(at, place); break;
    case KRL_PROCEED: case KRL_UNLINKED: python(at, KRL_MATTER_INSTRUCTION, place); break;
    case KRL_FAIL:
        secure(at, at->height);
        emit(at, KRL_STEP_FAIL)->b = operands[0];
        break;
    case KRL_PUSH_INT: case KRL_PUSH_CHAR: push_constant(at, KRL_TAG_INT, operands[0]); break;
    case KRL_PUSH_REAL: push_constant(at, KRL_TAG_REAL, operands[0]); break;
    case KRL_PUSH_BOOL: push_constant(at, KRL_TAG_BOOL, operands[0]); break;
    case KRL_PUSH_ENUM: push_constant(at, KRL_TAG_INT, operands[1]); break;
    case KRL_PUSH_NOTHING: push_constant(at, KRL_TAG_NONE, 0); break;
    case KRL_PUSH_NO_VIEW:
        for (int32_t i = 0; i <= operands[1]; i++)
            push_constant(at, KRL_TAG_NONE, 0);
        break;
    case KRL_DROP: /* a variable without a value faults all the same */
        secure(at, at->height);
        at->height--;
        break;
    case KRL_LOAD_LOCAL: case KRL_LOAD_REF:
        push(at, (struct held){VARIABLE, operands[0], 0, 0, 0, 0});
        break;
    case KRL_LOAD_VIEW:
        for (int32_t i = 0; i <= krl_slot_at(at->code, operands[0])->handed.dimensions; i++)
            push(at, (struct held){VARIABLE, operands[0] + i, 0, 0, 0, 0});
        break;
    case KRL_LOAD_DATA:
        emit(at, KRL_STEP_GET_DATA)->b = operands[0];
        push_result(at);
        break;
    case KRL_STORE_LOCAL: store_local(at, operands[0]); break;
    case KRL_STORE_DATA: store_data(at, operands[0]); break;
    case KRL_REF_LOCAL: push(at, (struct held){ADDRESS, operands[0], 0, 0, 0, 0}); break;
    case KRL_REF_DATA: push_constant(at, KRL_TAG_INT, operands[0]); break;
    case KRL_LOAD: load(at); break;
    case KRL_STORE: store(at); break;
    case KRL_MEMBER: member(at, operands[0]); break;
    case KRL_INDEX: {
        int32_t number = add_array(at, array_of(at, 0, operands[0]));
        step = consume(at, KRL_STEP_INDEX_ANY, types[operands[0]].count + 1);
        step->b = step->a + 1;
        step->c = number;
        push_places(at, 1);
        break;
    }
    case KRL_INDEX_LOCAL: element(at, 1, operands[0], operands[1]); break;
    case KRL_INDEX_DATA: element(at, 0, operands[0], operands[1]); break;
    case KRL_ELEMENT_LOCAL: element(at, 1, operands[0], operands[1]), load(at); break;
    case KRL_ELEMENT_DATA: element(at, 0, operands[0], operands[1]), load(at); break;
    case KRL_INDEX_VIEW: view_index(at, operands[0]); break;
    case KRL_VIEW: view(at, &types[operands[0]]); break;
    case KRL_ROW: case KRL_ROW_VIEW: row(at, now); break;
    case KRL_COPY:
        step = consume(at, KRL_STEP_COPY, 2);
        step->b = step->a + 1;
        step->c = types[operands[0]].size;
        break;
    case KRL_CLEAR: consume(at, KRL_STEP_CLEAR, 1)->c = types[operands[0]].size; break;
    case KRL_FILL_POSE: {
        int32_t to = types[operands[0]].size, of = types[operands[1]].size;
        step = consume(at, KRL_STEP_FILL_POSE, 2);
        step->b = step->a + 1;
        step->c = to;
        step->d = to < of ? to : of;
        break;
    }
    case KRL_FILL_ARRAY:
        step = consume(at, KRL_STEP_FILL_ARRAY, 2 + 2 * operands[1]);
        step->b = step->a + 1 + operands[1];
        step->c = types[operands[0]].size;
        step->d = operands[1];
        break;
    case KRL_SET_TEXT: consume(at, KRL_STEP_SET_TEXT, 2)->b = operands[0]; break;
    case KRL_COMPOSE:
        step = consume(at, KRL_STEP_COMPOSE, 3);
        step->b = step->a + 1;
        step->c = step->a + 2;
        step->d = types[operands[1]].size;
        break;
    case KRL_ADD_INT: binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 1); break;
    case KRL_SUB_INT: subtraction(at); break;
    case KRL_MUL_INT: binary(at, KRL_STEP_MUL_INT, KRL_STEP_MUL_INT_K, 1); break;
    case KRL_DIV_INT: division(at); break;
    case KRL_NEG_INT: unary(at, KRL_STEP_NEG_INT); break;
    case KRL_ADD_REAL: binary(at, KRL_STEP_ADD_REAL, KRL_STEP_ADD_REAL_K, 1); break;
    case KRL_SUB_REAL: binary(at, KRL_STEP_SUB_REAL, KRL_STEP_SUB_REAL_K, 0); break;
    case KRL_MUL_REAL: binary(at, KRL_STEP_MUL_REAL, KRL_STEP_MUL_REAL_K, 1); break;
    case KRL_DIV_REAL: quotient(at); break;
    case KRL_NEG_REAL: unary(at, KRL_STEP_NEG_REAL); break;
    case KRL_EQ_INT: case KRL_NE_INT: case KRL_LT_INT: case KRL_GT_INT: case KRL_LE_INT: case KRL_GE_INT:
        relation(at, KRL_STEP_EQ_INT, (int)now->op - KRL_EQ_INT);
        break;
    case KRL_EQ_REAL: case KRL_NE_REAL: case KRL_LT_REAL: case KRL_GT_REAL: case KRL_LE_REAL: case KRL_GE_REAL:
        relation(at, KRL_STEP_EQ_REAL, (int)now->op - KRL_EQ_REAL);
        break;
    case KRL_EQ_BOOL: case KRL_EQ_ENUM: relation(at, KRL_STEP_EQ_INT, 0); break;
    case KRL_NE_BOOL: case KRL_NE_ENUM: relation(at, KRL_STEP_EQ_INT, 1); break;
    case KRL_NOT_BOOL: unary(at, KRL_STEP_NOT_BOOL); break;
    case KRL_AND_BOOL: binary(at, KRL_STEP_AND_BOOL, KRL_STEP_COUNT, 0); break;
    case KRL_OR_BOOL: binary(at, KRL_STEP_OR_BOOL, KRL_STEP_COUNT, 0); break;
    case KRL_EXOR_BOOL: binary(at, KRL_STEP_EXOR_BOOL, KRL_STEP_COUNT, 0); break;
    case KRL_NOT_BITS: unary(at, KRL_STEP_NOT_BITS); break;
    case KRL_AND_BITS: binary(at, KRL_STEP_AND_BITS, KRL_STEP_AND_BITS_K, 1); break;
    case KRL_OR_BITS: binary(at, KRL_STEP_OR_BITS, KRL_STEP_COUNT, 0); break;
    case KRL_EXOR_BITS: binary(at, KRL_STEP_EXOR_BITS, KRL_STEP_COUNT, 0); break;
    case KRL_INT_TO_REAL: unary(at, KRL_STEP_INT_TO_REAL); break;
    case KRL_REAL_TO_INT: unary(at, KRL_STEP_REAL_TO_INT); break;
    case KRL_CHAR_TO_INT: break; /* a cell holds the code */
    case KRL_INT_TO_CHAR: unary(at, KRL_STEP_INT_TO_CHAR); break;
    case KRL_ADD_CONSTANT:
        push_constant(at, KRL_TAG_INT, operands[0]);
        binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 0);
        break;
    case KRL_UNLESS_EQ_INT: case KRL_UNLESS_NE_INT: case KRL_UNLESS_LT_INT:
    case KRL_UNLESS_GT_INT: case KRL_UNLESS_LE_INT: case KRL_UNLESS_GE_INT:
        unless(at, 0, (int)now->op - KRL_UNLESS_EQ_INT, operands[0]);
        break;
    case KRL_UNLESS_LT_REAL: case KRL_UNLESS_GT_REAL: case KRL_UNLESS_LE_REAL: case KRL_UNLESS_GE_REAL:
        unless(at, 1, 2 + (int)now->op - KRL_UNLESS_LT_REAL, operands[0]);
        break;
    case KRL_FOR_LOCAL: case KRL_FOR_DATA: count_up(at, now); break;
    case KRL_TELL_LOCAL: case KRL_TELL_DATA: case KRL_TELL_REF: case KRL_TELL: case KRL_TELL_BRANCH:
        if (at->machine->is_told)
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
                settle_all(at);
                if (at->line >= 0)
                    emit(at, KRL_STEP_NOP);
            }
            at->height = 0;
            push_places(at, code->depths[place]);
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
    machine->routines = krl_allot(program, (size_t)program->code_count, sizeof *machine->routines);
    if (at.stack == NULL || machine->routines == NULL)
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
