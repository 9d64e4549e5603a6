/* The layout of types: which part of a structure or an array lies at an offset. */
#include "program.h"

int krl_is_plain(const struct krl_program *program, int32_t type)
{
    return program->types[type].form <= KRL_ENUMERATION;
}

/* A part of a type, and the offset in it that is searched for. If the first `skipped` dimensions of
 * an array have an index, the part is a row of it. */
struct part {
    int32_t type;
    int32_t skipped;
    int32_t offset;
};

static int32_t row_size(const struct krl_program *program, const struct krl_type *array, int32_t from)
{
    int32_t size = program->types[array->element].size;
    for (int32_t dimension = from; dimension < array->count; dimension++)
        size *= array->sizes[dimension]; /* no overflow: at most the size of the array */
    return size;
}

/* Descends to the direct part that contains the offset. Returns 0 if the type has no parts. */
static int step(const struct krl_program *program, struct part *part)
{
    const struct krl_type *type = &program->types[part->type];
    if (type->form == KRL_ARRAY) {
        part->offset %= row_size(program, type, ++part->skipped);
        if (part->skipped == type->count) {
            part->type = type->element;
            part->skipped = 0;
        }
        return 1;
    }
    if (type->form != KRL_STRUCTURE)
        return 0;
    int32_t low = 0, high = type->count - 1;
    while (low < high) {
        int32_t middle = (low + high + 1) / 2;
        if (type->members[middle].offset <= part->offset)
            low = middle;
        else
            high = middle - 1;
    }
    part->offset -= type->members[low].offset;
    part->type = type->members[low].type;
    return 1;
}

int32_t krl_kind_at(const struct krl_program *program, int32_t type, int32_t offset)
{
    struct part part = {type, 0, offset};
    while (step(program, &part))
        ;
    return part.type;
}

static int is_same(const struct krl_program *program, const struct part *part, int32_t wanted)
{
    if (part->skipped == 0 && part->type == wanted)
        return 1;
    const struct krl_type *left = &program->types[part->type], *right = &program->types[wanted];
    if (left->form != KRL_ARRAY || right->form != KRL_ARRAY || left->element != right->element ||
        left->count - part->skipped != right->count)
        return 0;
    for (int32_t dimension = 0; dimension < right->count; dimension++)
        if (left->sizes[part->skipped + dimension] != right->sizes[dimension])
            return 0;
    return 1;
}

int krl_has_part(const struct krl_program *program, int32_t whole, int32_t offset, int32_t wanted)
{
    struct part part = {whole, 0, offset};
    if (offset < 0 || offset >= program->types[whole].size)
        return 0;
    do {
        if (part.offset == 0 && is_same(program, &part, wanted))
            return 1;
    } while (step(program, &part));
    return 0;
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
