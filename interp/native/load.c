/* Loads an image into a machine: reads and translates it. */
#include "load.h"

#include "image/reader.h"
#include "translator/translate.h"

/* Returns 0 if there is not a depth for each instruction, or no memory for them. */
static int give_depths(struct krl_program *program, const int32_t *depths, size_t count)
{
    size_t needed = 0;
    for (int32_t number = 0; number < program->code_count; number++)
        needed += (size_t)program->codes[number].length;
    int32_t *kept = count == needed ? krl_allocate(program, count, sizeof *kept) : NULL;
    if (kept == NULL)
        return 0;
    memcpy(kept, depths, count * sizeof *kept);
    for (int32_t number = 0; number < program->code_count; number++) {
        program->codes[number].depths = kept;
        kept += program->codes[number].length;
    }
    return 1;
}

int krl_load_image(struct krl_machine *machine, const uint8_t *image, const int32_t *depths, size_t count,
                   int traced)
{
    memset(machine, 0, sizeof *machine);
    machine->traced = traced;
    machine->left = 1;
    machine->checksum = krl_checksum(image);
    if (!krl_read_image(&machine->program, image))
        return 0;
    if (!give_depths(&machine->program, depths, count) || !krl_translate(machine)) {
        krl_unload(machine);
        return 0;
    }
    for (int32_t number = 0; number < machine->program.code_count; number++) {
        const struct krl_routine *routine = &machine->routines[number];
        int32_t stack = routine->whole - routine->frame;
        machine->most_whole = routine->whole > machine->most_whole ? routine->whole : machine->most_whole;
        machine->most_stack = stack > machine->most_stack ? stack : machine->most_stack;
    }
    return 1;
}
