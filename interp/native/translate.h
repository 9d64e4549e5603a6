/* What the parts of the translation share; see translate.c. */
#ifndef KRL_TRANSLATE_H
#define KRL_TRANSLATE_H

#include "machine.h"
#include "steps.h"

enum held_kind {
    IN_PLACE,
    VARIABLE, /* of the frame: `a` is its register; it may have no value */
    CONSTANT, /* `a` bits, `tag` */
    ADDRESS,  /* of a register: `a` */
    ELEMENT   /* the address of an element: indices in the registers `a` and `b`, array `array` */
};

struct held {
    enum held_kind kind;
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
    struct held *stack;
    int32_t height;
    int32_t line;      /* the place of a LINE that no step has noted yet, -1 for none */
    int32_t result;    /* the step that put what is on top there, if the one behind has not begun */
    int is_wrong;
};

/* ---------------------------------------------------------------------------- held.c */

/* How an element of an array is reached: its address, its value, or a value for it. */
enum access { INDEX, GET, PUT };

struct krl_step *krl_emit(struct translator *at, enum krl_step_op op);
int32_t krl_place_of(const struct translator *at, int32_t number);
int32_t krl_add_array(struct translator *at, struct krl_array array);
struct krl_array krl_array_of(const struct translator *at, int32_t base, int32_t number);
struct krl_step *krl_reach(struct translator *at, enum access access, const struct held *element,
                              int32_t a);
void krl_settle(struct translator *at, int32_t number);
void krl_settle_to(struct translator *at, int32_t height);
void krl_settle_all(struct translator *at);
void krl_secure(struct translator *at, int32_t height);
int krl_is_constant(const struct translator *at, int32_t number);
int32_t krl_operand(struct translator *at, int32_t number);
void krl_push(struct translator *at, struct held held);
void krl_push_constant(struct translator *at, enum krl_tag tag, int32_t bits);
void krl_push_places(struct translator *at, int32_t count);
void krl_push_result(struct translator *at);
int krl_is_fresh(const struct translator *at, int32_t number);

/* ---------------------------------------------------------------------------- elements.c */

void krl_load(struct translator *at);
void krl_store_local(struct translator *at, int32_t place);
void krl_store_data(struct translator *at, int32_t address);
void krl_store(struct translator *at);
void krl_member(struct translator *at, int32_t offset);
void krl_element(struct translator *at, int is_local, int32_t base, int32_t type);
void krl_view_index(struct translator *at, int32_t place);
void krl_row(struct translator *at, const struct krl_instruction *instruction);
void krl_view(struct translator *at, const struct krl_type *type);
struct krl_step *krl_consume(struct translator *at, enum krl_step_op op, int32_t count);

/* ---------------------------------------------------------------------------- translate.c */

void krl_unary(struct translator *at, enum krl_step_op op);
void krl_binary(struct translator *at, enum krl_step_op op, enum krl_step_op constant, int commutes);

#endif
