/* The verifier: checks the rules that the machine relies on, so that no image can do harm.
 *
 * It checks what interp/bytecode/verifier/verify.py checks, as far as memory safety and bounded
 * time depend on it: what is on the stack at every instruction, that references and views refer to
 * cells of their type, that no path runs off the end, and that every cycle has a LINE or an ASK.
 * Names, and whether the parts of a request match its fields, are left to the verifier in Python: C
 * does not use them.
 *
 * This file has the rules for whole code objects, and the walk along their control flow;
 * stack_effects.c has the stack effect of each instruction.
 */
#include "verifier.h"

/* The maximum number of items in all stacks that are stored for the targets of a code object. */
enum { MOST_REMEMBERED = 1 << 23 };

/* ---------------------------------------------------------------------------- operands */

/* The kinds of the operands of each instruction, a byte each. */
static const uint32_t kinds[] = {
#define KINDS(name, count, kinds) kinds,
    KRL_OPCODES(KINDS)
#undef KINDS
};

static int is_operand(const struct flow *flow, uint32_t kind, int32_t operand)
{
    switch (kind) {
    case KRL_OPERAND_REAL: return krl_is_finite(krl_real_of_bits((uint32_t)operand));
#include "operand_ranges.gen.h"
    default: return 1; /* INT; LINE, which only Python uses; TARGET, which the reader checks */
    }
}

/* Returns the target of an instruction, or -1; no instruction has more than one. */
static int32_t target_of(const struct krl_instruction *instruction)
{
    uint32_t packed = kinds[instruction->op];
    for (int place = 0; packed != 0; place++, packed >>= 8)
        if ((packed & 0xff) == KRL_OPERAND_TARGET)
            return instruction->operands[place];
    return -1;
}

/* Checks that every operand refers to something, and marks the targets. */
static void check_operands(struct flow *flow)
{
    const struct krl_code *code = flow->code;
    for (int32_t place = 0; place < code->length; place++) {
        uint32_t packed = kinds[code->body[place].op];
        for (int i = 0; packed != 0; i++, packed >>= 8)
            if (!is_operand(flow, packed & 0xff, code->body[place].operands[i]))
                krl_refuse_code(flow, "an operand is out of range");
        int32_t target = target_of(&code->body[place]);
        if (target >= 0)
            code->is_target[target] = 1;
    }
}

/* ---------------------------------------------------------------------------- the stack */

/* Merges the first `count` items of the stack into an instruction. The first path stores its stack
 * there and schedules the instruction; all others must have the same stack. */
static void merge(struct flow *flow, int32_t place, int32_t count)
{
    struct remembered *there = &flow->at[place];
    if (flow->is_wrong)
        return;
    if (there->items == NULL) {
        flow->remembered += count + 1;
        there->items = flow->remembered > MOST_REMEMBERED
                          ? NULL
                          : krl_allocate(&flow->scratch, (size_t)count + 1, sizeof *there->items);
        if (there->items == NULL) {
            krl_refuse_code(flow, "the code object is too large to be checked");
            return;
        }
        memcpy(there->items, flow->stack, (size_t)count * sizeof *there->items);
        there->count = count;
        flow->todo[flow->todo_count++] = place;
        return;
    }
    int differs = there->count != count;
    for (int32_t i = 0; i < count && !differs; i++)
        differs = !krl_is_same(there->items[i], flow->stack[i]);
    if (differs)
        krl_refuse_code(flow, "paths meet with different stacks");
}

/* Walks from an instruction to the end of the path or the next target. */
static void walk(struct flow *flow, int32_t place)
{
    const struct krl_code *code = flow->code;
    flow->count = flow->at[place].count;
    memcpy(flow->stack, flow->at[place].items, (size_t)flow->count * sizeof *flow->stack);
    flow->cells = 0;
    for (int32_t i = 0; i < flow->count; i++)
        flow->cells += flow->stack[i].cells;
    while (!flow->is_wrong) {
        const struct krl_instruction *instruction = &code->body[place];
        code->depths[place] = flow->cells;
        krl_apply(flow, instruction);
        if (flow->is_wrong)
            return;
        int32_t target = target_of(instruction);
        if (target >= 0) /* AT ends a statement early, which drops its operands; a CASE that jumps pops its value */
            merge(flow, target, instruction->op == KRL_AT ? 0 : flow->count - (instruction->op == KRL_CASE));
        if (krl_ends(instruction->op))
            return;
        if (++place == code->length) {
            krl_refuse_code(flow, "the code object ends without RETURN");
            return;
        }
        if (code->is_target[place]) {
            merge(flow, place, flow->count);
            return;
        }
    }
}

/* ---------------------------------------------------------------------------- control flow */

/* Stores the successors of an instruction, the target before the next one, and returns their
 * number. */
static int successors(const struct krl_code *code, int32_t place, int32_t *found)
{
    const struct krl_instruction *instruction = &code->body[place];
    int count = 0;
    if (target_of(instruction) >= 0)
        found[count++] = target_of(instruction);
    if (!krl_ends(instruction->op))
        found[count++] = place + 1;
    return count;
}

/* Checks that no path has a CALL or an ASK before its first LINE. */
static void check_start(struct flow *flow)
{
    const struct krl_code *code = flow->code;
    uint8_t *seen = krl_allocate(&flow->scratch, (size_t)code->length, 1);
    int32_t count = 1, found[2];
    if (seen == NULL) {
        krl_refuse_code(flow, "there is not enough memory for the check");
        return;
    }
    flow->todo[0] = 0;
    seen[0] = 1;
    while (count > 0) {
        int32_t place = flow->todo[--count];
        uint32_t op = code->body[place].op;
        if (op == KRL_CALL || op == KRL_ASK) {
            krl_refuse_code(flow, "a LINE is required before a call or a request");
            return;
        }
        if (op == KRL_LINE)
            continue;
        for (int i = successors(code, place, found) - 1; i >= 0; i--)
            if (!seen[found[i]]) {
                seen[found[i]] = 1;
                flow->todo[count++] = found[i];
            }
    }
}

/* Checks that every cycle has a LINE or an ASK: a depth-first search that stops at these must find
 * no edge to an instruction on the path. */
static void check_cycles(struct flow *flow)
{
    enum { UNVISITED, ON_PATH, DONE };
    const struct krl_code *code = flow->code;
    uint8_t *state = krl_allocate(&flow->scratch, (size_t)code->length, 2);
    if (state == NULL) {
        krl_refuse_code(flow, "there is not enough memory for the check");
        return;
    }
    uint8_t *taken = state + code->length;
    for (int32_t start = 0; start < code->length; start++) {
        int32_t count = 1, found[2];
        if (code->depths[start] < 0 || state[start] != UNVISITED)
            continue;
        flow->todo[0] = start;
        state[start] = ON_PATH;
        while (count > 0) {
            int32_t place = flow->todo[count - 1];
            uint32_t op = code->body[place].op;
            int edges = op == KRL_LINE || op == KRL_ASK ? 0 : successors(code, place, found);
            if (taken[place] == edges) {
                state[place] = DONE;
                count--;
                continue;
            }
            int32_t next = found[taken[place]++];
            if (state[next] == ON_PATH) {
                krl_refuse_code(flow, "a cycle without a LINE or an ASK");
                return;
            }
            if (state[next] == UNVISITED) {
                state[next] = ON_PATH;
                flow->todo[count++] = next;
            }
        }
    }
}

/* Checks that a condition has forward jumps only, and changes nothing of the program. */
static void check_condition(struct flow *flow)
{
    const struct krl_code *code = flow->code;
    for (int32_t place = 0; place < code->length; place++) {
        uint32_t op = code->body[place].op;
        int32_t target = target_of(&code->body[place]);
        if (krl_changes(op))
            krl_refuse_code(flow, "a condition cannot change anything");
        else if (target >= 0 && target <= place)
            krl_refuse_code(flow, "a condition can only jump forwards");
    }
}

/* ---------------------------------------------------------------------------- code objects */

static void check_code(struct flow *flow)
{
    struct krl_code *code = flow->code;
    size_t length = (size_t)code->length;
    flow->at = krl_allocate(&flow->scratch, length, sizeof *flow->at);
    flow->todo = krl_allocate(&flow->scratch, length + 1, sizeof *flow->todo);
    flow->stack = krl_allocate(&flow->scratch, (size_t)code->stack + 1, sizeof *flow->stack);
    if (flow->at == NULL || flow->todo == NULL || flow->stack == NULL) {
        krl_refuse_code(flow, "there is not enough memory for the check");
        return;
    }
    for (int32_t place = 0; place < code->length; place++)
        code->depths[place] = -1;
    check_operands(flow);
    code->is_target[0] = 1;
    merge(flow, 0, 0);
    while (flow->todo_count > 0 && !flow->is_wrong)
        walk(flow, flow->todo[--flow->todo_count]);
    if (flow->is_wrong)
        return;
    if (code->kind == KRL_CONDITION) {
        check_condition(flow);
        return;
    }
    check_start(flow);
    check_cycles(flow);
}

/* Whether the owner is valid. A routine has none and captures nothing. Actions and conditions
 * belong to a routine, and their parameters are its captured variables. */
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
        code->depths = krl_allocate(program, (size_t)code->length, sizeof *code->depths);
        code->is_target = krl_allocate(program, (size_t)code->length, sizeof *code->is_target);
        if (code->depths == NULL || code->is_target == NULL)
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
