/* Translates stack instructions into register code.
 *
 * Each code object is walked once, with a virtual stack that describes the operand stack. Most
 * items are in place, that is in the register of their stack slot. But a variable, a constant or an
 * element of an array that is pushed stays where it is, and the step that uses the item reads it
 * from there.
 *
 * The walk keeps the order of all observable effects. An item that may still fault (a variable
 * without a value, a wrong index) is settled, that is put in place, before any step that faults in
 * another way, writes, or leaves. At jump targets all items are in place.
 *
 * A LINE does not become a step, unless LINE is traced: the next step carries it.
 *
 * This file has the walk, and virtual_stack.c the virtual stack. Instructions that need more than a
 * line are in translate_control_flow.c, translate_data_movement.c and translate_arithmetic.c.
 */
#include "translate.h"

#include <stdlib.h>

/* ---------------------------------------------------------------------------- instructions */

static void instruction(struct translator *at, int32_t place)
{
    const struct krl_instruction *now = &at->code->body[place];
    const int32_t *operands = now->operands;
    const struct krl_type *types = at->program->types;
    struct krl_step *step;
    switch ((enum krl_opcode)now->op) {
    case KRL_LINE: krl_line(at, place); break;
    case KRL_AT:
        krl_secure(at, at->height);
        krl_emit(at, KRL_STEP_AT)->b = place;
        break;
    case KRL_JUMP:
        krl_settle_all(at);
        krl_emit(at, KRL_STEP_JUMP)->d = operands[0];
        break;
    case KRL_JUMP_IF: krl_jump_on(at, 1, operands[0]); break;
    case KRL_JUMP_UNLESS: krl_jump_on(at, 0, operands[0]); break;
    case KRL_CASE: krl_choose(at, place); break;
    case KRL_CALL: krl_call_routine(at, place); break;
    case KRL_RETURN: case KRL_RETURN_VALUE: krl_leave(at, place); break;
    case KRL_ASK: krl_ask(at, &at->program->asks[operands[0]], place); break;
    case KRL_BUILTIN: krl_call_builtin(at, place); break;
    case KRL_PROCEED: case KRL_UNLINKED: krl_to_python(at, KRL_MATTER_INSTRUCTION, place); break;
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
    case KRL_DROP: /* a variable without a value still faults */
        krl_secure(at, at->height);
        at->height--;
        break;
    case KRL_LOAD_LOCAL: case KRL_LOAD_REF:
        krl_push(at, (struct virtual_value){VARIABLE, operands[0], 0, 0, 0, 0});
        break;
    case KRL_PASS_LOCAL:
        krl_emit(at, KRL_STEP_PASS)->b = operands[0];
        krl_push_result(at);
        break;
    case KRL_LOAD_VIEW:
        for (int32_t i = 0; i <= krl_slot_at(at->code, operands[0])->passed.dimensions; i++)
            krl_push(at, (struct virtual_value){VARIABLE, operands[0] + i, 0, 0, 0, 0});
        break;
    case KRL_PASS_VIEW: /* only the address may have no value: a missing view has sizes, too */
        krl_emit(at, KRL_STEP_PASS)->b = operands[0];
        krl_push_result(at);
        for (int32_t i = 1; i <= krl_slot_at(at->code, operands[0])->passed.dimensions; i++)
            krl_push(at, (struct virtual_value){VARIABLE, operands[0] + i, 0, 0, 0, 0});
        break;
    case KRL_LOAD_DATA: krl_load_data(at, operands[0]); break;
    case KRL_STORE_LOCAL: krl_store_local(at, operands[0]); break;
    case KRL_STORE_DATA: krl_store_data(at, operands[0]); break;
    case KRL_REF_LOCAL: krl_push(at, (struct virtual_value){ADDRESS, operands[0], 0, 0, 0, 0}); break;
    case KRL_REF_DATA: krl_push_constant(at, KRL_TAG_INT, operands[0]); break;
    case KRL_LOAD: krl_load(at); break;
    case KRL_STORE: krl_store(at); break;
    case KRL_MEMBER: krl_member(at, operands[0]); break;
    case KRL_INDEX: krl_row(at, operands[0], types[operands[0]].count); break;
    case KRL_INDEX_LOCAL: krl_element(at, 1, operands[0], operands[1]); break;
    case KRL_INDEX_DATA: krl_element(at, 0, operands[0], operands[1]); break;
    case KRL_ELEMENT_LOCAL: krl_element(at, 1, operands[0], operands[1]), krl_load(at); break;
    case KRL_ELEMENT_DATA: krl_element(at, 0, operands[0], operands[1]), krl_load(at); break;
    case KRL_INDEX_VIEW: krl_view_index(at, operands[0]); break;
    case KRL_VIEW: krl_view(at, &types[operands[0]]); break;
    case KRL_ROW: krl_row(at, operands[0], operands[1]); break;
    case KRL_ROW_VIEW: krl_row_of_view(at, operands[0], operands[1]); break;
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
    case KRL_SUB_INT: krl_subtraction(at); break;
    case KRL_MUL_INT: krl_binary(at, KRL_STEP_MUL_INT, KRL_STEP_MUL_INT_K, 1); break;
    case KRL_DIV_INT: krl_division(at); break;
    case KRL_NEG_INT: krl_unary(at, KRL_STEP_NEG_INT); break;
    case KRL_ADD_REAL: krl_binary(at, KRL_STEP_ADD_REAL, KRL_STEP_ADD_REAL_K, 1); break;
    case KRL_SUB_REAL: krl_binary(at, KRL_STEP_SUB_REAL, KRL_STEP_SUB_REAL_K, 0); break;
    case KRL_MUL_REAL: krl_binary(at, KRL_STEP_MUL_REAL, KRL_STEP_MUL_REAL_K, 1); break;
    case KRL_DIV_REAL: krl_quotient(at); break;
    case KRL_NEG_REAL: krl_unary(at, KRL_STEP_NEG_REAL); break;
    case KRL_EQ_INT: case KRL_NE_INT: case KRL_LT_INT: case KRL_GT_INT: case KRL_LE_INT: case KRL_GE_INT:
        krl_relation(at, KRL_STEP_EQ_INT, (int)now->op - KRL_EQ_INT);
        break;
    case KRL_EQ_REAL: case KRL_NE_REAL: case KRL_LT_REAL: case KRL_GT_REAL: case KRL_LE_REAL: case KRL_GE_REAL:
        krl_relation(at, KRL_STEP_EQ_REAL, (int)now->op - KRL_EQ_REAL);
        break;
    case KRL_EQ_BOOL: case KRL_EQ_ENUM: krl_relation(at, KRL_STEP_EQ_INT, 0); break;
    case KRL_NE_BOOL: case KRL_NE_ENUM: krl_relation(at, KRL_STEP_EQ_INT, 1); break;
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
    case KRL_CHAR_TO_INT: break; /* CHAR and INT have the same cells */
    case KRL_INT_TO_CHAR: krl_unary(at, KRL_STEP_INT_TO_CHAR); break;
    case KRL_ADD_CONSTANT:
        krl_push_constant(at, KRL_TAG_INT, operands[0]);
        krl_binary(at, KRL_STEP_ADD_INT, KRL_STEP_ADD_INT_K, 0);
        break;
    case KRL_UNLESS_EQ_INT: case KRL_UNLESS_NE_INT: case KRL_UNLESS_LT_INT:
    case KRL_UNLESS_GT_INT: case KRL_UNLESS_LE_INT: case KRL_UNLESS_GE_INT:
        krl_jump_unless(at, 0, (int)now->op - KRL_UNLESS_EQ_INT, operands[0]);
        break;
    case KRL_UNLESS_LT_REAL: case KRL_UNLESS_GT_REAL: case KRL_UNLESS_LE_REAL: case KRL_UNLESS_GE_REAL:
        krl_jump_unless(at, 1, 2 + (int)now->op - KRL_UNLESS_LT_REAL, operands[0]);
        break;
    case KRL_FOR_LOCAL: case KRL_FOR_DATA: krl_count_up(at, now); break;
    case KRL_TELL_LOCAL: case KRL_TELL_DATA: case KRL_TELL_REF: case KRL_TELL:
        if (at->machine->traced & KRL_TRACED_ASSIGN)
            krl_to_python(at, KRL_MATTER_INSTRUCTION, place);
        break;
    case KRL_TELL_BRANCH:
        if (at->machine->traced & KRL_TRACED_BRANCH)
            krl_to_python(at, KRL_MATTER_INSTRUCTION, place);
        break;
    case KRL_OPCODE_COUNT: break;
    }
}

/* ---------------------------------------------------------------------------- code objects */

/* Removes the last step if it is a jump to the instruction that follows. */
static void drop_jump(struct translator *at, int32_t target)
{
    int32_t *steps = at->routine->steps;
    if (at->is_wrong || target == 0 || at->count <= steps[0])
        return;
    const struct krl_step *last = &at->steps[at->count - 1];
    if (last->op != KRL_STEP_JUMP || last->d != target || last->statement >= 0)
        return;
    at->count--;
    for (int32_t place = target - 1; place >= 0 && (steps[place] < 0 || steps[place] > at->count); place--)
        if (steps[place] > at->count)
            steps[place] = at->count;
}

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
        if (code->is_target[place]) {
            if (is_reached) {
                krl_settle_all(at);
                if (at->line >= 0)
                    krl_emit(at, KRL_STEP_NOP);
            }
            drop_jump(at, place);
            at->height = 0;
            krl_push_places(at, code->depths[place]);
            at->line = at->result = -1;
            routine->steps[place] = at->count;
        }
        instruction(at, place);
        is_reached = !krl_ends(code->body[place].op);
    }
}

/* Replaces targets by distances in bytes. A target is an instruction or, if negative, the
 * complement of a step. TEXT skips the step for Python that follows it. */
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
            if (step->op == KRL_STEP_TEXT)
                step->d = 2 * (int32_t)sizeof *step;
            else if (KRL_IS_JUMP(step->op))
                step->d = ((step->d < 0 ? ~step->d : routine->steps[step->d]) - i) * (int32_t)sizeof *step;
        }
    }
}

int krl_translate(struct krl_machine *machine)
{
    struct translator at = {0};
    struct krl_program *program = &machine->program;
    int32_t most = 0;
    for (int32_t number = 0; number < program->code_count; number++)
        most = program->codes[number].stack > most ? program->codes[number].stack : most;
    at.machine = machine;
    at.program = program;
    at.stack = krl_allocate(program, (size_t)most + 8, sizeof *at.stack);
    at.capacity = 256;
    at.steps = malloc((size_t)at.capacity * sizeof *at.steps);
    at.array_capacity = 64;
    at.arrays = malloc((size_t)at.array_capacity * sizeof *at.arrays);
    machine->routines = krl_allocate(program, (size_t)program->code_count, sizeof *machine->routines);
    machine->steps = at.steps;
    machine->arrays = at.arrays;
    if (at.stack == NULL || machine->routines == NULL || at.steps == NULL || at.arrays == NULL)
        return 0;
    for (int32_t number = 0; number < program->code_count; number++) {
        const struct krl_code *body = &program->codes[number];
        struct krl_routine *routine = &machine->routines[number];
        routine->code = body;
        routine->frame = body->frame;
        routine->whole = body->frame + body->stack;
        for (int32_t i = 0; i < body->parameter_count; i++) {
            routine->received += body->slots[i].cells;
            routine->arguments += krl_stack_cells(&body->slots[i].passed);
        }
        if (body->owner >= 0 && body->capture_count > 0)
            machine->routines[body->owner].is_owner = 1;
        routine->steps = krl_allocate(program, (size_t)body->length, sizeof *routine->steps);
        if (routine->steps == NULL)
            return 0;
    }
    for (int32_t number = 0; number < program->code_count && !at.is_wrong; number++) {
        at.code = &program->codes[number];
        at.routine = &machine->routines[number];
        code(&at);
    }
    machine->steps = at.steps;
    machine->step_count = at.count;
    machine->arrays = at.arrays;
    machine->array_count = at.array_count;
    if (at.is_wrong)
        return 0;
    land(machine);
    krl_thread(machine->steps, machine->step_count);
    return 1;
}
