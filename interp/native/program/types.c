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

krl_cell krl_cell_of_word(int32_t word, int32_t type)
{
    enum krl_tag tag = type == KRL_TYPE_REAL   ? KRL_TAG_REAL
                       : type == KRL_TYPE_BOOL ? KRL_TAG_BOOL
                                               : KRL_TAG_INT;
    return krl_tagged(tag, (uint32_t)word);
}

const struct krl_slot *krl_slot_at(const struct krl_code *code, int32_t offset)
{
    int32_t low = 0, high = code->slot_count - 1;
    while (low < high) {
        int32_t middle = (low + high + 1) / 2;
        if (code->slots[middle].offset <= offset)
            low = middle;
        else
            high = middle - 1;
    }
    return &code->slots[low];
}
