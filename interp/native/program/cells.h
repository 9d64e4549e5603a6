/* Cells: the unit of memory for variables, references and the operand stack.
 *
 * A cell has 64 bits. The lower half is the value (an INT, the bits of a REAL in single precision,
 * 0 or 1 for a BOOL, a character code, the index of a constant, an address), the upper half its
 * tag. A cell without a value is zero.
 */
#ifndef KRL_CELLS_H
#define KRL_CELLS_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#if FLT_EVAL_METHOD != 0
#error "REAL needs arithmetic without excess precision: on x86, compile for SSE2"
#endif

typedef uint64_t krl_cell;

/* CHAR, constants of enumerations and addresses have the tag INT, as in the Python machine. */
enum krl_tag { KRL_TAG_NONE = 0, KRL_TAG_INT = 1, KRL_TAG_REAL = 2, KRL_TAG_BOOL = 3 };

#define KRL_NOTHING ((krl_cell)0)

static inline krl_cell krl_tagged(enum krl_tag tag, uint32_t bits)
{
    return (krl_cell)tag << 32 | bits;
}

static inline enum krl_tag krl_tag_of(krl_cell cell)
{
    return (enum krl_tag)(cell >> 32);
}

static inline krl_cell krl_of_int(int32_t value)
{
    return krl_tagged(KRL_TAG_INT, (uint32_t)value);
}

static inline krl_cell krl_of_bool(int value)
{
    return krl_tagged(KRL_TAG_BOOL, value != 0);
}

static inline krl_cell krl_of_real(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return krl_tagged(KRL_TAG_REAL, bits);
}

static inline int32_t krl_int_in(krl_cell cell)
{
    return (int32_t)(uint32_t)cell;
}

static inline float krl_real_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline float krl_real_in(krl_cell cell)
{
    return krl_real_of_bits((uint32_t)cell);
}

/* Neither infinite nor NaN. */
static inline int krl_is_finite(float value)
{
    return fabsf(value) <= FLT_MAX;
}

#endif
