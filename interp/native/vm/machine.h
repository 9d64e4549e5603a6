/* The machine: a program that is ready to run, and its state during a run.
 *
 * Code objects are translated from stack instructions into register code when they are loaded
 * (translate.c). A register is a cell of the frame, counted from its first one: the variables come
 * first, then the slots of the operand stack. So arguments on the caller's stack are already where
 * the callee's frame begins, unless the call copies a structure. Nothing is allocated during a run.
 */
#ifndef KRL_MACHINE_H
#define KRL_MACHINE_H

#include "program/program.h"

/* A step: an operation, its operands, and the statement that begins with it, if any. */
struct krl_step {
    const void *handler; /* threaded code: the address of the code of `op`, or of a stop; see krl_thread */
    int32_t a, b, c, d;  /* in a jump, d is the distance of the target in bytes */
    int32_t statement;   /* index of a LINE, -1 for none */
    uint16_t op;
    uint16_t tag;
};

/* An array whose elements are accessed: its first cell, and the cells of an element. */
struct krl_array {
    int32_t base;
    int32_t width;
    int32_t dimensions;
    int32_t sizes[KRL_MOST_DIMENSIONS];
    int32_t third; /* register of the third index */
};

/* A code object after translation. */
struct krl_routine {
    struct krl_step *entry;
    int32_t frame;    /* cells of its parameters and locals */
    int32_t whole;    /* the same, and of its operand stack */
    int32_t received; /* cells of its parameters */
    int32_t arguments; /* cells of its arguments on the caller's stack */
    int32_t is_owner; /* whether actions or conditions capture its variables */
    const struct krl_code *code;
    int32_t *steps;   /* by instruction: its step, for targets and statements; else -1 */
};

/* An open call: the frame to return to. */
struct krl_call {
    int32_t step; /* where to continue; -1 if Python has opened the callee's frame */
    int32_t code;
    int32_t fp;
    int32_t extent;
    int32_t statement;
    int32_t serial;
    int32_t result; /* the cell that receives the result */
    int32_t top;    /* the caller's `top`, if Python has opened the callee's frame */
};

/* Memory, shared by machines of one image: the data lists, then for each machine a range for its
 * frames. */
struct krl_memory {
    krl_cell *cells;
    int32_t count;
    int32_t users;
};

/* The maximum number of open calls; and of actions and conditions that are entered in addition. */
enum { KRL_MOST_CALLS = 1 << 20, KRL_MOST_ENTERED = 64 };

/* The kinds of events that are traced, as bits. */
enum krl_traced {
    KRL_TRACED_LINE = 1,
    KRL_TRACED_ASSIGN = 2,
    KRL_TRACED_CALL = 4,
    KRL_TRACED_RETURN = 8,
    KRL_TRACED_BRANCH = 16
};

/* A breakpoint before a step. If it has a relation, its index in KRL_COMPARISONS, it stops only
 * where that holds between a cell and a constant. */
struct krl_break {
    int32_t step;
    int32_t relation; /* -1 for none */
    int32_t cell;     /* the left side: a cell of the frame or of all memory */
    int is_of_frame;
    krl_cell right;
};

struct krl_machine;

/* Runs native code, from an entry on, until the interpreter has to continue. */
typedef void krl_compiled(struct krl_machine *machine, int32_t at);

/* The functions of this module that native code calls. */
struct krl_outside;

struct krl_machine {
    struct krl_program program;
    krl_compiled *compiled; /* the native code of its steps, NULL for none */
    const struct krl_outside *outside;
    const int32_t *entries; /* the steps at which native code is entered, then -1; NULL for none */
    struct krl_break *breaks;
    int32_t break_count;    /* while there are any, native code is not entered */
    int traced; /* a set of `enum krl_traced` */
    struct krl_routine *routines;
    struct krl_step *steps;
    int32_t step_count;
    struct krl_array *arrays;
    int32_t array_count;
    int32_t most_whole; /* the greatest `whole` of all routines */
    int32_t most_stack; /* the greatest operand stack of all routines, in cells */

    struct krl_memory *memory;
    krl_cell *cells; /* those of `memory`, set by krl_ready: they may move between runs */
    int32_t first;   /* first cell of its frames */
    int32_t end;     /* the cell after its last frame */
    uint32_t checksum;
    struct krl_call *calls;
    int32_t call_capacity;

    /* The current frame. `extent` is where it would begin if frames had no operand stacks:
     * KRL_MAX_CELLS limits that, as in the Python machine, whose frames have none. */
    int32_t code;
    int32_t fp;
    int32_t extent;
    int32_t statement;
    int32_t serial;  /* number of the frame, by which actions and conditions find it; 0 for none */
    int32_t serials; /* the last number that was assigned */
    int32_t open; /* number of open calls */
    int32_t most_calls;
    int32_t left; /* statements that may begin before the machine stops for Python, plus 1 */
    int32_t quota; /* the initial value of `left`, plus what STOP steps have added */
    int32_t whole; /* the value of `left` where a slice begins */
    int32_t stops; /* STOP steps that may pass until Python has to execute one */
    int32_t functions; /* the weight of functions that may still be called */
    int32_t last; /* the cell of the last assignment through a reference */
    int32_t top;  /* the cell after the operand stack in use; valid while the machine has stopped */

    /* Set by native code: where the interpreter continues, and whether the statement there has
     * begun. `most_nested` limits the calls that may be open in native code. */
    int32_t at;
    int32_t is_begun;
    int32_t most_nested;
};

/* Why a run has stopped. `at` is the step where it has stopped, or 0 if a frame or the program has
 * ended. */
enum krl_stop {
    KRL_STOP_STEP,   /* Python has to execute the step */
    KRL_STOP_LINE,   /* `left` is used up: the statement of the step waits for Python */
    KRL_STOP_FAULT,  /* `at` is the code of the fault, or KRL_OVERRUN */
    KRL_STOP_LEFT,   /* a frame that Python has opened has ended; its result is on the stack */
    KRL_STOP_ACTION, /* an action has ended; its frame is still open */
    KRL_STOP_END,    /* the first routine of the program has ended */
    KRL_STOP_COMPILED, /* native code continues; `krl_run` never returns this */
    KRL_STOP_BREAK   /* like KRL_STOP_LINE, at a breakpoint */
};

struct krl_stopped {
    enum krl_stop why;
    int32_t at;
};

/* What Python does at a step: execute the instruction, or trace a call, or trace a return. */
enum krl_matter { KRL_MATTER_INSTRUCTION, KRL_MATTER_CALL, KRL_MATTER_LEAVE };

/* ---------------------------------------------------------------------------- machine.c */

/* Frees all that a machine owns. Memory that it shares is freed with its last user. */
void krl_unload(struct krl_machine *machine);

/* Allocates all memory of a machine, for at most `most_calls` open calls. Without `beside` it has
 * data lists of its own, with their initial values. Otherwise it shares the memory of that machine,
 * of the same image, and appends a range for its own frames: indices of cells stay valid, addresses
 * do not. Returns 0 if there is not enough memory, `most_calls` is out of range, or the images
 * differ. */
int krl_give_memory(struct krl_machine *machine, int32_t most_calls, struct krl_machine *beside);

/* Updates `cells` before a run. Returns 0 if there is not enough room for the open calls or the
 * current frame. */
int krl_ready(struct krl_machine *machine);

/* Opens the first frame, for a code object, without any values. Requires krl_ready. */
void krl_begin(struct krl_machine *machine, int32_t code);

/* Opens a call of a code object for Python, in a frame without values behind all cells that are in
 * use. Returns 0 if there are too many calls, or the frames have too many cells. */
int krl_open(struct krl_machine *machine, int32_t code);

/* Closes the current frame and returns to the one before. At least one call must be open. */
void krl_close(struct krl_machine *machine);

/* ---------------------------------------------------------------------------- run.c */

/* Whether the breakpoint at a step is passed, because its relation does not hold. It is not passed
 * if there is no relation, or the cell has no value or one of another type. */
int krl_passes_break(const struct krl_machine *machine, const krl_cell *fp, int32_t step);

/* Runs from a step until the machine stops. If `is_begun`, the statement of this step has already
 * begun. Requires krl_ready. */
struct krl_stopped krl_run(struct krl_machine *machine, int32_t step, int is_begun);

/* krl_thread resets the handlers of steps, which removes all stops. krl_stop_at makes the machine
 * stop before a step, for KRL_STOP_COMPILED or KRL_STOP_BREAK. */
void krl_thread(struct krl_step *steps, int32_t count);
void krl_stop_at(struct krl_step *step, enum krl_stop why);

/* ---------------------------------------------------------------------------- numeric_functions.c */

/* Functions return the code of a fault, or KRL_FINE. KRL_OVERRUN says that functions have taken
 * longer than they may. */
enum { KRL_FINE = -1, KRL_OVERRUN = KRL_FAULT_COUNT };

enum krl_function { KRL_ABS, KRL_SQRT, KRL_SIN, KRL_COS, KRL_TAN, KRL_ACOS, KRL_ATAN2, KRL_FUNCTIONS };

/* Returns the function with a name and a number of arguments, or KRL_FUNCTIONS if there is none.
 * krl_compute computes all but ABS and SQRT; ATAN2 alone uses `other`. */
enum krl_function krl_function_of(struct krl_text name, int32_t arguments);
int krl_compute(enum krl_function function, float one, float other, float *result);

/* Store the pose left:right, or the inverse of a pose, in the `size` cells of `target`, which may
 * be those of an operand. Return a fault or KRL_FINE. */
int krl_compose(krl_cell *target, const krl_cell *left, const krl_cell *right, int32_t size);
int krl_invert(krl_cell *target, const krl_cell *pose, int32_t size);

/* ---------------------------------------------------------------------------- text_functions.c */

enum krl_text_function {
    KRL_STRLEN, KRL_STRDECLLEN, KRL_STRCLEAR, KRL_STRADD, KRL_STRCOPY, KRL_STRCOMP, KRL_STRFIND,
    KRL_STRTOBOOL, KRL_STRTOINT, KRL_STRTOREAL, KRL_STRTOSTRING, KRL_SWRITE, KRL_SREAD,
    KRL_TEXT_FUNCTIONS
};

/* Returns the text function that an entry calls, or KRL_TEXT_FUNCTIONS if C has none for these
 * arguments. */
enum krl_text_function krl_text_function_of(const struct krl_program *program,
                                            const struct krl_entry *entry);

/* Executes a text function, whose `inputs` are on the stack. A result replaces the first of them.
 * Returns 0, with nothing done, if Python has to execute it: it faults, is a rare case, or takes
 * longer than functions may. */
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

/* Must be the same in this module and in native code. */
#define KRL_LAYOUT                                                                                 \
    ((uint32_t)(sizeof(struct krl_machine) * 65599 + sizeof(struct krl_step) * 4099 +              \
                sizeof(struct krl_call) * 257 + KRL_STEP_COUNT))

#endif
