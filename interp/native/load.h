#ifndef KRL_LOAD_H
#define KRL_LOAD_H

#include "vm/machine.h"

/* Reads and translates a verified image. `depths` has the number of cells on the stack before each
 * of its `count` instructions, or -1 for an unreachable one. Nothing is referred to later.
 * `traced` is a set of `enum krl_traced`. Returns 0, with nothing allocated, if there is not enough
 * memory, or a depth for each instruction. Before it runs, the machine needs memory: see
 * krl_give_memory. Release it with krl_unload. */
int krl_load_image(struct krl_machine *machine, const uint8_t *image, const int32_t *depths, size_t count,
                   int traced);

#endif
