/* The machine: a program made ready to run, and what it works on while it runs.
 *
 * Code objects are translated, when they are loaded, from instructions on a stack into steps on
 * registers (translate.c). A register is a cell counted from the first one of the frame: its
 * variables come first, then the places of the stack of operands, so that arguments lie where the
 * callee's frame begins. Nothing is allotted while the machine runs.
 */
#ifndef KRL_MACHINE_H
#define KRL_MACHINE_H

#include "program/program.h"

/* A step: what it is, its operands, and the statement that begins with it, if one does. */
struct krl_step {
    const void *handler; /* where the interpreter goes on: op as an address, in compilers that can */
    int32_t a, b, c, d;  /* of a jump d is the target, in bytes from this step on */
    int32_t statement;   /* the place of a LINE, -1 for none */
    uint16_t op;
    uint16_t tag;
};

/* An array of which elements are reached: its first cell, the cells of an element, its sizes. */
struct krl_array {
    int32_t base;
    int32_t width;
    int32_t dimensions;
    int32_t sizes[KRL_MOST_DIMENSIONS];
    int32_t third; /* the register of the third index */
};

/* A code object made ready. */
struct krl_routine {
    struct krl_step *entry;
    int32_t frame;    /* cells of its variables */
    int32_t whole;    /* and of its places on the stack of operands */
    int32_t received; /* cells of its parameters */
    int32_t arguments; /* cells of its arguments on the stack of the caller */
    int32_t is_owner; /* whether actions or conditions use its variables */
    const struct krl_code *code;
    int32_t *steps;   /* by the place of an instruction: its step where it is a target, else -1 */
};

/* The frame to return to. */
struct krl_call {
    int32_t step; /* to go on at; -1 where Python has made the frame that ends */
    int32_t code;
    int32_t fp;
    int32_t extent;
    int32_t statement;
    int32_t serial;
    int32_t result; /* the cell that takes the result */
    int32_t top;    /* of a frame that Python has made: what it was before */
};

/* Cells: the data lists, then the frames of each machine that shares them, in a range of its own. */
struct krl_memory {
    krl_cell *cells;
    int32_t count;
    int32_t users;
};

/* Of so many calls there may be at most; and of actions entered at once. */
enum { KRL_MOST_CALLS = 1 << 20, KRL_MOST_ENTERED = 64 };

/* Events, as bits. */
enum krl_traced {
    KRL_TRACED_LINE = 1,
    KRL_TRACED_ASSIGN = 2,
    KRL_TRACED_CALL = 4,
    KRL_TRACED_RETURN = 8,
    KRL_TRACED_BRANCH = 16
};

/* A step to stop before; with a relation, its place in KRL_COMPARISONS, only where that holds. */
struct krl_break {
    int32_t step;
    int32_t relation; /* -1 for none */
    int32_t cell;     /* of the frame or of all cells, the left side */
    int is_of_frame;
    krl_cell right;
};

struct krl_machine;

/* Runs a program that was compiled, from one of its entries on, until the interpreter has to go on. */
typedef void krl_compiled(struct krl_machine *machine, int32_t at);

/* What a program that was compiled calls of this module. */
struct krl_outside;

struct krl_machine {
    struct krl_program program;
    krl_compiled *compiled; /* its steps as C that was compiled, NULL for none */
    const struct krl_outside *outside;
    const int32_t *entries; /* the steps at which that is entered, up to -1; NULL for none */
    struct krl_break *breaks;
    int32_t break_count;    /* where there are any nothing is entered */
    int traced; /* which events are traced */
    struct krl_routine *routines;
    struct krl_step *steps;
    int32_t step_count;
    struct krl_array *arrays;
    int32_t array_count;
    int32_t most_whole; /* the most cells that any frame takes */
    int32_t most_stack;

    struct krl_memory *memory;
    krl_cell *cells; /* those of the memory, which may move between two runs */
    int32_t first;   /* cell of the frames */
    int32_t end;     /* behind the last */
    uint32_t checksum;
    struct krl_call *calls;
    int32_t call_capacity;

    /* The frame that runs. `extent` is where it would begin if frames had no stacks: what counts. */
    int32_t code;
    int32_t fp;
    int32_t extent;
    int32_t statement;
    int32_t serial;
    int32_t serials;
    int32_t open; /* calls */
    int32_t most_calls;
    int32_t left; /* statements that may begin before something has to be done, and one more */
    int32_t quota; /* what it was, and what it has got by steps STOP, of which `stops` may pass */
    int32_t whole; /* what it is where a slice begins */
    int32_t stops;
    int32_t last; /* the cell that was written last through a reference */
    int32_t top;  /* behind the last place of the stack of operands that is in use, when it stops */

    /* Of a program that was compiled: where the interpreter goes on, and whether the statement has begun;
     * the most calls that may be open within it. */
    int32_t at;
    int32_t is_begun;
    int32_t most_nested;
};

/* How a run ends; `at` is a step. */
enum krl_stop {
    KRL_STOP_STEP,   /* the step is for Python */
    KRL_STOP_LINE,   /* the statement of the step has to wait for Python */
    KRL_STOP_FAULT,  /* `at` is the code of the fault */
    KRL_STOP_LEFT,   /* a frame that Python has made has ended; its result is on the stack */
    KRL_STOP_ACTION, /* an action has ended; its frame is still there */
    KRL_STOP_END,    /* the routine that the program began with has ended */
    KRL_STOP_COMPILED, /* the program that was compiled goes on; `krl_run` never gives this */
    KRL_STOP_BREAK   /* as KRL_STOP_LINE, at a breakpoint */
};

struct krl_stopped {
    enum krl_stop why;
    int32_t at;
};

/* What a step for Python is about: an instruction, or the end of a call or the call it is part of. */
enum krl_matter { KRL_MATTER_INSTRUCTION, KRL_MATTER_CALL, KRL_MATTER_LEAVE };

/* ---------------------------------------------------------------------------- machine.c */

void krl_unload(struct krl_machine *machine);

/* Gives a machine its memory, so much that nothing is allotted later: its own, with the data lists as
 * the image has them, or the end of that of another machine of the same image, which stays where it
 * is for those who look at it between two runs. 0 where there is none, or the images differ. */
int krl_give_memory(struct krl_machine *machine, int32_t most_calls, struct krl_machine *beside);

/* Looks where the memory is now. 0 where there are more calls than there is room for. */
int krl_ready(struct krl_machine *machine);

/* Begins with a code object: the first frame, with no value in any cell. It has to be ready. */
void krl_begin(struct krl_machine *machine, int32_t code);

/* Opens a call of a code object from outside, behind all that is in use; its variables have no
 * values. 0 where the frames have too many cells. */
int krl_open(struct krl_machine *machine, int32_t code);

/* Forgets the frame that runs and goes back to the one before. */
void krl_close(struct krl_machine *machine);

/* ---------------------------------------------------------------------------- run.c */

/* Whether a breakpoint at a step is passed, as its relation does not hold: both sides are of one type. */
int krl_passes_break(const struct krl_machine *machine, const krl_cell *fp, int32_t step);

/* Runs from a step on; with `is_begun` the statement that begins there has begun already. */
struct krl_stopped krl_run(struct krl_machine *machine, int32_t step, int is_begun);

/* Puts handlers into steps; and one into a step before which the machine stops for KRL_STOP_COMPILED or
 * KRL_STOP_BREAK. */
void krl_thread(struct krl_step *steps, int32_t count);
void krl_stop_at(struct krl_step *step, enum krl_stop why);

/* ---------------------------------------------------------------------------- numeric_functions.c */

/* Functions give a fault's code or KRL_FINE. */
enum { KRL_FINE = -1 };

enum krl_function { KRL_ABS, KRL_SQRT, KRL_SIN, KRL_COS, KRL_TAN, KRL_ACOS, KRL_ATAN2, KRL_FUNCTIONS };

/* The function of a name with so many arguments; KRL_FUNCTIONS where it is none of them. */
enum krl_function krl_function_of(struct krl_text name, int32_t arguments);
int krl_compute(enum krl_function function, float one, float other, float *result);

/* `target` gets the pose left:right, or the inverse, in `size` cells; they may be the same. */
int krl_compose(krl_cell *target, const krl_cell *left, const krl_cell *right, int32_t size);
int krl_invert(krl_cell *target, const krl_cell *pose, int32_t size);

/* ---------------------------------------------------------------------------- text_functions.c */

enum krl_text_function {
    KRL_STRLEN, KRL_STRDECLLEN, KRL_STRCLEAR, KRL_STRADD, KRL_STRCOPY, KRL_STRCOMP, KRL_STRFIND,
    KRL_STRTOBOOL, KRL_STRTOINT, KRL_STRTOREAL, KRL_STRTOSTRING, KRL_SWRITE, KRL_SREAD,
    KRL_TEXT_FUNCTIONS
};

/* The text function that an entry calls, if this machine carries it out itself. */
enum krl_text_function krl_text_function_of(const struct krl_program *program,
                                            const struct krl_entry *entry);

/* `inputs` are what lay on the stack; the result, if there is one, takes the place of the first of them. 0 where
 * nothing was done: it faults, or is a rare case that Python has to carry out. */
int krl_call_text(struct krl_machine *machine, enum krl_text_function function,
                  const struct krl_entry *entry, krl_cell *inputs);

struct krl_outside {
    int (*is_plain)(const struct krl_program *program, int32_t type);
    int (*compute)(enum krl_function function, float one, float other, float *result);
    int (*compose)(krl_cell *target, const krl_cell *left, const krl_cell *right, int32_t size);
    int (*invert)(krl_cell *target, const krl_cell *pose, int32_t size);
    int (*call_text)(struct krl_machine *machine, enum krl_text_function function,
                     const struct krl_entry *entry, krl_cell *inputs);
};

/* What both sides of a program that was compiled have to agree on. */
#define KRL_LAYOUT                                                                                 \
    ((uint32_t)(sizeof(struct krl_machine) * 65599 + sizeof(struct krl_step) * 4099 +              \
                sizeof(struct krl_call) * 257 + KRL_STEP_COUNT))

#endif
