/* What the parts of the translation share; translate.c describes it. */
#ifndef KRL_TRANSLATE_H
#define KRL_TRANSLATE_H

#include "vm/machine.h"
#include "vm/register_code.h"

enum virtual_kind {
    IN_PLACE,
    VARIABLE, /* of the frame: `a` is its register; it may have no value */
    CONSTANT, /* `a` bits, `tag` */
    ADDRESS,  /* of a register: `a` */
    ELEMENT   /* the address of an element: indices in the registers `a` and `b`, array `array` */
};

struct virtual_value {
    enum virtual_kind kind;
    int32_t a, b;
    int32_t array;
    uint16_t tag;
    uint16_t is_local; /* an element of the frame, not of the data lists */
};

struct translator {
    struct krl_machine *machine;
    const struct krl_program *program;
    const struct krl_code *code;
    struct krl_routine *routine;
    struct krl_refusal *why;
    struct krl_step *steps;
    int32_t count;
    int32_t capacity;
    struct krl_array *arrays;
    int32_t array_count;
    int32_t array_capacity;
    struct virtual_value *stack;
    int32_t height;
    int32_t line;      /* the place of a LINE that no step has noted yet, -1 for none */
    int32_t result;    /* the step that put what is on top there, if the one behind has not begun */
    int is_wrong;
};

/* ---------------------------------------------------------------------------- virtual_stack.c */

/* Adds a step, with the statement that begins here. There is one to write into even without memory. */
struct krl_step *krl_emit(struct translator *at, enum krl_step_op op);

/* The register that is the place on the stack with this number. */
int32_t krl_place_of(const struct translator *at, int32_t number);

/* Adds to the table of arrays; gives the place there. */
int32_t krl_add_array(struct translator *at, struct krl_array array);

/* An array whose first cell is `base`, of the type that has this number. */
struct krl_array krl_array_of(const struct translator *at, int32_t base, int32_t number);

/* How an element of an array is reached: its address, its value, or a value for it. */
enum access { INDEX, GET, PUT };

/* The step that reaches an element; `a` is the register that gets or has the value or address. */
struct krl_step *krl_reach(struct translator *at, enum access access, const struct virtual_value *element,
                           int32_t a);

/* Puts what lies there into its place; all below a height; all of the stack. */
void krl_settle(struct translator *at, int32_t number);
void krl_settle_to(struct translator *at, int32_t height);
void krl_settle_all(struct translator *at);

/* Puts what can fault into its place, up to a height. */
void krl_secure(struct translator *at, int32_t height);

int krl_is_constant(const struct translator *at, int32_t number);

/* The register that has what lies there. */
int32_t krl_operand(struct translator *at, int32_t number);

/* Put on the stack: something that lies elsewhere, a constant, what is in its place already. */
void krl_push(struct translator *at, struct virtual_value item);
void krl_push_constant(struct translator *at, enum krl_tag tag, int32_t bits);
void krl_push_places(struct translator *at, int32_t count);

/* The last step gives the value of the place that is put on the stack now. */
void krl_push_result(struct translator *at);

/* Whether the last step has put there what lies there. */
int krl_is_fresh(const struct translator *at, int32_t number);

/* ---------------------------------------------------------------------------- translate_data_movement.c */

/* A cell of the data lists; the cell that the reference on top leads to. */
void krl_load_data(struct translator *at, int32_t address);
void krl_load(struct translator *at);

/* The value on top goes into a register, a cell of the data lists, or where a reference leads. */
void krl_store_local(struct translator *at, int32_t place);
void krl_store_data(struct translator *at, int32_t address);
void krl_store(struct translator *at);

/* The member of the structure that the reference on top leads to. */
void krl_member(struct translator *at, int32_t offset);

/* The element that indices lead to: of a variable of this array type, or of a view. */
void krl_element(struct translator *at, int is_local, int32_t base, int32_t type);
void krl_view_index(struct translator *at, int32_t place);

/* The view of a row of an array or of a view; of all of an array. */
void krl_row(struct translator *at, int32_t type, int32_t count);
void krl_row_of_view(struct translator *at, int32_t place, int32_t count);
void krl_view(struct translator *at, const struct krl_type *type);

/* A step that takes so many places of the stack, all settled; `a` is the first of them. */
struct krl_step *krl_consume(struct translator *at, enum krl_step_op op, int32_t count);

/* ---------------------------------------------------------------------------- translate_arithmetic.c */

void krl_unary(struct translator *at, enum krl_step_op op);

/* `constant` is the step for a constant at the right, or KRL_STEP_COUNT. */
void krl_binary(struct translator *at, enum krl_step_op op, enum krl_step_op constant, int commutes);

/* Where the divisor is a constant it need not be looked at when it runs. */
void krl_division(struct translator *at);
void krl_quotient(struct translator *at);
void krl_subtraction(struct translator *at);

/* A relation, by its place in EQ NE LT GT LE GE, from the step of EQ on; or a jump unless it holds.
 * The second one gives a BOOL. */
struct krl_step *krl_relate(struct translator *at, enum krl_step_op first, int relation);
void krl_relation(struct translator *at, enum krl_step_op first, int relation);

/* ---------------------------------------------------------------------------- translate_control_flow.c */

/* A step for Python: all that lies on the stack is in its place before. */
struct krl_step *krl_to_python(struct translator *at, enum krl_matter matter, int32_t place);

/* The beginning of the statement at a place. */
void krl_line(struct translator *at, int32_t place);

/* A jump if, or unless, the BOOL on top holds: one with the relation that has just given it. */
void krl_jump_on(struct translator *at, int is_if, int32_t target);

/* A jump unless the relation holds, of INT or REAL, that has this place in EQ NE LT GT LE GE. */
void krl_jump_unless(struct translator *at, int is_real, int relation, int32_t target);

/* The CASE at a place, with those that follow it. */
void krl_choose(struct translator *at, int32_t place);

/* The end of a turn of a FOR loop. */
void krl_count_up(struct translator *at, const struct krl_instruction *instruction);

/* The call, and the end, that the instruction at a place is. */
void krl_call_routine(struct translator *at, int32_t place);
void krl_leave(struct translator *at, int32_t place);

/* A request; and a call of a predefined function, which is one where C does not have it. */
void krl_ask(struct translator *at, const struct krl_entry *entry, int32_t place);
void krl_call_builtin(struct translator *at, int32_t place);

/* ---------------------------------------------------------------------------- translate.c */

/* Translates all code objects. */
int krl_translate(struct krl_machine *machine, struct krl_refusal *why);

#endif
