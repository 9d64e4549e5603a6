/* Loads an image into a machine: reads, verifies and translates it. */
#include "load.h"

#include "image/reader.h"
#include "translator/translate.h"
#include "verifier/verifier.h"

int krl_load_image(struct krl_machine *machine, const uint8_t *image, size_t length, int traced,
                   struct krl_refusal *why)
{
    memset(machine, 0, sizeof *machine);
    machine->traced = traced;
    machine->left = 1;
    machine->checksum = krl_checksum(image, length);
    if (!krl_read_image(&machine->program, image, length, why))
        return 0;
    if (!krl_verify(&machine->program, why) || !krl_translate(machine, why)) {
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
