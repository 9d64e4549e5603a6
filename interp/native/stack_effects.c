/* What each instruction takes from the stack and leaves there, for the verifier; as
 * interp/bytecode/verifier/stack_effects.py has it. */
#include "flow.h"

enum { NO_TYPE = -1 };

/* ---------------------------------------------------------------------------- the stack */

static struct item value(int32_t type)
{
    return (struct item){type, KRL_BY_VALUE, 1, 0};
}

static struct item reference(int32_t type)
{
    return (struct item){type, KRL_BY_REFERENCE, 1, 0};
}

static struct item view(int32_t type, int32_t dimensions)
{
    return (struct item){type, KRL_BY_VIEW, (uint8_t)(1 + dimensions), 0};
}

static struct item handed(const struct krl_handed *handed)
{
    return (struct item){handed->type, (uint8_t)handed->mode, (uint8_t)krl_stack_cells(handed), 0};
}

static void push(struct flow *flow, struct item held)
{
    if (flow->is_wrong)
        return;
    if (flow->cells + held.cells > flow->code->stack) {
        krl_refuse_code(flow, "the stack has more cells than the code object says");
        return;
    }
    flow->stack[flow->count++] = held;
    flow->cells += held.cells;
}

static struct item pop(struct flow *flow)
{
    if (flow->count == 0) {
        krl_refuse_code(flow, "the stack is empty");
        return value(KRL_TYPE_INT);
    }
    struct item held = flow->stack[--flow->count];
    flow->cells -= held.cells;
    return held;
}

static void take(struct flow *flow, struct item wanted)
{
    if (!krl_is_same(pop(flow), wanted))
        krl_refuse_code(flow, "the stack does not hold what is taken");
}

static struct item take_value(struct flow *flow)
{
    struct item held = pop(flow);
    if (held.mode != KRL_BY_VALUE || held.type == NO_TYPE) {
        krl_refuse_code(flow, "a value is needed");
        return value(KRL_TYPE_INT);
    }
    return held;
}

/* Takes operands of one type, gives a result. */
static void computes(struct flow *flow, int count, int32_t operands, int32_t result)
{
    for (int i = 0; i < count; i++)
        take(flow, value(operands));
    push(flow, value(result));
}

/* The parameter of this mode that begins there. */
static struct item parameter(struct flow *flow, int32_t place, enum krl_mode mode)
{
    const struct krl_slot *slot = krl_slot_at(flow->code, place);
    if (slot == NULL || slot->offset != place || slot->is_local || slot->handed.mode != mode) {
        krl_refuse_code(flow, "no such parameter begins there");
        return mode == KRL_BY_VIEW ? view(KRL_TYPE_INT, 1) : reference(KRL_TYPE_INT);
    }
    return handed(&slot->handed);
}

static void take_indices(struct flow *flow, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        take(flow, value(KRL_TYPE_INT));
}

/* Takes all indices of an array; gives the type of its elements. */
static int32_t all_indices(struct flow *flow, int32_t number)
{
    const struct krl_type *type = krl_array_named(flow, number);
    if (type == NULL)
        return KRL_TYPE_INT;
    take_indices(flow, type->count);
    return type->element;
}

static int32_t referred(struct flow *flow)
{
    struct item held = pop(flow);
    if (held.mode != KRL_BY_REFERENCE || !krl_is_plain(flow->program, held.type)) {
        krl_refuse_code(flow, "a reference to a cell is needed");
        return KRL_TYPE_INT;
    }
    return held.type;
}

/* ---------------------------------------------------------------------------- calls, requests */

static void call(struct flow *flow, int32_t number)
{
    const struct krl_code *callee = &flow->program->codes[number];
    if (callee->kind != KRL_ROUTINE) {
        krl_refuse_code(flow, "only a routine can be called");
        return;
    }
    for (int32_t i = callee->parameter_count - 1; i >= 0 && !flow->is_wrong; i--) {
        struct krl_handed wanted = callee->slots[i].handed;
        if (wanted.mode == KRL_BY_VALUE && !krl_is_plain(flow->program, wanted.type))
            wanted.mode = KRL_BY_REFERENCE; /* the structure is copied from there */
        struct item held = pop(flow);
        if (held.mode == KRL_BY_VALUE && held.type == NO_TYPE && wanted.mode == KRL_BY_VALUE)
            continue;
        held.is_missing = 0;
        if (!krl_is_same(held, handed(&wanted)))
            krl_refuse_code(flow, "an argument is of another kind");
    }
    if (callee->result >= 0)
        push(flow, value(callee->result));
}

/* Whether an input of a predefined function, whose first cell has this place, is a text that it
 * reads: it may have been left out. */
static int is_text_read(const struct krl_entry *entry, const struct krl_handed *input, int32_t place)
{
    if (input->mode != KRL_BY_VIEW || input->dimensions != 1 || input->type != KRL_TYPE_CHAR)
        return 0;
    for (int32_t i = 0; i < entry->part_count; i++)
        if (entry->parts[i].kind == KRL_PART_INPUT && entry->parts[i].place == place)
            return 1;
    return 0;
}

static void cross(struct flow *flow, const struct krl_entry *entry, int is_builtin)
{
    int is_large = entry->result >= 0 && !krl_is_plain(flow->program, entry->result);
    if (is_large)
        take(flow, reference(entry->result));
    int32_t place = entry->input_cells;
    for (int32_t i = entry->input_count - 1; i >= 0 && !flow->is_wrong; i--) {
        const struct krl_handed *input = &entry->inputs[i];
        struct item held = pop(flow);
        place -= krl_stack_cells(input);
        if (is_builtin && is_text_read(entry, input, place))
            held.is_missing = 0;
        if (!krl_is_same(held, handed(input)))
            krl_refuse_code(flow, "an input is of another kind");
    }
    if (entry->result >= 0 && !is_large)
        push(flow, value(entry->result));
}

static void ends(struct flow *flow, int has_value)
{
    if (has_value != (flow->code->result >= 0) ||
        (!has_value && flow->code->kind == KRL_CONDITION)) {
        krl_refuse_code(flow, "a result is missing, or there is one too many");
        return;
    }
    if (has_value)
        take(flow, value(flow->code->result));
    if (flow->count > 0)
        krl_refuse_code(flow, "something is left on the stack");
}

/* ---------------------------------------------------------------------------- instructions */

static void constant(struct flow *flow, int32_t type, int32_t place)
{
    if (flow->program->types[type].form != KRL_ENUMERATION || place >= flow->program->types[type].count)
        krl_refuse_code(flow, "there is no such constant");
    push(flow, value(type));
}

static void counts(struct flow *flow, int32_t kind, const int32_t *operands)
{
    if (kind != KRL_TYPE_INT || krl_local_kind(flow, operands[1]) != KRL_TYPE_INT || operands[2] == 0)
        krl_refuse_code(flow, "a counter, a limit and a step are needed");
}

void krl_apply(struct flow *flow, const struct krl_instruction *instruction)
{
    enum { INT = KRL_TYPE_INT, REAL = KRL_TYPE_REAL, BOOL = KRL_TYPE_BOOL, CHAR = KRL_TYPE_CHAR };
    const struct krl_program *program = flow->program;
    const int32_t *operands = instruction->operands;
    const struct krl_type *type;
    struct item held;
    switch ((enum krl_opcode)instruction->op) {
    case KRL_LINE:
        if (flow->count > 0)
            krl_refuse_code(flow, "a statement begins with an empty stack");
        break;
    case KRL_AT: case KRL_JUMP: case KRL_PROCEED: case KRL_FAIL: case KRL_UNLINKED:
    case KRL_TELL_LOCAL: case KRL_TELL_DATA: case KRL_TELL_REF: case KRL_TELL: case KRL_TELL_BRANCH:
        break; /* what is told is worked out in Python */
    case KRL_JUMP_IF: case KRL_JUMP_UNLESS: take(flow, value(BOOL)); break;
    case KRL_CASE:
        held = take_value(flow);
        if (held.type == REAL || held.type == BOOL)
            krl_refuse_code(flow, "an INT, CHAR or constant is needed");
        push(flow, held);
        break;
    case KRL_CALL: call(flow, operands[0]); break;
    case KRL_RETURN: ends(flow, 0); break;
    case KRL_RETURN_VALUE: ends(flow, 1); break;
    case KRL_ASK: cross(flow, &program->asks[operands[0]], 0); break;
    case KRL_BUILTIN: cross(flow, &program->builtins[operands[0]], 1); break;
    case KRL_PUSH_INT: push(flow, value(INT)); break;
    case KRL_PUSH_REAL: push(flow, value(REAL)); break;
    case KRL_PUSH_BOOL: push(flow, value(BOOL)); break;
    case KRL_PUSH_CHAR: push(flow, value(CHAR)); break;
    case KRL_PUSH_ENUM: constant(flow, operands[0], operands[1]); break;
    case KRL_PUSH_NOTHING: push(flow, value(NO_TYPE)); break;
    case KRL_PUSH_NO_VIEW:
        if (krl_is_rank(flow, operands[1])) {
            held = view(operands[0], operands[1]);
            held.is_missing = 1;
            push(flow, held);
        }
        break;
    case KRL_DROP: take_value(flow); break;
    case KRL_LOAD_LOCAL: push(flow, value(krl_local_kind(flow, operands[0]))); break;
    case KRL_LOAD_DATA: push(flow, value(krl_data_kind(flow, operands[0]))); break;
    case KRL_STORE_LOCAL: take(flow, value(krl_local_kind(flow, operands[0]))); break;
    case KRL_STORE_DATA: take(flow, value(krl_data_kind(flow, operands[0]))); break;
    case KRL_REF_LOCAL:
        krl_check_local_part(flow, operands[0], operands[1]);
        push(flow, reference(operands[1]));
        break;
    case KRL_REF_DATA:
        krl_check_data_part(flow, operands[0], operands[1]);
        push(flow, reference(operands[1]));
        break;
    case KRL_LOAD_REF: push(flow, parameter(flow, operands[0], KRL_BY_REFERENCE)); break;
    case KRL_LOAD_VIEW: push(flow, parameter(flow, operands[0], KRL_BY_VIEW)); break;
    case KRL_PASS_VIEW:
        held = parameter(flow, operands[0], KRL_BY_VIEW);
        held.is_missing = 1;
        push(flow, held);
        break;
    case KRL_LOAD: push(flow, value(referred(flow))); break;
    case KRL_STORE:
        held = take_value(flow);
        if (referred(flow) != held.type)
            krl_refuse_code(flow, "the value is of another kind");
        break;
    case KRL_MEMBER:
        held = pop(flow);
        if (held.mode != KRL_BY_REFERENCE || !krl_has_part(program, held.type, operands[0], operands[1]))
            krl_refuse_code(flow, "no such part is there");
        push(flow, reference(operands[1]));
        break;
    case KRL_INDEX: {
        int32_t element = all_indices(flow, operands[0]);
        take(flow, reference(operands[0]));
        push(flow, reference(element));
        break;
    }
    case KRL_INDEX_LOCAL:
    case KRL_ELEMENT_LOCAL:
        krl_check_local_part(flow, operands[0], operands[1]);
        push(flow, reference(all_indices(flow, operands[1])));
        if (instruction->op == KRL_ELEMENT_LOCAL)
            push(flow, value(referred(flow)));
        break;
    case KRL_INDEX_DATA:
    case KRL_ELEMENT_DATA:
        krl_check_data_part(flow, operands[0], operands[1]);
        push(flow, reference(all_indices(flow, operands[1])));
        if (instruction->op == KRL_ELEMENT_DATA)
            push(flow, value(referred(flow)));
        break;
    case KRL_INDEX_VIEW:
        held = parameter(flow, operands[0], KRL_BY_VIEW);
        take_indices(flow, held.cells - 1);
        push(flow, reference(held.type));
        break;
    case KRL_VIEW:
        if ((type = krl_array_named(flow, operands[0])) != NULL) {
            take(flow, reference(operands[0]));
            push(flow, view(type->element, type->count));
        }
        break;
    case KRL_ROW:
        if ((type = krl_array_named(flow, operands[0])) == NULL)
            break;
        if (operands[1] < 1 || operands[1] >= type->count) {
            krl_refuse_code(flow, "a row has one index at least and not all of them");
            break;
        }
        take_indices(flow, operands[1]);
        take(flow, reference(operands[0]));
        push(flow, view(type->element, type->count - operands[1]));
        break;
    case KRL_ROW_VIEW:
        held = parameter(flow, operands[0], KRL_BY_VIEW);
        if (operands[1] < 1 || operands[1] >= held.cells - 1) {
            krl_refuse_code(flow, "a row has one index at least and not all of them");
            break;
        }
        take_indices(flow, operands[1]);
        push(flow, view(held.type, held.cells - 1 - operands[1]));
        break;
    case KRL_COPY:
        take(flow, reference(operands[0]));
        take(flow, reference(operands[0]));
        break;
    case KRL_CLEAR: take(flow, reference(operands[0])); break;
    case KRL_FILL_POSE:
        krl_check_alike(flow, operands[0], operands[1]);
        take(flow, reference(operands[1]));
        take(flow, reference(operands[0]));
        break;
    case KRL_FILL_ARRAY:
        if (krl_is_rank(flow, operands[1])) {
            take(flow, view(operands[0], operands[1]));
            take(flow, view(operands[0], operands[1]));
        }
        break;
    case KRL_COPY_VIEW:
        krl_check_local_part(flow, operands[0], operands[1]);
        if ((type = krl_array_named(flow, operands[1])) != NULL) {
            take(flow, view(type->element, type->count));
            push(flow, view(type->element, type->count));
        }
        break;
    case KRL_SET_TEXT: take(flow, view(CHAR, 1)); break;
    case KRL_ADD_INT: case KRL_SUB_INT: case KRL_MUL_INT: case KRL_DIV_INT:
    case KRL_AND_BITS: case KRL_OR_BITS: case KRL_EXOR_BITS:
        computes(flow, 2, INT, INT);
        break;
    case KRL_NEG_INT: case KRL_NOT_BITS: case KRL_ADD_CONSTANT: computes(flow, 1, INT, INT); break;
    case KRL_ADD_REAL: case KRL_SUB_REAL: case KRL_MUL_REAL: case KRL_DIV_REAL:
        computes(flow, 2, REAL, REAL);
        break;
    case KRL_NEG_REAL: computes(flow, 1, REAL, REAL); break;
    case KRL_EQ_INT: case KRL_NE_INT: case KRL_LT_INT: case KRL_GT_INT: case KRL_LE_INT: case KRL_GE_INT:
        computes(flow, 2, INT, BOOL);
        break;
    case KRL_EQ_REAL: case KRL_NE_REAL: case KRL_LT_REAL: case KRL_GT_REAL: case KRL_LE_REAL: case KRL_GE_REAL:
        computes(flow, 2, REAL, BOOL);
        break;
    case KRL_EQ_BOOL: case KRL_NE_BOOL: case KRL_AND_BOOL: case KRL_OR_BOOL: case KRL_EXOR_BOOL:
        computes(flow, 2, BOOL, BOOL);
        break;
    case KRL_NOT_BOOL: computes(flow, 1, BOOL, BOOL); break;
    case KRL_EQ_ENUM: case KRL_NE_ENUM:
        held = take_value(flow);
        if (program->types[held.type].form != KRL_ENUMERATION)
            krl_refuse_code(flow, "constants of enumerations are needed");
        take(flow, held);
        push(flow, value(BOOL));
        break;
    case KRL_COMPOSE:
        krl_check_alike(flow, operands[0], operands[1]);
        krl_check_pose(flow, operands[0]);
        krl_check_pose(flow, operands[1]);
        take(flow, reference(operands[1]));
        take(flow, reference(operands[0]));
        take(flow, reference(operands[1]));
        break;
    case KRL_INT_TO_REAL: computes(flow, 1, INT, REAL); break;
    case KRL_REAL_TO_INT: computes(flow, 1, REAL, INT); break;
    case KRL_CHAR_TO_INT: computes(flow, 1, CHAR, INT); break;
    case KRL_INT_TO_CHAR: computes(flow, 1, INT, CHAR); break;
    case KRL_UNLESS_EQ_INT: case KRL_UNLESS_NE_INT: case KRL_UNLESS_LT_INT:
    case KRL_UNLESS_GT_INT: case KRL_UNLESS_LE_INT: case KRL_UNLESS_GE_INT:
        take_indices(flow, 2);
        break;
    case KRL_UNLESS_LT_REAL: case KRL_UNLESS_GT_REAL: case KRL_UNLESS_LE_REAL: case KRL_UNLESS_GE_REAL:
        take(flow, value(REAL));
        take(flow, value(REAL));
        break;
    case KRL_FOR_LOCAL: counts(flow, krl_local_kind(flow, operands[0]), operands); break;
    case KRL_FOR_DATA: counts(flow, krl_data_kind(flow, operands[0]), operands); break;
    case KRL_OPCODE_COUNT: break;
    }
}
