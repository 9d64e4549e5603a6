#ifndef KRL_LOAD_H
#define KRL_LOAD_H

#include "vm/machine.h"

/* Loads an image. 0 where it is refused. */
int krl_load_image(struct krl_machine *machine, const uint8_t *image, size_t length, int traced,
                   struct krl_refusal *why);

#endif
