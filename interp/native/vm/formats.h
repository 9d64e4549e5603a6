/* The predefined functions SWRITE and SREAD. */
#ifndef KRL_FORMATS_H
#define KRL_FORMATS_H

#include "texts.h"

/* Whether C can write an argument with SWRITE; change it with SREAD; use it as STATE, the second
 * argument of both. */
int krl_can_format(const struct krl_program *program, const struct krl_part *part);
int krl_can_scan(const struct krl_program *program, const struct krl_part *part);
int krl_is_state(const struct krl_program *program, const struct krl_part *part);

/* Executes SWRITE or SREAD. Returns 0, with nothing done, if Python has to do it. */
int krl_call_format(const struct krl_text_call *call, int is_writing);

#endif
