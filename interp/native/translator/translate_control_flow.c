/* Translates control flow: statements, jumps, loops, calls, requests. */
#include "translate.h"

#include <stdlib.h>

/* With fewer constants comparisons are faster than a table, whose jump has to wait for the
 * selector. */
enum { LEAST_CASES = 24, MOST_CASES = 1000 };

struct krl_step *krl_to_python(struct translator *at, enum krl_matter matter, int32_t place)
{
    krl_settle_all(at);
    struct krl_step *step = krl_emit(at, KRL_STEP_PYTHON);
    step->a = krl_place_of(at, at->height);
    step->b = place;
    step->tag = (uint16_t)matter;
    return step;
}

/* Stores the step of a LINE: a program can continue at any statement, where the stack is empty. */
static void start_here(struct translator *at, int32_t place)
{
    at->result = -1;
    at->routine->steps[place] = at->count;
}

void krl_line(struct translator *at, int32_t place)
{
    if (at->machine->traced & KRL_TRACED_LINE) {
        start_here(at, place);
        krl_to_python(at, KRL_MATTER_INSTRUCTION, place);
    } else {
        if (at->line >= 0)
            krl_emit(at, KRL_STEP_NOP);
        at->line = place;
        start_here(at, place);
    }
}

/* ---------------------------------------------------------------------------- jumps */

static const int opposite[] = {1, 0, 5, 4, 3, 2}; /* NE EQ GE LE GT LT */

void krl_jump_on(struct translator *at, int is_if, int32_t target)
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

void krl_jump_unless(struct translator *at, int is_real, int relation, int32_t target)
{
    krl_relate(at, is_real ? KRL_STEP_UNLESS_EQ_REAL : KRL_STEP_UNLESS_EQ_INT, relation)->d = target;
}

static int by_constant(const void *left, const void *right)
{
    const struct krl_instruction *const *one = left, *const *other = right;
    int32_t a = (*one)->operands[0], b = (*other)->operands[0];
    return a != b ? (a > b) - (a < b) : (*one > *other) - (*one < *other);
}

/* Emits SWITCH and a CASE for each number from the lowest constant to the highest, in this order. Returns 0 if
 * there are too few or too many of them. */
static int as_table(struct translator *at, const struct krl_instruction *first, int32_t count, int32_t b)
{
    const struct krl_instruction *sorted[MOST_CASES];
    if (count < LEAST_CASES || count > MOST_CASES)
        return 0;
    for (int32_t i = 0; i < count; i++)
        sorted[i] = first + i;
    qsort(sorted, (size_t)count, sizeof *sorted, by_constant);
    int32_t lowest = sorted[0]->operands[0];
    int64_t numbers = (int64_t)sorted[count - 1]->operands[0] - lowest + 1;
    if (numbers > 2 * count)
        return 0;
    struct krl_step *table = krl_emit(at, KRL_STEP_SWITCH);
    table->a = (int32_t)numbers;
    table->b = b;
    table->c = lowest;
    int32_t end = at->count + (int32_t)numbers;
    const struct krl_instruction *const *next = sorted;
    for (int32_t number = 0; number < numbers; number++) {
        while ((*next)->operands[0] < lowest + number)
            next++;
        struct krl_step *step = krl_emit(at, KRL_STEP_CASE);
        step->b = b;
        step->c = lowest + number;
        step->d = (*next)->operands[0] == step->c ? (*next)->operands[1] : ~end;
    }
    return 1;
}

void krl_choose(struct translator *at, int32_t place)
{
    const struct krl_instruction *first = &at->code->body[place];
    const uint8_t *is_target = at->code->is_target;
    int32_t count = 1;
    if (place > 0 && first[-1].op == KRL_CASE && !is_target[place])
        return; /* translated with the CASE before it */
    while (place + count < at->code->length && first[count].op == KRL_CASE && !is_target[place + count])
        count++;
    krl_settle_to(at, at->height - 1);
    if (krl_is_constant(at, at->height - 1))
        krl_settle(at, at->height - 1);
    const struct virtual_value *top = &at->stack[at->height - 1];
    int32_t b = top->kind == VARIABLE ? top->a : krl_place_of(at, at->height - 1);
    if (as_table(at, first, count, b))
        return;
    for (int32_t i = 0; i < count; i++) {
        struct krl_step *step = krl_emit(at, KRL_STEP_CASE);
        step->b = b;
        step->c = first[i].operands[0];
        step->d = first[i].operands[1];
    }
}

void krl_count_up(struct translator *at, const struct krl_instruction *instruction)
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

/* ---------------------------------------------------------------------------- calls and ends */

void krl_call_routine(struct translator *at, int32_t place)
{
    int32_t number = at->code->body[place].operands[0];
    const struct krl_code *callee = &at->program->codes[number];
    int32_t count = 0;
    int is_copied = 0;
    for (int32_t i = 0; i < callee->parameter_count; i++) {
        const struct krl_passed *passed = &callee->slots[i].passed;
        count += krl_stack_cells(passed);
        is_copied |= passed->mode == KRL_BY_VALUE && !krl_is_plain(at->program, passed->type);
    }
    krl_settle_all(at);
    if (at->machine->traced & KRL_TRACED_CALL) {
        struct krl_step *check = krl_emit(at, KRL_STEP_CHECK_CALL);
        check->b = number;
        check->c = at->code->frame;
        krl_to_python(at, KRL_MATTER_CALL, place);
    }
    struct krl_step *step = krl_consume(at, is_copied ? KRL_STEP_CALL_COPY : KRL_STEP_CALL, count);
    step->b = number;
    step->c = at->code->frame;
    step->d = at->code->frame + at->code->stack;
    krl_push_places(at, callee->result >= 0);
}

void krl_leave(struct translator *at, int32_t place)
{
    int has_value = at->code->body[place].op == KRL_RETURN_VALUE;
    int32_t b = 0;
    if (has_value)
        b = krl_operand(at, at->height - 1);
    if (at->machine->traced & KRL_TRACED_RETURN && at->code->kind == KRL_ROUTINE)
        krl_to_python(at, KRL_MATTER_LEAVE, place);
    at->height = 0;
    if (at->code->kind == KRL_ACTION)
        krl_emit(at, KRL_STEP_END_ACTION);
    else
        krl_emit(at, has_value ? KRL_STEP_RETURN_VALUE : KRL_STEP_RETURN)->b = b;
}

/* ---------------------------------------------------------------------------- requests */

static int is_named(const struct krl_entry *entry, const char *name)
{
    return entry->name.length == strlen(name) && memcmp(entry->name.bytes, name, strlen(name)) == 0;
}

void krl_ask(struct translator *at, const struct krl_entry *entry, int32_t place)
{
    int is_large = entry->result >= 0 && !krl_is_plain(at->program, entry->result);
    struct krl_step *step = krl_to_python(at, KRL_MATTER_INSTRUCTION, place);
    if (is_named(entry, "StopAdvance") && entry->input_cells == 0 && entry->result < 0)
        step->op = KRL_STEP_STOP;
    at->height -= entry->input_cells + is_large;
    krl_push_places(at, entry->result >= 0 && !is_large);
}

static int all_reals(const struct krl_entry *entry)
{
    for (int32_t i = 0; i < entry->part_count; i++)
        if (entry->parts[i].kind != KRL_PART_INPUT ||
            entry->parts[i].passed.mode != KRL_BY_VALUE || entry->parts[i].passed.type != KRL_TYPE_REAL)
            return 0;
    return entry->result == KRL_TYPE_REAL;
}

/* Whether a call is INV_POS from a pose to a pose. */
static int is_inversion(const struct translator *at, const struct krl_entry *entry)
{
    if (!is_named(entry, "INV_POS") || entry->part_count != 1 || entry->parts[0].kind != KRL_PART_INPUT ||
        entry->parts[0].passed.mode != KRL_BY_REFERENCE || entry->result < 0 ||
        at->program->types[entry->result].size < 6)
        return 0;
    for (int32_t place = 0; place < 6; place++)
        if (krl_kind_at(at->program, entry->result, place) != KRL_TYPE_REAL ||
            place >= at->program->types[entry->parts[0].passed.type].size ||
            krl_kind_at(at->program, entry->parts[0].passed.type, place) != KRL_TYPE_REAL)
            return 0;
    return 1;
}

void krl_call_builtin(struct translator *at, int32_t place)
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
    if (function != KRL_TEXT_FUNCTIONS && !(at->machine->traced & KRL_TRACED_ASSIGN)) {
        krl_settle_all(at);
        struct krl_step *step = krl_emit(at, KRL_STEP_TEXT);
        step->a = krl_place_of(at, at->height - entry->input_cells);
        step->b = number;
        step->tag = (uint16_t)function;
    }
    krl_ask(at, entry, place);
}
