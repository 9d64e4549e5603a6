/* Shared declarations of the translator; translate.c describes it. */
#ifndef KRL_TRANSLATE_H
#define KRL_TRANSLATE_H

#include "vm/machine.h"
#include "vm/register_code.h"

enum virtual_kind {
    IN_PLACE,
    VARIABLE, /* of the frame, in register `a`; it may have no value */
    CONSTANT, /* bits `a` with tag `tag` */
    ADDRESS,  /* the address of register `a` */
    ELEMENT   /* the address of an element: indices in registers `a` and `b`, table entry `array` */
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
    struct krl_step *steps;
    int32_t count;
    int32_t capacity;
    struct krl_array *arrays;
    int32_t array_count;
    int32_t array_capacity;
    struct virtual_value *stack;
    int32_t height;
    int32_t line;      /* the LINE that the next step carries, -1 for none */
    int32_t result;    /* the last step if it has written the top item to its place, else -1 */
    int is_wrong;
};

/* ---------------------------------------------------------------------------- virtual_stack.c */

/* Appends a step, which carries the statement that begins here. If there is no memory, sets
 * `is_wrong` and returns a dummy step, so the result can always be written to. */
struct krl_step *krl_emit(struct translator *at, enum krl_step_op op);

/* Returns the register of a slot of the operand stack. */
int32_t krl_place_of(const struct translator *at, int32_t number);

/* Appends to the table of arrays and returns the index there. If there is no memory, sets
 * `is_wrong` and returns 0. */
int32_t krl_add_array(struct translator *at, struct krl_array array);

/* Returns the entry for an array of the type `number` whose first cell is `base`. */
struct krl_array krl_array_of(const struct translator *at, int32_t base, int32_t number);

/* Access to an element of an array: compute its address, read it, or write it. */
enum access { INDEX, GET, PUT };

/* Emits the step that accesses an element. Register `a` receives the address or the value, or has
 * the value to write. */
struct krl_step *krl_reach(struct translator *at, enum access access, const struct virtual_value *element,
                           int32_t a);

/* Put an item in place; all items below a height; all items. */
void krl_settle(struct translator *at, int32_t number);
void krl_settle_to(struct translator *at, int32_t height);
void krl_settle_all(struct translator *at);

/* Settles the items below a height that may fault: variables and elements. */
void krl_secure(struct translator *at, int32_t height);

int krl_is_constant(const struct translator *at, int32_t number);

/* Returns the register that has the value of an item, which is settled unless it is a variable. */
int32_t krl_operand(struct translator *at, int32_t number);

/* Push an item, a constant, `count` items that are in place. */
void krl_push(struct translator *at, struct virtual_value item);
void krl_push_constant(struct translator *at, enum krl_tag tag, int32_t bits);
void krl_push_places(struct translator *at, int32_t count);

/* Pushes the result of the last step, which from now on writes to the place of this item. */
void krl_push_result(struct translator *at);

/* Whether the last step has written this item to its place. */
int krl_is_fresh(const struct translator *at, int32_t number);

/* ---------------------------------------------------------------------------- translate_data_movement.c */

/* Push the value of a cell of the data lists; replace the reference on top by the value that it
 * refers to. */
void krl_load_data(struct translator *at, int32_t address);
void krl_load(struct translator *at);

/* Pop a value and store it in a register, in a cell of the data lists, or through the reference
 * below it. */
void krl_store_local(struct translator *at, int32_t place);
void krl_store_data(struct translator *at, int32_t address);
void krl_store(struct translator *at);

/* Replaces the reference on top, to a structure, by that to the member at an offset. */
void krl_member(struct translator *at, int32_t offset);

/* Pop all indices and push the address of the element: of a variable of this array type, or of the
 * view in a parameter. */
void krl_element(struct translator *at, int is_local, int32_t base, int32_t type);
void krl_view_index(struct translator *at, int32_t place);

/* Pop `count` indices and push the view of the row. krl_row also pops the reference to the array
 * below them; krl_row_of_view takes a row of the view in a parameter. krl_view makes the reference
 * on top a view of a whole array. */
void krl_row(struct translator *at, int32_t type, int32_t count);
void krl_row_of_view(struct translator *at, int32_t place, int32_t count);
void krl_view(struct translator *at, const struct krl_type *type);

/* Settles the stack, pops `count` items and emits a step whose `a` is the first of them. */
struct krl_step *krl_consume(struct translator *at, enum krl_step_op op, int32_t count);

/* ---------------------------------------------------------------------------- translate_arithmetic.c */

void krl_unary(struct translator *at, enum krl_step_op op);

/* Replaces two operands by the result of a step. `constant` is the variant for a constant on the
 * right, or KRL_STEP_COUNT if there is none. */
void krl_binary(struct translator *at, enum krl_step_op op, enum krl_step_op constant, int commutes);

/* A constant divisor that cannot fault is not checked at run time. Subtracting a constant adds its
 * negative. */
void krl_division(struct translator *at);
void krl_quotient(struct translator *at);
void krl_subtraction(struct translator *at);

/* Pop two operands and emit a comparison. `first` is the EQ step of a group, `relation` an index in
 * EQ NE LT GT LE GE. UNLESS steps jump unless the relation holds, and the caller sets the target;
 * krl_relation is for the others and pushes the BOOL. */
struct krl_step *krl_relate(struct translator *at, enum krl_step_op first, int relation);
void krl_relation(struct translator *at, enum krl_step_op first, int relation);

/* ---------------------------------------------------------------------------- translate_control_flow.c */

/* Settles the stack and emits a step that Python executes. */
struct krl_step *krl_to_python(struct translator *at, enum krl_matter matter, int32_t place);

/* Begins the statement of the LINE at a place. */
void krl_line(struct translator *at, int32_t place);

/* Pops a BOOL and jumps if, or unless, it is TRUE. A comparison that has just computed it becomes
 * part of the jump. */
void krl_jump_on(struct translator *at, int is_if, int32_t target);

/* Pops two operands, INT or REAL, and jumps unless the relation with this index in EQ NE LT GT LE
 * GE holds. */
void krl_jump_unless(struct translator *at, int is_real, int relation, int32_t target);

/* Translates the CASE at a place, and all that follow it without a gap. */
void krl_choose(struct translator *at, int32_t place);

/* Ends an iteration of a FOR loop. */
void krl_count_up(struct translator *at, const struct krl_instruction *instruction);

/* Translate the CALL, and the RETURN or RETURN_VALUE, at a place. */
void krl_call_routine(struct translator *at, int32_t place);
void krl_leave(struct translator *at, int32_t place);

/* Translate a request, and a call of a predefined function: one that C does not have is left to
 * Python like a request. */
void krl_ask(struct translator *at, const struct krl_entry *entry, int32_t place);
void krl_call_builtin(struct translator *at, int32_t place);

/* ---------------------------------------------------------------------------- translate.c */

/* Translates all code objects. Returns 0 if there is not enough memory. */
int krl_translate(struct krl_machine *machine);

#endif
