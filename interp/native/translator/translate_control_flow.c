/* Translating what decides where to go on: statements, jumps, loops, calls, requests. */
#include "translate.h"

struct krl_step *krl_to_python(struct translator *at, enum krl_matter matter, int32_t place)
{
    krl_settle_all(at);
    struct krl_step *step = krl_emit(at, KRL_STEP_PYTHON);
    step->a = krl_place_of(at, at->height);
    step->b = place;
    step->tag = (uint16_t)matter;
    return step;
}

/* The program can go on at any statement, where the stack is empty. */
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
        const struct krl_handed *handed = &callee->slots[i].handed;
        count += krl_stack_cells(handed);
        is_copied |= handed->mode == KRL_BY_VALUE && !krl_is_plain(at->program, handed->type);
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
            entry->parts[i].handed.mode != KRL_BY_VALUE || entry->parts[i].handed.type != KRL_TYPE_REAL)
            return 0;
    return entry->result == KRL_TYPE_REAL;
}

/* INV_POS of a pose, into a pose. */
static int is_inversion(const struct translator *at, const struct krl_entry *entry)
{
    if (!is_named(entry, "INV_POS") || entry->part_count != 1 || entry->parts[0].kind != KRL_PART_INPUT ||
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
