/* Reads the code objects of an image: the layout of their frames, and their instructions. */
#include "reader.h"

struct shape {
    uint32_t operands;
    uint32_t kinds;
};
static const struct shape shapes[] = {
#define SHAPE(name, count, kinds) {count, kinds},
    KRL_OPCODES(SHAPE)
#undef SHAPE
};

static void read_slots(struct reader *reader, struct krl_code *code)
{
    const struct krl_type *types = reader->program->types;
    const uint8_t *start = reader->next;
    uint32_t left = reader->left;
    /* Two passes: the number of slots is known only when the parameters and captures have been
     * read. */
    struct krl_slot *slots = NULL;
    for (int pass = 0; pass < 2 && !reader->is_wrong; pass++) {
        reader->next = start;
        reader->left = left;
        int32_t parameters = krl_read_count(reader), offset = 0, number = 0;
        for (; number < parameters && !reader->is_wrong; number++) {
            krl_read_string(reader);
            struct krl_passed passed = krl_read_passed(reader);
            int32_t cells = passed.mode == KRL_BY_VALUE ? types[passed.type].size : krl_stack_cells(&passed);
            if (slots != NULL)
                slots[number] = (struct krl_slot){passed, 0, offset, cells};
            offset += cells;
            if (offset > KRL_MAX_CELLS)
                krl_refuse_image(reader, "a frame has too many cells");
        }
        code->capture_count = krl_read_count(reader);
        for (int32_t i = 0; i < code->capture_count && !reader->is_wrong; i++)
            krl_read_word(reader);
        int32_t locals = krl_read_count(reader);
        for (int32_t i = 0; i < locals && !reader->is_wrong; i++, number++) {
            krl_read_string(reader);
            struct krl_passed passed = {KRL_BY_VALUE, krl_read_type_number(reader), 0};
            int32_t cells = types[passed.type].size;
            if (slots != NULL)
                slots[number] = (struct krl_slot){passed, 1, offset, cells};
            offset += cells;
            if (offset > KRL_MAX_CELLS)
                krl_refuse_image(reader, "a frame has too many cells");
        }
        if (pass == 0)
            slots = krl_allocate_read(reader, number, sizeof *slots);
        code->parameter_count = parameters;
        code->slot_count = number;
        code->frame = offset;
    }
    code->slots = slots;
    if (reader->program->data_cells + code->frame > KRL_MAX_CELLS)
        krl_refuse_image(reader, "the data lists and a frame have too many cells");
}

/* Reads the instructions. Targets are word offsets in the image, and become indices of
 * instructions. */
static void read_body(struct reader *reader, struct krl_code *code)
{
    int32_t words = krl_read_count(reader), count = 0;
    const uint8_t *bytes = reader->next;
    int32_t *numbers = krl_allocate_read(reader, words, sizeof *numbers);
    code->body = krl_allocate_read(reader, words, sizeof *code->body);
    code->is_target = krl_allocate_read(reader, words, sizeof *code->is_target);
    if (reader->is_wrong)
        return;
    code->is_target[0] = 1;
    for (int32_t i = 0; i < words; i++)
        numbers[i] = -1;
    for (int32_t place = 0; place < words && !reader->is_wrong; count++) {
        struct krl_instruction *instruction = &code->body[count];
        instruction->op = krl_read_choice(reader, KRL_OPCODE_COUNT);
        numbers[place] = count;
        place += 1 + (int32_t)shapes[instruction->op].operands;
        if (place > words) {
            krl_refuse_image(reader, "the image is damaged: the last instruction is incomplete");
            return;
        }
        for (uint32_t i = 0; i < shapes[instruction->op].operands; i++)
            instruction->operands[i] = (int32_t)krl_read_word(reader);
    }
    code->length = count;
    reader->next = bytes + 4 * (size_t)words;
    for (int32_t i = 0; i < count; i++)
        for (uint32_t j = 0; j < shapes[code->body[i].op].operands; j++)
            if ((shapes[code->body[i].op].kinds >> 8 * j & 0xff) == KRL_OPERAND_TARGET) {
                int32_t target = code->body[i].operands[j];
                if (target < 0 || target >= words || numbers[target] < 0) {
                    krl_refuse_image(reader, "the image is damaged: a jump target is not an instruction");
                    return;
                }
                code->body[i].operands[j] = numbers[target];
                code->is_target[numbers[target]] = 1;
            }
}

static void read_code(struct reader *reader, struct krl_code *code)
{
    const struct krl_program *program = reader->program;
    krl_read_string(reader);
    krl_read_string(reader);
    code->kind = (enum krl_code_kind)krl_read_choice(reader, 3);
    krl_read_word(reader);
    code->owner = krl_read_optional(reader, program->code_count);
    if (reader->is_wrong)
        return;
    read_slots(reader, code);
    code->result = krl_read_optional(reader, program->type_count);
    code->stack = (int32_t)krl_read_choice(reader, 1 << 16);
    if (reader->is_wrong)
        return;
    if (code->result >= 0 && !krl_is_plain(program, code->result))
        krl_refuse_image(reader, "a result must have one cell");
    read_body(reader, code);
}

void krl_read_codes(struct reader *reader)
{
    struct krl_program *program = reader->program;
    int32_t count = krl_read_count(reader);
    program->codes = krl_allocate_read(reader, count, sizeof *program->codes);
    program->code_count = count;
    for (int32_t i = 0; i < count && !reader->is_wrong; i++)
        read_code(reader, &program->codes[i]);
}
