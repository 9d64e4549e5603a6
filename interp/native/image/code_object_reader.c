/* Reads the code objects of an image: the layout of their frames, and their instructions. */
#include "reader.h"

struct shape {
    int32_t operands;
    int32_t target; /* which operand is the target of a jump, or -1 */
};
static const struct shape shapes[] = {
#define SHAPE(name, count, target) {count, target},
    KRL_OPCODES(SHAPE)
#undef SHAPE
};

static void add_slot(struct krl_slot *slots, struct krl_code *code, struct krl_passed passed, int is_local,
                     const struct krl_type *types)
{
    int32_t cells = passed.mode == KRL_BY_VALUE ? types[passed.type].size : krl_stack_cells(&passed);
    slots[code->slot_count++] = (struct krl_slot){passed, is_local, code->frame, cells};
    code->frame += cells;
}

static void read_slots(struct reader *reader, struct krl_code *code)
{
    const struct krl_type *types = reader->program->types;
    code->parameter_count = krl_read_word(reader);
    const uint8_t *parameters = reader->next;
    krl_skip(reader, 4 * code->parameter_count);
    code->capture_count = krl_read_word(reader);
    krl_skip(reader, code->capture_count);
    int32_t locals = krl_read_word(reader);
    const uint8_t *first_local = reader->next;
    struct krl_slot *slots = krl_allocate_read(reader, code->parameter_count + locals, sizeof *slots);
    reader->next = parameters;
    for (int32_t i = 0; i < code->parameter_count; i++) {
        krl_skip(reader, 1); /* its name */
        add_slot(slots, code, krl_read_passed(reader), 0, types);
    }
    reader->next = first_local;
    for (int32_t i = 0; i < locals; i++) {
        krl_skip(reader, 1); /* its name */
        struct krl_passed passed = {KRL_BY_VALUE, krl_read_word(reader), 0};
        add_slot(slots, code, passed, 1, types);
    }
    code->slots = slots;
}

/* Reads the instructions. Targets are word offsets in the image, and become indices of
 * instructions. */
static void read_body(struct reader *reader, struct krl_code *code)
{
    int32_t words = krl_read_word(reader);
    int32_t *numbers = krl_allocate_read(reader, words, sizeof *numbers);
    code->body = krl_allocate_read(reader, words, sizeof *code->body);
    code->is_target = krl_allocate_read(reader, words, sizeof *code->is_target);
    for (int32_t place = 0; place < words; code->length++) {
        struct krl_instruction *instruction = &code->body[code->length];
        instruction->op = (uint32_t)krl_read_word(reader);
        numbers[place] = code->length;
        place += 1 + shapes[instruction->op].operands;
        for (int32_t i = 0; i < shapes[instruction->op].operands; i++)
            instruction->operands[i] = krl_read_word(reader);
    }
    code->is_target[0] = 1;
    for (int32_t i = 0; i < code->length; i++)
        if (shapes[code->body[i].op].target >= 0) {
            int32_t *target = &code->body[i].operands[shapes[code->body[i].op].target];
            *target = numbers[*target];
            code->is_target[*target] = 1;
        }
}

static void read_code(struct reader *reader, struct krl_code *code)
{
    krl_skip(reader, 2); /* name and file */
    code->kind = (enum krl_code_kind)krl_read_word(reader);
    krl_skip(reader, 1); /* its line */
    code->owner = krl_read_optional(reader);
    read_slots(reader, code);
    code->result = krl_read_optional(reader);
    code->stack = krl_read_word(reader);
    read_body(reader, code);
}

void krl_read_codes(struct reader *reader)
{
    struct krl_program *program = reader->program;
    program->code_count = krl_read_word(reader);
    program->codes = krl_allocate_read(reader, program->code_count, sizeof *program->codes);
    for (int32_t i = 0; i < program->code_count; i++)
        read_code(reader, &program->codes[i]);
}
