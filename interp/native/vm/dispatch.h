/* Macros for the steps of the interpreter; only for run.c.
 *
 * If the compiler has labels as values, the code is threaded: each step jumps directly to the next
 * one. Otherwise, or with KRL_SWITCH, there is one switch. Each step has two entries: one begins a
 * statement first.
 *
 * The macros use the variables and labels of the function in run.c: the step `pc`, the frame `fp`,
 * all `cells`, `left`, `statement`, `fault`.
 */
#ifndef KRL_DISPATCH_H
#define KRL_DISPATCH_H

#include "steps.h"

#if defined(__GNUC__) && !defined(KRL_SWITCH)
#define KRL_THREADED 1
#else
#define KRL_THREADED 0
#endif

/* ---------------------------------------------------------------------------- dispatch */

#define BEGIN_STATEMENT()                                                                          \
    do {                                                                                           \
        if (UNLIKELY(left <= 1))                                                                   \
            goto wait;                                                                             \
        left--;                                                                                    \
        statement = pc->statement;                                                                 \
    } while (0)

#if KRL_THREADED
#define STEP(name)                                                                                 \
    begin_##name : BEGIN_STATEMENT();                                                              \
    do_##name:
#define GO() goto *pc->handler
#else
#define STEP(name)                                                                                 \
    case 2 * KRL_STEP_##name + 1:                                                                  \
        BEGIN_STATEMENT();                                                                         \
        /* fall through */                                                                         \
    case 2 * KRL_STEP_##name:
#define GO() goto dispatch
#endif
#define NEXT()                                                                                     \
    do {                                                                                           \
        pc++;                                                                                      \
        GO();                                                                                      \
    } while (0)
#define JUMP()                                                                                     \
    do {                                                                                           \
        pc = (const struct krl_step *)((const char *)pc + pc->d);                                  \
        GO();                                                                                      \
    } while (0)

#define A fp[pc->a]
#define B fp[pc->b]

/* An interpreter step whose effect is in steps.h. */
#define ORDINARY(name)                                                                             \
    STEP(name)                                                                                     \
    {                                                                                              \
        fault = krl_step_##name(machine, cells, fp, fp, pc);                                         \
        if (fault == KRL_GO_NEXT)                                                                  \
            NEXT();                                                                                \
        if (fault == KRL_GO_JUMP)                                                                  \
            JUMP();                                                                                \
        goto failed;                                                                               \
    }

#endif
