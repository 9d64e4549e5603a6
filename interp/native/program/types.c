/* The layout of types: which part of a structure or an array lies at an offset. */
#include "program.h"

int krl_is_plain(const struct krl_program *program, int32_t type)
{
    return program->types[type].form <= KRL_ENUMERATION;
}

/* Returns the member of a structure that contains a cell. */
static const struct krl_member *member_at(const struct krl_type *type, int32_t offset)
{
    int32_t low = 0, high = type->count - 1;
    while (low < high) {
        int32_t middle = (low + high + 1) / 2;
        if (type->members[middle].offset <= offset)
            low = middle;
        else
            high = middle - 1;
    }
    return &type->members[low];
}

int32_t krl_kind_at(const struct krl_program *program, int32_t number, int32_t offset)
{
    while (!krl_is_plain(program, number)) {
        const struct krl_type *type = &program->types[number];
        if (type->form == KRL_ARRAY) {
            number = type->element;
            offset %= program->types[number].size;
        } else {
            const struct krl_member *member = member_at(type, offset);
            number = member->type;
            offset -= member->offset;
        }
    }
    return number;
}

int krl_is_word_of(const struct krl_program *program, int32_t word, int32_t type)
{
    switch (type) {
    case KRL_TYPE_INT:
        return 1;
    case KRL_TYPE_REAL:
        return krl_is_finite(krl_real_of_bits((uint32_t)word));
    case KRL_TYPE_BOOL:
        return word == 0 || word == 1;
    case KRL_TYPE_CHAR:
        return word >= 0 && word <= 255;
    default:
        return word >= 0 && word < program->types[type].count;
    }
}

krl_cell krl_cell_of_word(int32_t word, int32_t type)
{
    enum krl_tag tag = type == KRL_TYPE_REAL   ? KRL_TAG_REAL
                       : type == KRL_TYPE_BOOL ? KRL_TAG_BOOL
                                               : KRL_TAG_INT;
    return krl_tagged(tag, (uint32_t)word);
}

const struct krl_variable *krl_data_at(const struct krl_program *program, int32_t address)
{
    int32_t low = 0, high = program->data_count - 1;
    if (address < 0 || address >= program->data_cells)
        return NULL;
    while (low < high) {
        int32_t middle = (low + high + 1) / 2;
        if (program->data[middle].address <= address)
            low = middle;
        else
            high = middle - 1;
    }
    return &program->data[low];
}

const struct krl_slot *krl_slot_at(const struct krl_code *code, int32_t offset)
{
    int32_t low = 0, high = code->slot_count - 1;
    if (offset < 0 || offset >= code->frame)
        return NULL;
    while (low < high) {
        int32_t middle = (low + high + 1) / 2;
        if (code->slots[middle].offset <= offset)
            low = middle;
        else
            high = middle - 1;
    }
    return &code->slots[low];
}
