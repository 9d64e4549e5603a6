/* Whether a program keeps the rules that the machine relies on, so that no image can do harm.
 *
 * The same is asked as by interp/bytecode/verify.py and flow.py, as far as memory and time depend on
 * it: what lies on the stack at every instruction, that references and views lead to cells of their
 * type, that no way falls off the end, and that every circle has a statement in it. Names, and
 * whether the parts of a request fit its fields, are left to the verifier in Python: nothing here
 * uses them.
 */
#include "program.h"

#include <stdlib.h>

/* What lies on the stack. Of a view that may be missing, and of a value that was left out (type -1),
 * nothing is ever used but the sizes, which are 0. */
struct held {
    int32_t type;
    uint8_t mode;
    uint8_t cells;
    uint8_t is_missing;
};

enum { NO_TYPE = -1 };
/* All stacks of a code object where ways meet have at most so many entries together. */
enum { MOST_REMEMBERED = 1 << 23 };

struct remembered {
    struct held *held; /* NULL where no way leads to it yet */
    int32_t count;
};

struct flow {
    const struct krl_program *program;
    struct krl_code *code;
    struct krl_refusal *why;
    struct krl_program scratch; /* memory for the time of the check */
    struct remembered *at;      /* for targets only */
    int32_t *todo;
    int32_t todo_count;
    int64_t remembered;
    struct held *stack;
    int32_t count;
    int32_t cells;
    int is_wrong;
};

static void refuse(struct flow *flow, const char *reason)
{
    krl_refuse(flow->why, reason);
    flow->is_wrong = 1;
}

/* ---------------------------------------------------------------------------- the stack */

static struct held value(int32_t type)
{
    return (struct held){type, KRL_BY_VALUE, 1, 0};
}

static struct held reference(int32_t type)
{
    return (struct held){type, KRL_BY_REFERENCE, 1, 0};
}

static struct held view(int32_t type, int32_t dimensions)
{
    return (struct held){type, KRL_BY_VIEW, (uint8_t)(1 + dimensions), 0};
}

static struct held handed(const struct krl_handed *handed)
{
    return (struct held){handed->type, (uint8_t)handed->mode, (uint8_t)krl_stack_cells(handed), 0};
}

static int is_equal(struct held left, struct held right)
{
    return left.type == right.type && left.mode == right.mode && left.cells == right.cells &&
           left.is_missing == right.is_missing;
}

static void push(struct flow *flow, struct held held)
{
    if (flow->is_wrong)
        return;
    if (flow->cells + held.cells > flow->code->stack) {
        refuse(flow, "the stack has more cells than the code object says");
        return;
    }
    flow->stack[flow->count++] = held;
    flow->cells += held.cells;
}

static struct held pop(struct flow *flow)
{
    if (flow->count == 0) {
        refuse(flow, "the stack is empty");
        return value(KRL_TYPE_INT);
    }
    struct held held = flow->stack[--flow->count];
    flow->cells -= held.cells;
    return held;
}

static void take(struct flow *flow, struct held wanted)
{
    if (!is_equal(pop(flow), wanted))
        refuse(flow, "the stack does not hold what is taken");
}

static struct held take_value(struct flow *flow)
{
    struct held held = pop(flow);
    if (held.mode != KRL_BY_VALUE || held.type == NO_TYPE) {
        refuse(flow, "a value is needed");
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

/* ---------------------------------------------------------------------------- places */

/* The variable that a cell of the frame belongs to, and the offset within it. */
static const struct krl_slot *variable(struct flow *flow, int32_t *place)
{
    const struct krl_slot *slot = krl_slot_at(flow->code, *place);
    if (slot == NULL || slot->handed.mode != KRL_BY_VALUE) {
        refuse(flow, "there is no such variable in the frame");
        return NULL;
    }
    *place -= slot->offset;
    return slot;
}

static int32_t local_kind(struct flow *flow, int32_t place)
{
    const struct krl_slot *slot = variable(flow, &place);
    return slot == NULL ? KRL_TYPE_INT : krl_kind_at(flow->program, slot->handed.type, place);
}

static int32_t data_kind(struct flow *flow, int32_t address)
{
    const struct krl_variable *found = krl_data_at(flow->program, address);
    if (found == NULL) {
        refuse(flow, "there is no such variable in the data lists");
        return KRL_TYPE_INT;
    }
    return krl_kind_at(flow->program, found->type, address - found->address);
}

static void local_part(struct flow *flow, int32_t place, int32_t type)
{
    const struct krl_slot *slot = variable(flow, &place);
    if (slot != NULL && !krl_has_part(flow->program, slot->handed.type, place, type))
        refuse(flow, "no such part of a variable is there");
}

static void data_part(struct flow *flow, int32_t address, int32_t type)
{
    const struct krl_variable *found = krl_data_at(flow->program, address);
    if (found == NULL || !krl_has_part(flow->program, found->type, address - found->address, type))
        refuse(flow, "no such part of a variable is there");
}

/* The parameter of this mode that begins there. */
static struct held parameter(struct flow *flow, int32_t place, enum krl_mode mode)
{
    const struct krl_slot *slot = krl_slot_at(flow->code, place);
    if (slot == NULL || slot->offset != place || slot->is_local || slot->handed.mode != mode) {
        refuse(flow, "no such parameter begins there");
        return mode == KRL_BY_VIEW ? view(KRL_TYPE_INT, 1) : reference(KRL_TYPE_INT);
    }
    return handed(&slot->handed);
}

static const struct krl_type *array(struct flow *flow, int32_t number)
{
    const struct krl_type *type = &flow->program->types[number];
    if (type->form != KRL_ARRAY) {
        refuse(flow, "an array is needed");
        return NULL;
    }
    return type;
}

static void take_indices(struct flow *flow, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        take(flow, value(KRL_TYPE_INT));
}

/* Takes all indices of an array; gives the type of its elements. */
static int32_t all_indices(struct flow *flow, int32_t number)
{
    const struct krl_type *type = array(flow, number);
    if (type == NULL)
        return KRL_TYPE_INT;
    take_indices(flow, type->count);
    return type->element;
}

static int32_t referred(struct flow *flow)
{
    struct held held = pop(flow);
    if (held.mode != KRL_BY_REFERENCE || !krl_is_plain(flow->program, held.type)) {
        refuse(flow, "a reference to a cell is needed");
        return KRL_TYPE_INT;
    }
    return held.type;
}

/* Of two structures the cells that both have must be of the same kinds. */
static void check_alike(struct flow *flow, int32_t left, int32_t right)
{
    const struct krl_type *types = flow->program->types;
    int32_t count = types[left].size < types[right].size ? types[left].size : types[right].size;
    /* No position has more cells; the names that tell positions apart are not looked at here. */
    if (types[left].form != KRL_STRUCTURE || types[right].form != KRL_STRUCTURE || count > 64) {
        refuse(flow, "positions are needed");
        return;
    }
    for (int32_t place = 0; place < count; place++)
        if (krl_kind_at(flow->program, left, place) != krl_kind_at(flow->program, right, place))
            refuse(flow, "positions of one family are needed");
}

static void check_pose(struct flow *flow, int32_t type)
{
    for (int32_t place = 0; place < 6; place++)
        if (flow->program->types[type].size < 6 ||
            krl_kind_at(flow->program, type, place) != KRL_TYPE_REAL) {
            refuse(flow, "poses are needed");
            return;
        }
}

/* ---------------------------------------------------------------------------- instructions */

static void call(struct flow *flow, int32_t number)
{
    const struct krl_code *callee = &flow->program->codes[number];
    if (callee->kind != KRL_ROUTINE) {
        refuse(flow, "only a routine can be called");
        return;
    }
    for (int32_t i = callee->parameter_count - 1; i >= 0 && !flow->is_wrong; i--) {
        struct krl_handed wanted = callee->slots[i].handed;
        if (wanted.mode == KRL_BY_VALUE && !krl_is_plain(flow->program, wanted.type))
            wanted.mode = KRL_BY_REFERENCE; /* the structure is copied from there */
        struct held held = pop(flow);
        if (held.mode == KRL_BY_VALUE && held.type == NO_TYPE && wanted.mode == KRL_BY_VALUE)
            continue;
        held.is_missing = 0;
        if (!is_equal(held, handed(&wanted)))
            refuse(flow, "an argument is of another kind");
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
        struct held held = pop(flow);
        place -= krl_stack_cells(input);
        if (is_builtin && is_text_read(entry, input, place))
            held.is_missing = 0;
        if (!is_equal(held, handed(input)))
            refuse(flow, "an input is of another kind");
    }
    if (entry->result >= 0 && !is_large)
        push(flow, value(entry->result));
}

static void ends(struct flow *flow, int has_value)
{
    if (has_value != (flow->code->result >= 0) ||
        (!has_value && flow->code->kind == KRL_CONDITION)) {
        refuse(flow, "a result is missing, or there is one too many");
        return;
    }
    if (has_value)
        take(flow, value(flow->code->result));
    if (flow->count > 0)
        refuse(flow, "something is left on the stack");
}

static void constant(struct flow *flow, int32_t type, int32_t place)
{
    if (flow->program->types[type].form != KRL_ENUMERATION || place >= flow->program->types[type].count)
        refuse(flow, "there is no such constant");
    push(flow, value(type));
}

static void counts(struct flow *flow, int32_t kind, const int32_t *operands)
{
    if (kind != KRL_TYPE_INT || local_kind(flow, operands[1]) != KRL_TYPE_INT || operands[2] == 0)
        refuse(flow, "a counter, a limit and a step are needed");
}

static int is_rank(struct flow *flow, int32_t dimensions)
{
    if (dimensions >= 1 && dimensions <= KRL_MOST_DIMENSIONS)
        return 1;
    refuse(flow, "arrays have 1 to 3 dimensions");
    return 0;
}

static void apply(struct flow *flow, const struct krl_instruction *instruction)
{
    enum { INT = KRL_TYPE_INT, REAL = KRL_TYPE_REAL, BOOL = KRL_TYPE_BOOL, CHAR = KRL_TYPE_CHAR };
    const struct krl_program *program = flow->program;
    const int32_t *operands = instruction->operands;
    const struct krl_type *type;
    struct held held;
    switch ((enum krl_opcode)instruction->op) {
    case KRL_LINE:
        if (flow->count > 0)
            refuse(flow, "a statement begins with an empty stack");
        break;
    case KRL_AT: case KRL_JUMP: case KRL_PROCEED: case KRL_FAIL: case KRL_UNLINKED:
    case KRL_TELL_LOCAL: case KRL_TELL_DATA: case KRL_TELL_REF: case KRL_TELL: case KRL_TELL_BRANCH:
        break; /* what is told is worked out in Python */
    case KRL_JUMP_IF: case KRL_JUMP_UNLESS: take(flow, value(BOOL)); break;
    case KRL_CASE:
        held = take_value(flow);
        if (held.type == REAL || held.type == BOOL)
            refuse(flow, "an INT, CHAR or constant is needed");
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
        if (is_rank(flow, operands[1])) {
            held = view(operands[0], operands[1]);
            held.is_missing = 1;
            push(flow, held);
        }
        break;
    case KRL_DROP: take_value(flow); break;
    case KRL_LOAD_LOCAL: push(flow, value(local_kind(flow, operands[0]))); break;
    case KRL_LOAD_DATA: push(flow, value(data_kind(flow, operands[0]))); break;
    case KRL_STORE_LOCAL: take(flow, value(local_kind(flow, operands[0]))); break;
    case KRL_STORE_DATA: take(flow, value(data_kind(flow, operands[0]))); break;
    case KRL_REF_LOCAL:
        local_part(flow, operands[0], operands[1]);
        push(flow, reference(operands[1]));
        break;
    case KRL_REF_DATA:
        data_part(flow, operands[0], operands[1]);
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
            refuse(flow, "the value is of another kind");
        break;
    case KRL_MEMBER:
        held = pop(flow);
        if (held.mode != KRL_BY_REFERENCE || !krl_has_part(program, held.type, operands[0], operands[1]))
            refuse(flow, "no such part is there");
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
        local_part(flow, operands[0], operands[1]);
        push(flow, reference(all_indices(flow, operands[1])));
        if (instruction->op == KRL_ELEMENT_LOCAL)
            push(flow, value(referred(flow)));
        break;
    case KRL_INDEX_DATA:
    case KRL_ELEMENT_DATA:
        data_part(flow, operands[0], operands[1]);
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
        if ((type = array(flow, operands[0])) != NULL) {
            take(flow, reference(operands[0]));
            push(flow, view(type->element, type->count));
        }
        break;
    case KRL_ROW:
        if ((type = array(flow, operands[0])) == NULL)
            break;
        if (operands[1] < 1 || operands[1] >= type->count) {
            refuse(flow, "a row has one index at least and not all of them");
            break;
        }
        take_indices(flow, operands[1]);
        take(flow, reference(operands[0]));
        push(flow, view(type->element, type->count - operands[1]));
        break;
    case KRL_ROW_VIEW:
        held = parameter(flow, operands[0], KRL_BY_VIEW);
        if (operands[1] < 1 || operands[1] >= held.cells - 1) {
            refuse(flow, "a row has one index at least and not all of them");
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
        check_alike(flow, operands[0], operands[1]);
        take(flow, reference(operands[1]));
        take(flow, reference(operands[0]));
        break;
    case KRL_FILL_ARRAY:
        if (is_rank(flow, operands[1])) {
            take(flow, view(operands[0], operands[1]));
            take(flow, view(operands[0], operands[1]));
        }
        break;
    case KRL_COPY_VIEW:
        local_part(flow, operands[0], operands[1]);
        if ((type = array(flow, operands[1])) != NULL) {
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
            refuse(flow, "constants of enumerations are needed");
        take(flow, held);
        push(flow, value(BOOL));
        break;
    case KRL_COMPOSE:
        check_alike(flow, operands[0], operands[1]);
        check_pose(flow, operands[0]);
        check_pose(flow, operands[1]);
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
    case KRL_FOR_LOCAL: counts(flow, local_kind(flow, operands[0]), operands); break;
    case KRL_FOR_DATA: counts(flow, data_kind(flow, operands[0]), operands); break;
    case KRL_OPCODE_COUNT: break;
    }
}

/* ---------------------------------------------------------------------------- ways */

static int is_end(uint32_t op)
{
    return op == KRL_JUMP || op == KRL_RETURN || op == KRL_RETURN_VALUE || op == KRL_FAIL || op == KRL_UNLINKED;
}

/* Where the instruction may go on besides the next one, or -1; none has more than one target. */
static int32_t target_of(const struct krl_instruction *instruction)
{
    static const uint32_t kinds[] = {
#define KINDS(name, count, kinds) kinds,
        KRL_OPCODES(KINDS)
    };
    uint32_t packed = kinds[instruction->op];
    for (int place = 0; packed != 0; place++, packed >>= 8)
        if ((packed & 0xff) == KRL_OPERAND_TARGET)
            return instruction->operands[place];
    return -1;
}

/* The stack meets that of another way, or goes on alone. */
static void meet(struct flow *flow, int32_t place, int32_t count)
{
    struct remembered *there = &flow->at[place];
    if (flow->is_wrong)
        return;
    if (there->held == NULL) {
        flow->remembered += count + 1;
        there->held = flow->remembered > MOST_REMEMBERED
                          ? NULL
                          : krl_allot(&flow->scratch, (size_t)count + 1, sizeof *there->held);
        if (there->held == NULL) {
            refuse(flow, "the code object is too large to be checked");
            return;
        }
        memcpy(there->held, flow->stack, (size_t)count * sizeof *there->held);
        there->count = count;
        flow->todo[flow->todo_count++] = place;
        return;
    }
    int differs = there->count != count;
    for (int32_t i = 0; i < count && !differs; i++)
        differs = !is_equal(there->held[i], flow->stack[i]);
    if (differs)
        refuse(flow, "the stack differs from that of another way");
}

/* Walks on from a place until a way ends or meets another one. */
static void walk(struct flow *flow, int32_t place)
{
    const struct krl_code *code = flow->code;
    flow->count = flow->at[place].count;
    memcpy(flow->stack, flow->at[place].held, (size_t)flow->count * sizeof *flow->stack);
    flow->cells = 0;
    for (int32_t i = 0; i < flow->count; i++)
        flow->cells += flow->stack[i].cells;
    while (!flow->is_wrong) {
        const struct krl_instruction *instruction = &code->body[place];
        code->depths[place] = flow->cells;
        apply(flow, instruction);
        if (flow->is_wrong)
            return;
        int32_t target = target_of(instruction);
        if (target >= 0) /* where a statement is left, its operands are forgotten */
            meet(flow, target, instruction->op == KRL_AT ? 0 : flow->count - (instruction->op == KRL_CASE));
        if (is_end(instruction->op))
            return;
        if (++place == code->length) {
            refuse(flow, "a code object ends without RETURN");
            return;
        }
        if (code->leads[place]) {
            meet(flow, place, flow->count);
            return;
        }
    }
}

/* Where an instruction goes on: the target, then the next one. */
static int after(const struct krl_code *code, int32_t place, int32_t *found)
{
    const struct krl_instruction *instruction = &code->body[place];
    int count = 0;
    if (target_of(instruction) >= 0)
        found[count++] = target_of(instruction);
    if (!is_end(instruction->op))
        found[count++] = place + 1;
    return count;
}

/* Nothing is called or asked before the first statement begins. */
static void check_start(struct flow *flow)
{
    const struct krl_code *code = flow->code;
    uint8_t *seen = krl_allot(&flow->scratch, (size_t)code->length, 1);
    int32_t count = 1, found[2];
    if (seen == NULL) {
        refuse(flow, "there is not enough memory for the check");
        return;
    }
    flow->todo[0] = 0;
    seen[0] = 1;
    while (count > 0) {
        int32_t place = flow->todo[--count];
        uint32_t op = code->body[place].op;
        if (op == KRL_CALL || op == KRL_ASK) {
            refuse(flow, "a statement has to begin before a call or a request");
            return;
        }
        if (op == KRL_LINE)
            continue;
        for (int i = after(code, place, found) - 1; i >= 0; i--)
            if (!seen[found[i]]) {
                seen[found[i]] = 1;
                flow->todo[count++] = found[i];
            }
    }
}

/* Every circle has a LINE or an ASK: without these, no instruction leads to itself. */
static void check_circles(struct flow *flow)
{
    enum { FRESH, OPEN, DONE };
    const struct krl_code *code = flow->code;
    uint8_t *state = krl_allot(&flow->scratch, (size_t)code->length, 2);
    if (state == NULL) {
        refuse(flow, "there is not enough memory for the check");
        return;
    }
    uint8_t *tried = state + code->length;
    for (int32_t start = 0; start < code->length; start++) {
        int32_t count = 1, found[2];
        if (code->depths[start] < 0 || state[start] != FRESH)
            continue;
        flow->todo[0] = start;
        state[start] = OPEN;
        while (count > 0) {
            int32_t place = flow->todo[count - 1];
            uint32_t op = code->body[place].op;
            int ways = op == KRL_LINE || op == KRL_ASK ? 0 : after(code, place, found);
            if (tried[place] == ways) {
                state[place] = DONE;
                count--;
                continue;
            }
            int32_t next = found[tried[place]++];
            if (state[next] == OPEN) {
                refuse(flow, "there is a circle without a statement");
                return;
            }
            if (state[next] == FRESH) {
                state[next] = OPEN;
                flow->todo[count++] = next;
            }
        }
    }
}

/* A condition only goes forwards, and changes nothing of the program. */
static void check_condition(struct flow *flow)
{
    const struct krl_code *code = flow->code;
    for (int32_t place = 0; place < code->length; place++) {
        uint32_t op = code->body[place].op;
        int32_t target = target_of(&code->body[place]);
        if (op == KRL_LINE || op == KRL_AT || op == KRL_PROCEED || op == KRL_STORE || op == KRL_STORE_DATA ||
            (target >= 0 && target <= place))
            refuse(flow, "a condition only goes forwards, and changes nothing");
    }
}

static int is_operand(const struct flow *flow, uint32_t kind, int32_t operand)
{
    const struct krl_program *program = flow->program;
    switch (kind) {
    case KRL_OPERAND_REAL: return krl_is_finite(krl_real_of_bits((uint32_t)operand));
    case KRL_OPERAND_BOOL: return operand == 0 || operand == 1;
    case KRL_OPERAND_CHAR: return operand >= 0 && operand <= 255;
    case KRL_OPERAND_COUNT: return operand >= 0;
    case KRL_OPERAND_LOCAL: return operand >= 0 && operand < flow->code->frame;
    case KRL_OPERAND_DATA: return operand >= 0 && operand < program->data_cells;
    case KRL_OPERAND_TYPE: return operand >= 0 && operand < program->type_count;
    case KRL_OPERAND_TEXT: return operand >= 0 && operand < program->text_count;
    case KRL_OPERAND_CODE: return operand >= 0 && operand < program->code_count;
    case KRL_OPERAND_ASK: return operand >= 0 && operand < program->ask_count;
    case KRL_OPERAND_BUILTIN: return operand >= 0 && operand < program->builtin_count;
    case KRL_OPERAND_FAULT: return operand >= 0 && operand < KRL_FAULT_COUNT;
    default: return 1; /* INT; LINE, which only Python uses; TARGET, which the reader has checked */
    }
}

static void check_operands(struct flow *flow)
{
    static const uint32_t kinds[] = {KRL_OPCODES(KINDS)};
    const struct krl_code *code = flow->code;
    for (int32_t place = 0; place < code->length; place++) {
        uint32_t packed = kinds[code->body[place].op];
        for (int i = 0; packed != 0; i++, packed >>= 8)
            if (!is_operand(flow, packed & 0xff, code->body[place].operands[i]))
                refuse(flow, "an operand names nothing");
        int32_t target = target_of(&code->body[place]);
        if (target >= 0)
            code->leads[target] = 1;
    }
}

static void check_code(struct flow *flow)
{
    struct krl_code *code = flow->code;
    size_t length = (size_t)code->length;
    flow->at = krl_allot(&flow->scratch, length, sizeof *flow->at);
    flow->todo = krl_allot(&flow->scratch, length + 1, sizeof *flow->todo);
    flow->stack = krl_allot(&flow->scratch, (size_t)code->stack + 1, sizeof *flow->stack);
    if (flow->at == NULL || flow->todo == NULL || flow->stack == NULL) {
        refuse(flow, "there is not enough memory for the check");
        return;
    }
    for (int32_t place = 0; place < code->length; place++)
        code->depths[place] = -1;
    check_operands(flow);
    code->leads[0] = 1;
    meet(flow, 0, 0);
    while (flow->todo_count > 0 && !flow->is_wrong)
        walk(flow, flow->todo[--flow->todo_count]);
    if (flow->is_wrong)
        return;
    if (code->kind == KRL_CONDITION) {
        check_condition(flow);
        return;
    }
    check_start(flow);
    check_circles(flow);
}

/* What an action or a condition belongs to, so that its references can be found in that frame. */
static int is_owned(const struct krl_program *program, const struct krl_code *code)
{
    if (code->kind == KRL_ROUTINE)
        return code->owner < 0 && code->capture_count == 0;
    if (code->owner < 0 || program->codes[code->owner].kind != KRL_ROUTINE)
        return 0;
    if (code->kind == KRL_CONDITION ? code->result != KRL_TYPE_BOOL : code->result >= 0)
        return 0;
    return code->capture_count == code->parameter_count;
}

int krl_verify(struct krl_program *program, struct krl_refusal *why)
{
    why->text[0] = 0;
    if (program->code_count == 0)
        return krl_refuse(why, "there is no code object");
    for (int32_t number = 0; number < program->code_count; number++) {
        struct krl_code *code = &program->codes[number];
        if (!is_owned(program, code) || code->length == 0)
            return krl_refuse(why, "a code object has no owner, or no instructions");
        code->depths = krl_allot(program, (size_t)code->length, sizeof *code->depths);
        code->leads = krl_allot(program, (size_t)code->length, sizeof *code->leads);
        if (code->depths == NULL || code->leads == NULL)
            return krl_refuse(why, "there is not enough memory for the check");
    }
    for (int32_t number = 0; number < program->code_count; number++) {
        struct flow flow = {0};
        flow.program = program;
        flow.code = &program->codes[number];
        flow.why = why;
        check_code(&flow);
        krl_free_program(&flow.scratch);
        if (flow.is_wrong)
            return 0;
    }
    return 1;
}
