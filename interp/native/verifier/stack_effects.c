/* The primitives of stack effects: checks, pops and pushes. interp/bytecode/instructions.tsv
 * defines the effect of each instruction in these terms; interp/bytecode/verifier/stack_effects.py
 * has the same primitives.
 */
#include "verifier.h"

enum { NO_TYPE = -1 };

/* ---------------------------------------------------------------------------- the stack */

static void push(struct flow *flow, struct item item)
{
    if (flow->is_wrong)
        return;
    if (flow->cells + item.cells > flow->code->stack) {
        krl_refuse_code(flow, "the stack needs more cells than the code object states");
        return;
    }
    flow->stack[flow->count++] = item;
    flow->cells += item.cells;
}

static struct item pop(struct flow *flow)
{
    if (flow->count == 0) {
        krl_refuse_code(flow, "the stack is empty");
        return (struct item){KRL_TYPE_INT, KRL_BY_VALUE, 1, 0};
    }
    struct item item = flow->stack[--flow->count];
    flow->cells -= item.cells;
    return item;
}

static void take(struct flow *flow, struct item wanted)
{
    if (!krl_is_same(pop(flow), wanted))
        krl_refuse_code(flow, "an operand has the wrong type");
}

/* ---------------------------------------------------------------------------- items */

/* The items that the operands of an instruction determine. */

static struct item value(struct flow *flow, int32_t type)
{
    (void)flow;
    return (struct item){type, KRL_BY_VALUE, 1, 0};
}

static struct item nothing(struct flow *flow)
{
    return value(flow, NO_TYPE);
}

static struct item same(struct flow *flow)
{
    return flow->same;
}

static struct item local(struct flow *flow, int32_t cell)
{
    return value(flow, krl_local_kind(flow, cell));
}

static struct item missing_local(struct flow *flow, int32_t cell)
{
    struct item item = local(flow, cell);
    item.is_missing = 1;
    return item;
}

static struct item data(struct flow *flow, int32_t cell)
{
    return value(flow, krl_data_kind(flow, cell));
}

static struct item reference(struct flow *flow, int32_t type)
{
    (void)flow;
    return (struct item){type, KRL_BY_REFERENCE, 1, 0};
}

static struct item view(struct flow *flow, int32_t element, int32_t dimensions)
{
    (void)flow;
    return (struct item){element, KRL_BY_VIEW, (uint8_t)(1 + dimensions), 0};
}

static struct item missing_view(struct flow *flow, int32_t element, int32_t dimensions)
{
    struct item item = view(flow, element, dimensions);
    item.is_missing = 1;
    return item;
}

static struct item letters(struct flow *flow)
{
    return view(flow, KRL_TYPE_CHAR, 1);
}

static struct item parameter(struct flow *flow, int32_t place)
{
    return krl_parameter(flow, place, KRL_BY_REFERENCE);
}

static struct item view_parameter(struct flow *flow, int32_t place)
{
    return krl_parameter(flow, place, KRL_BY_VIEW);
}

static struct item missing_view_parameter(struct flow *flow, int32_t place)
{
    struct item item = view_parameter(flow, place);
    item.is_missing = 1;
    return item;
}

static struct item view_element(struct flow *flow, int32_t place)
{
    return reference(flow, view_parameter(flow, place).type);
}

static struct item view_row(struct flow *flow, int32_t place, int32_t count)
{
    struct item whole = view_parameter(flow, place);
    return view(flow, whole.type, whole.cells - 1 - count);
}

static struct item array_view(struct flow *flow, int32_t array)
{
    const struct krl_type *type = &flow->program->types[array];
    return view(flow, type->element, type->count);
}

static struct item row(struct flow *flow, int32_t array, int32_t count)
{
    const struct krl_type *type = &flow->program->types[array];
    return view(flow, type->element, type->count - count);
}

static struct item element(struct flow *flow, int32_t array)
{
    return reference(flow, flow->program->types[array].element);
}

static struct item element_value(struct flow *flow, int32_t array)
{
    int32_t type = flow->program->types[array].element;
    if (!krl_is_plain(flow->program, type))
        krl_refuse_code(flow, "a reference to a single cell is required");
    return value(flow, type);
}

/* ---------------------------------------------------------------------------- pops */

static void take_any(struct flow *flow)
{
    flow->same = pop(flow);
    if (flow->same.mode != KRL_BY_VALUE || flow->same.type == NO_TYPE) {
        krl_refuse_code(flow, "a value is required");
        flow->same = value(flow, KRL_TYPE_INT);
    }
}

static void take_enumeration(struct flow *flow)
{
    take_any(flow);
    if (flow->program->types[flow->same.type].form != KRL_ENUMERATION)
        krl_refuse_code(flow, "a constant of an enumeration is required");
}

static void take_like(struct flow *flow, int32_t constant)
{
    (void)constant; /* a constant that no value equals is harmless */
    take_any(flow);
    if (flow->same.type == KRL_TYPE_REAL || flow->same.type == KRL_TYPE_BOOL)
        krl_refuse_code(flow, "an INT, a CHAR or a constant of an enumeration is required");
}

static void take_reference_to_cell(struct flow *flow)
{
    struct item item = pop(flow);
    if (item.mode == KRL_BY_REFERENCE && krl_is_plain(flow->program, item.type)) {
        flow->same = value(flow, item.type);
        return;
    }
    krl_refuse_code(flow, "a reference to a single cell is required");
    flow->same = value(flow, KRL_TYPE_INT);
}

static void take_reference_to_same(struct flow *flow)
{
    int32_t stored = flow->same.type;
    take_reference_to_cell(flow);
    if (flow->same.type != stored)
        krl_refuse_code(flow, "the value and the cell have different types");
}

static void take_whole(struct flow *flow, int32_t offset, int32_t type)
{
    struct item item = pop(flow);
    if (item.mode != KRL_BY_REFERENCE)
        krl_refuse_code(flow, "a reference is required");
    else if (!krl_has_part(flow->program, item.type, offset, type))
        krl_refuse_code(flow, "no part of this type begins here");
}

static void take_integers(struct flow *flow, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        take(flow, value(flow, KRL_TYPE_INT));
}

static void take_indices(struct flow *flow, int32_t array)
{
    take_integers(flow, flow->program->types[array].count);
}

static void take_view_indices(struct flow *flow, int32_t place)
{
    take_integers(flow, view_parameter(flow, place).cells - 1);
}

/* ---------------------------------------------------------------------------- calls and requests */

static void take_arguments(struct flow *flow, int32_t number)
{
    const struct krl_code *callee = &flow->program->codes[number];
    if (callee->kind != KRL_ROUTINE) {
        krl_refuse_code(flow, "only a routine can be called");
        return;
    }
    for (int32_t i = callee->parameter_count - 1; i >= 0 && !flow->is_wrong; i--) {
        struct krl_passed wanted = callee->slots[i].passed;
        if (wanted.mode == KRL_BY_VALUE && !krl_is_plain(flow->program, wanted.type))
            wanted.mode = KRL_BY_REFERENCE; /* the call copies the structure from there */
        struct item given = pop(flow);
        if (given.mode == KRL_BY_VALUE && given.type == NO_TYPE && wanted.mode == KRL_BY_VALUE)
            continue;
        given.is_missing = 0;
        if (!krl_is_same(given, krl_item_of(&wanted)))
            krl_refuse_code(flow, "an argument has the wrong type");
    }
}

static void push_result(struct flow *flow, int32_t number)
{
    if (flow->program->codes[number].result >= 0)
        push(flow, value(flow, flow->program->codes[number].result));
}

/* Whether the input of a predefined function whose first cell has the index `place` is a text that
 * the function only reads. Such a text may have been left out. */
static int is_text_read(const struct krl_entry *entry, const struct krl_passed *input, int32_t place)
{
    if (input->mode != KRL_BY_VIEW || input->dimensions != 1 || input->type != KRL_TYPE_CHAR)
        return 0;
    for (int32_t i = 0; i < entry->part_count; i++)
        if (entry->parts[i].kind == KRL_PART_INPUT && entry->parts[i].place == place)
            return 1;
    return 0;
}

static void take_entry(struct flow *flow, const struct krl_entry *entry, int is_builtin)
{
    if (entry->result >= 0 && !krl_is_plain(flow->program, entry->result))
        take(flow, reference(flow, entry->result));
    int32_t place = entry->input_cells;
    for (int32_t i = entry->input_count - 1; i >= 0 && !flow->is_wrong; i--) {
        const struct krl_passed *input = &entry->inputs[i];
        struct item given = pop(flow);
        place -= krl_stack_cells(input);
        if (is_builtin && is_text_read(entry, input, place))
            given.is_missing = 0;
        if (!krl_is_same(given, krl_item_of(input)))
            krl_refuse_code(flow, "an input has the wrong type");
    }
}

static void push_entry(struct flow *flow, const struct krl_entry *entry)
{
    if (entry->result >= 0 && krl_is_plain(flow->program, entry->result))
        push(flow, value(flow, entry->result));
}

static void take_request(struct flow *flow, int32_t number)
{
    take_entry(flow, &flow->program->asks[number], 0);
}

static void push_reply(struct flow *flow, int32_t number)
{
    push_entry(flow, &flow->program->asks[number]);
}

static void take_inputs(struct flow *flow, int32_t number)
{
    take_entry(flow, &flow->program->builtins[number], 1);
}

static void push_output(struct flow *flow, int32_t number)
{
    push_entry(flow, &flow->program->builtins[number]);
}

static void take_own_result(struct flow *flow)
{
    if (flow->code->result < 0) {
        krl_refuse_code(flow, "the code object has no result");
        return;
    }
    take(flow, value(flow, flow->code->result));
    if (flow->count > 0)
        krl_refuse_code(flow, "the stack must be empty here");
}

/* ---------------------------------------------------------------------------- instructions */

void krl_apply(struct flow *flow, const struct krl_instruction *instruction)
{
    const int32_t *operands = instruction->operands;
    switch ((enum krl_opcode)instruction->op) {
#include "stack_effects.gen.h"
    case KRL_OPCODE_COUNT: break;
    }
}
