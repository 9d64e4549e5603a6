/* Reads an image into a program. */
#ifndef KRL_READER_H
#define KRL_READER_H

#include "program/program.h"

/* Reads an image and copies what it needs. Returns 0 if there is not enough memory. */
int krl_read_image(struct krl_program *program, const uint8_t *image);

/* Returns the CRC-32 in the header of an image. */
uint32_t krl_checksum(const uint8_t *image);

#endif
