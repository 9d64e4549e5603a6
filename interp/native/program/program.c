/* The arena that holds a program. */
#include "program.h"

#include <stdlib.h>

struct krl_block {
    struct krl_block *before;
    krl_cell bytes[];
};

void *krl_allocate(struct krl_program *program, size_t count, size_t size)
{
    if (count > (SIZE_MAX / 2 - sizeof(struct krl_block)) / size)
        return NULL;
    struct krl_block *block = calloc(1, sizeof *block + count * size);
    if (block == NULL)
        return NULL;
    block->before = program->memory;
    program->memory = block;
    return block->bytes;
}

void krl_free_program(struct krl_program *program)
{
    while (program->memory != NULL) {
        struct krl_block *block = program->memory;
        program->memory = block->before;
        free(block);
    }
    memset(program, 0, sizeof *program);
}
