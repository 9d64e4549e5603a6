/* The interpreter: what each step does.
 *
 * Where the compiler has labels as values, each step goes straight to the next one; else, or with
 * KRL_SWITCH, there is one switch. Each step is there twice: as it is, and with the beginning of a
 * statement before it.
 */
#include "machine.h"
#include "steps.h"

#if defined(__GNUC__) && !defined(KRL_SWITCH)
#define KRL_THREADED 1
#define UNLIKELY(condition) __builtin_expect(!!(condition), 0)
#else
#define KRL_THREADED 0
#define UNLIKELY(condition) (condition)
#endif

/* ---------------------------------------------------------------------------- arithmetic */

#if KRL_THREADED
#define adds(a, b, result) __builtin_add_overflow(a, b, result)
#define subtracts(a, b, result) __builtin_sub_overflow(a, b, result)
#define multiplies(a, b, result) __builtin_mul_overflow(a, b, result)
#else
static int fits(int64_t wide, int32_t *result)
{
    *result = (int32_t)wide;
    return wide != *result;
}
#define adds(a, b, result) fits((int64_t)(a) + (b), result)
#define subtracts(a, b, result) fits((int64_t)(a) - (b), result)
#define multiplies(a, b, result) fits((int64_t)(a) * (b), result)
#endif

/* The nearest INT, halves away from zero; not 0 where there is none. The sum with a half is that of
 * doubles: that of singles would round. */
static int rounds(float number, int32_t *result)
{
    double wide = number >= 0 ? (double)number + 0.5 : (double)number - 0.5;
    if (wide >= 2147483648.0 || wide <= -2147483649.0)
        return 1;
    *result = (int32_t)wide; /* towards zero */
    return 0;
}

/* ---------------------------------------------------------------------------- arrays */

/* The place of the element that indices lead to, or -1. They have been looked at: all have values. */
static int32_t flat(const int32_t *sizes, int32_t dimensions, const krl_cell *indices)
{
    int32_t place = 0;
    for (int32_t i = 0; i < dimensions; i++) {
        int32_t index = krl_int_in(indices[i]);
        if (index < 1 || index > sizes[i])
            return -1;
        place = place * sizes[i] + index - 1;
    }
    return place;
}

/* The sizes of a view, which lie behind its address. */
static void view_sizes(const krl_cell *view, int32_t dimensions, int32_t *sizes)
{
    for (int32_t i = 0; i < dimensions; i++)
        sizes[i] = krl_int_in(view[1 + i]);
}

static void copy(krl_cell *target, const krl_cell *source, int32_t count)
{
    memmove(target, source, (size_t)count * sizeof *target);
}

static void blank(krl_cell *target, int32_t count)
{
    memset(target, 0, (size_t)count * sizeof *target);
}

/* As interp.values.fill does it with arrays; gives a fault. */
static int fill_array(krl_cell *cells, const krl_cell *target, const krl_cell *source, int32_t width,
                      int32_t dimensions)
{
    int32_t length = width, given = width;
    for (int32_t i = 1; i <= dimensions; i++) {
        length *= krl_int_in(target[i]);
        given *= krl_int_in(source[i]);
        if (dimensions > 1 && target[i] != source[i])
            return KRL_FAULT_INADMISSIBLE;
    }
    int32_t count = given < length ? given : length;
    krl_cell *to = cells + krl_int_in(target[0]);
    copy(to, cells + krl_int_in(source[0]), count);
    blank(to + count, length - count);
    return KRL_FINE;
}

static void set_text(krl_cell *target, int32_t length, const struct krl_letters *text)
{
    int32_t count = text->count < length ? text->count : length;
    copy(target, text->cells, count);
    blank(target + count, length - count);
}

/* ---------------------------------------------------------------------------- calls */

/* Puts arguments, of which structures are references, into a frame, and takes the rest's values away. */
static void receive(struct krl_machine *machine, const struct krl_routine *callee, krl_cell *frame,
                    const krl_cell *arguments)
{
    const struct krl_code *code = callee->code;
    for (int32_t i = 0; i < code->parameter_count; i++) {
        const struct krl_slot *slot = &code->slots[i];
        int is_copied = slot->handed.mode == KRL_BY_VALUE &&
                        !krl_is_plain(&machine->program, slot->handed.type);
        const krl_cell *given = is_copied ? machine->cells + krl_int_in(*arguments) : arguments;
        copy(frame + slot->offset, given, slot->cells);
        arguments += krl_stack_cells(&slot->handed);
    }
    blank(frame + callee->received, callee->frame - callee->received);
}

/* ---------------------------------------------------------------------------- the loop */

#define REGISTER(number) fp[number]
#define A REGISTER(pc->a)
#define B REGISTER(pc->b)
#define C REGISTER(pc->c)
#define D REGISTER(pc->d)

#define FAULT(name)                                                                                \
    do {                                                                                           \
        fault = KRL_FAULT_##name;                                                                  \
        goto failed;                                                                               \
    } while (0)
#define FAULT_IF(condition, name)                                                                  \
    do {                                                                                           \
        if (UNLIKELY(condition))                                                                   \
            goto name;                                                                             \
    } while (0)
/* What is read may have no value, unless it is known to come from another step. */
#define READ(name, cell)                                                                           \
    krl_cell name = (cell);                                                                        \
    FAULT_IF(name == KRL_NOTHING, uninitialised)

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

#define REAL_RESULT(expression)                                                                    \
    do {                                                                                           \
        float result = (expression);                                                               \
        FAULT_IF(!krl_is_finite(result), overflow);                                                \
        A = krl_of_real(result);                                                                   \
        NEXT();                                                                                    \
    } while (0)
#define INT_RESULT(operation, left_operand, right_operand)                                         \
    do {                                                                                           \
        int32_t result;                                                                            \
        FAULT_IF(operation(left_operand, right_operand, &result), overflow);                       \
        A = krl_of_int(result);                                                                    \
        NEXT();                                                                                    \
    } while (0)

#define INT_STEP(name, operation)                                                                  \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        INT_RESULT(operation, krl_int_in(b), krl_int_in(c));                                       \
    }
#define INT_STEP_K(name, operation)                                                                \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        INT_RESULT(operation, krl_int_in(b), pc->c);                                               \
    }
#define REAL_STEP(name, operator)                                                                  \
    STEP(name##_REAL)                                                                              \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        REAL_RESULT(krl_real_in(b) operator krl_real_in(c));                                       \
    }                                                                                              \
    STEP(name##_REAL_K)                                                                            \
    {                                                                                              \
        READ(b, B);                                                                                \
        REAL_RESULT(krl_real_in(b) operator krl_real_of_bits((uint32_t)pc->c));                    \
    }
#define RELATION_STEPS(name, operator)                                                             \
    STEP(name##_INT)                                                                               \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        A = krl_of_bool(krl_int_in(b) operator krl_int_in(c));                                     \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(name##_INT_K)                                                                             \
    {                                                                                              \
        READ(b, B);                                                                                \
        A = krl_of_bool(krl_int_in(b) operator pc->c);                                             \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(name##_REAL)                                                                              \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        A = krl_of_bool(krl_real_in(b) operator krl_real_in(c));                                   \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(name##_REAL_K)                                                                            \
    {                                                                                              \
        READ(b, B);                                                                                \
        A = krl_of_bool(krl_real_in(b) operator krl_real_of_bits((uint32_t)pc->c));                \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_INT)                                                                      \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        if (krl_int_in(b) operator krl_int_in(c))                                                  \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_INT_K)                                                                    \
    {                                                                                              \
        READ(b, B);                                                                                \
        if (krl_int_in(b) operator pc->c)                                                          \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_REAL)                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        if (krl_real_in(b) operator krl_real_in(c))                                                \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }                                                                                              \
    STEP(UNLESS_##name##_REAL_K)                                                                   \
    {                                                                                              \
        READ(b, B);                                                                                \
        if (krl_real_in(b) operator krl_real_of_bits((uint32_t)pc->c))                             \
            NEXT();                                                                                \
        JUMP();                                                                                    \
    }
/* Two operands that are looked at as numbers of 32 bits; both BOOL, or both INT. */
#define BIT_STEP(name, make, operator)                                                             \
    STEP(name)                                                                                     \
    {                                                                                              \
        READ(b, B);                                                                                \
        READ(c, C);                                                                                \
        A = make(krl_int_in(b) operator krl_int_in(c));                                            \
        NEXT();                                                                                    \
    }

/* The element at an address: its address, its value, or the place for one. */
#define ACCESS_STEPS(suffix, base, find)                                                           \
    STEP(INDEX_##suffix)                                                                           \
    {                                                                                              \
        find;                                                                                      \
        A = krl_of_int((int32_t)((base) + place - cells));                                         \
        NEXT();                                                                                    \
    }
#define ELEMENT_STEPS(get, put, base, find)                                                        \
    STEP(get)                                                                                      \
    {                                                                                              \
        find;                                                                                      \
        READ(found, (base)[place]);                                                                \
        A = found;                                                                                 \
        NEXT();                                                                                    \
    }                                                                                              \
    STEP(put)                                                                                      \
    {                                                                                              \
        find;                                                                                      \
        READ(value, A);                                                                            \
        (base)[place] = value;                                                                     \
        NEXT();                                                                                    \
    }
/* Indices count from 1; as numbers without sign, 0 and negative ones are too large. */
#define FIND_ONE                                                                                   \
    READ(index, B);                                                                                \
    uint32_t number = (uint32_t)index - 1;                                                         \
    FAULT_IF(number >= (uint32_t)pc->d, index_);                                                   \
    int32_t place = pc->c + (int32_t)number
#define FIND_WIDE                                                                                  \
    const struct krl_array *array = &machine->arrays[pc->c];                                       \
    READ(index, B);                                                                                \
    uint32_t number = (uint32_t)index - 1;                                                         \
    FAULT_IF(number >= (uint32_t)array->sizes[0], index_);                                         \
    int32_t place = array->base + (int32_t)number * array->width
#define FIND_TWO                                                                                   \
    const struct krl_array *array = &machine->arrays[pc->c];                                       \
    READ(index, B);                                                                                \
    READ(other, D);                                                                                \
    uint32_t number = (uint32_t)index - 1, behind = (uint32_t)other - 1;                           \
    FAULT_IF(number >= (uint32_t)array->sizes[0] || behind >= (uint32_t)array->sizes[1], index_);  \
    int32_t place = array->base + ((int32_t)number * array->sizes[1] + (int32_t)behind) * array->width

static struct krl_stopped interpret(struct krl_machine *machine, int32_t step, int is_begun,
                                    const void *const **handlers)
{
    struct krl_stopped stopped = {KRL_STOP_STEP, 0};
#if KRL_THREADED
#define LABELS(name) &&do_##name, &&begin_##name,
    static const void *const labels[] = {KRL_STEPS(LABELS)};
    if (handlers != NULL) {
        *handlers = labels;
        return stopped;
    }
#else
    (void)handlers;
#endif
    krl_cell *const cells = machine->cells;
    krl_cell *fp = cells + machine->fp;
    const struct krl_step *pc = &machine->steps[step];
    int32_t left = machine->left, statement = machine->statement;
    int fault = KRL_FINE;

#if KRL_THREADED
    goto *labels[2 * pc->op + (pc->statement >= 0 && !is_begun)];
    {
        {
#else
    int number_of_case = 2 * pc->op + (pc->statement >= 0 && !is_begun);
    for (;;) {
        switch (number_of_case) {
#endif
    /* ---- where to go on */
    STEP(JUMP) { JUMP(); }
    STEP(JUMP_IF)
    {
        READ(b, B);
        if (krl_int_in(b))
            JUMP();
        NEXT();
    }
    STEP(JUMP_UNLESS)
    {
        READ(b, B);
        if (krl_int_in(b))
            NEXT();
        JUMP();
    }
    STEP(CASE)
    {
        READ(b, B);
        if (krl_int_in(b) == pc->c)
            JUMP();
        NEXT();
    }
    STEP(FOR_UP)
    {
        READ(counter, A);
        READ(limit, B);
        int32_t result;
        FAULT_IF(adds(krl_int_in(counter), pc->c, &result), overflow);
        A = krl_of_int(result);
        if (result <= krl_int_in(limit))
            JUMP();
        NEXT();
    }
    STEP(FOR_DOWN)
    {
        READ(counter, A);
        READ(limit, B);
        int32_t result;
        FAULT_IF(adds(krl_int_in(counter), pc->c, &result), overflow);
        A = krl_of_int(result);
        if (result >= krl_int_in(limit))
            JUMP();
        NEXT();
    }
    STEP(FOR_DATA_UP)
    {
        READ(counter, cells[pc->a]);
        READ(limit, B);
        int32_t result;
        FAULT_IF(adds(krl_int_in(counter), pc->c, &result), overflow);
        cells[pc->a] = krl_of_int(result);
        if (result <= krl_int_in(limit))
            JUMP();
        NEXT();
    }
    STEP(FOR_DATA_DOWN)
    {
        READ(counter, cells[pc->a]);
        READ(limit, B);
        int32_t result;
        FAULT_IF(adds(krl_int_in(counter), pc->c, &result), overflow);
        cells[pc->a] = krl_of_int(result);
        if (result >= krl_int_in(limit))
            JUMP();
        NEXT();
    }
#define RELATION_STEPS_(name, operator) RELATION_STEPS(name, operator)
    KRL_COMPARISONS(RELATION_STEPS_)

    /* ---- moving */
    STEP(NOP) { NEXT(); }
    STEP(MOVE)
    {
        READ(b, B);
        A = b;
        NEXT();
    }
    STEP(PASS)
    {
        A = B;
        NEXT();
    }
    STEP(SET_K)
    {
        A = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
        NEXT();
    }
    STEP(GET_DATA)
    {
        READ(b, cells[pc->b]);
        A = b;
        NEXT();
    }
    STEP(PUT_DATA)
    {
        READ(b, B);
        cells[pc->a] = b;
        NEXT();
    }
    STEP(PUT_DATA_K)
    {
        cells[pc->a] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
        NEXT();
    }
    STEP(REFER)
    {
        A = krl_of_int((int32_t)(&B - cells));
        NEXT();
    }
    STEP(OFFSET)
    {
        READ(b, B);
        A = krl_of_int(krl_int_in(b) + pc->c);
        NEXT();
    }
    STEP(LOAD)
    {
        READ(b, B);
        READ(found, cells[krl_int_in(b)]);
        A = found;
        NEXT();
    }
    STEP(STORE)
    {
        READ(address, A);
        READ(value, B);
        machine->last = krl_int_in(address);
        cells[krl_int_in(address)] = value;
        NEXT();
    }
    STEP(STORE_K)
    {
        READ(address, A);
        machine->last = krl_int_in(address);
        cells[krl_int_in(address)] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->b);
        NEXT();
    }

    /* ---- elements */
    ACCESS_STEPS(LOCAL, fp, FIND_ONE)
    ACCESS_STEPS(DATA, cells, FIND_ONE)
    ACCESS_STEPS(WIDE_LOCAL, fp, FIND_WIDE)
    ACCESS_STEPS(WIDE_DATA, cells, FIND_WIDE)
    ACCESS_STEPS(TWO_LOCAL, fp, FIND_TWO)
    ACCESS_STEPS(TWO_DATA, cells, FIND_TWO)
    ELEMENT_STEPS(GET_LOCAL, PUT_LOCAL, fp, FIND_ONE)
    ELEMENT_STEPS(GET_ELEMENT_DATA, PUT_ELEMENT_DATA, cells, FIND_ONE)
    ELEMENT_STEPS(GET_WIDE_LOCAL, PUT_WIDE_LOCAL, fp, FIND_WIDE)
    ELEMENT_STEPS(GET_WIDE_DATA, PUT_WIDE_DATA, cells, FIND_WIDE)
    ELEMENT_STEPS(GET_TWO_LOCAL, PUT_TWO_LOCAL, fp, FIND_TWO)
    ELEMENT_STEPS(GET_TWO_DATA, PUT_TWO_DATA, cells, FIND_TWO)
    STEP(PUT_LOCAL_K)
    {
        FIND_ONE;
        fp[place] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->a);
        NEXT();
    }
    STEP(PUT_ELEMENT_DATA_K)
    {
        FIND_ONE;
        cells[place] = krl_tagged((enum krl_tag)pc->tag, (uint32_t)pc->a);
        NEXT();
    }
    STEP(INDEX_ANY)
    {
        const struct krl_array *array = &machine->arrays[pc->c];
        int32_t place = flat(array->sizes, array->dimensions, &B);
        FAULT_IF(place < 0, index_);
        int32_t base = pc->tag == 0   ? krl_int_in(A)
                       : pc->tag == 1 ? (int32_t)(fp - cells) + array->base
                                      : array->base;
        A = krl_of_int(base + place * array->width);
        NEXT();
    }
    STEP(INDEX_VIEW)
    {
        READ(index, B);
        READ(base, C);
        uint32_t number = (uint32_t)index - 1;
        FAULT_IF(number >= (uint32_t)krl_int_in(fp[pc->c + 1]), index_);
        A = krl_of_int(krl_int_in(base) + (int32_t)number * pc->d);
        NEXT();
    }
    STEP(INDEX_VIEW_ANY)
    {
        int32_t sizes[KRL_MOST_DIMENSIONS];
        READ(base, C);
        view_sizes(&C, pc->tag, sizes);
        int32_t place = flat(sizes, pc->tag, &A);
        FAULT_IF(place < 0, index_);
        A = krl_of_int(krl_int_in(base) + place * pc->d);
        NEXT();
    }
    STEP(ROW)
    {
        const struct krl_array *array = &machine->arrays[pc->c];
        int32_t place = flat(array->sizes, pc->b, &A + 1), width = array->width;
        FAULT_IF(place < 0, index_);
        for (int32_t i = pc->b; i < array->dimensions; i++)
            width *= array->sizes[i];
        A = krl_of_int(krl_int_in(A) + place * width);
        for (int32_t i = pc->b; i < array->dimensions; i++)
            (&A)[1 + i - pc->b] = krl_of_int(array->sizes[i]);
        NEXT();
    }
    STEP(ROW_VIEW)
    {
        int32_t sizes[KRL_MOST_DIMENSIONS], width = pc->d;
        READ(base, C);
        view_sizes(&C, pc->tag, sizes);
        for (int32_t i = pc->b; i < pc->tag; i++)
            width *= sizes[i];
        int32_t place = flat(sizes, pc->b, &A);
        FAULT_IF(place < 0, index_);
        A = krl_of_int(krl_int_in(base) + place * width);
        for (int32_t i = pc->b; i < pc->tag; i++)
            (&A)[1 + i - pc->b] = krl_of_int(sizes[i]);
        NEXT();
    }

    /* ---- blocks of cells; references in place always have values */
    STEP(COPY)
    {
        machine->last = krl_int_in(A);
        copy(cells + krl_int_in(A), cells + krl_int_in(B), pc->c);
        NEXT();
    }
    STEP(CLEAR)
    {
        blank(cells + krl_int_in(A), pc->c);
        NEXT();
    }
    STEP(FILL_POSE)
    {
        krl_cell *target = cells + krl_int_in(A);
        machine->last = krl_int_in(A);
        copy(target, cells + krl_int_in(B), pc->d);
        blank(target + pc->d, pc->c - pc->d);
        NEXT();
    }
    STEP(FILL_ARRAY)
    {
        fault = fill_array(cells, &A, &B, pc->c, pc->d);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        machine->last = krl_int_in(A);
        NEXT();
    }
    STEP(COPY_VIEW)
    {
        int32_t length = pc->d;
        for (int32_t i = 1; i <= pc->tag; i++)
            length *= krl_int_in((&A)[i]);
        FAULT_IF(length > pc->c, stack);
        copy(&B, cells + krl_int_in(A), length);
        A = krl_of_int((int32_t)(&B - cells));
        NEXT();
    }
    STEP(SET_TEXT)
    {
        machine->last = krl_int_in(A);
        set_text(cells + krl_int_in(A), krl_int_in((&A)[1]), &machine->program.texts[pc->b]);
        NEXT();
    }
    STEP(COMPOSE)
    {
        fault = krl_compose(cells + krl_int_in(A), cells + krl_int_in(B), cells + krl_int_in(C), pc->d);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        NEXT();
    }
    STEP(INVERT)
    {
        fault = krl_invert(cells + krl_int_in(B), cells + krl_int_in(A), pc->c);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        NEXT();
    }

    /* ---- computing */
    INT_STEP(ADD_INT, adds)
    INT_STEP(SUB_INT, subtracts)
    INT_STEP(MUL_INT, multiplies)
    INT_STEP_K(ADD_INT_K, adds)
    INT_STEP_K(MUL_INT_K, multiplies)
    STEP(DIV_INT)
    {
        READ(b, B);
        READ(c, C);
        int32_t divisor = krl_int_in(c);
        FAULT_IF(divisor == 0, division_by_zero);
        if (UNLIKELY(divisor == -1))
            INT_RESULT(subtracts, 0, krl_int_in(b));
        A = krl_of_int(krl_int_in(b) / divisor);
        NEXT();
    }
    STEP(DIV_INT_K) /* neither 0 nor -1 */
    {
        READ(b, B);
        A = krl_of_int(krl_int_in(b) / pc->c);
        NEXT();
    }
    STEP(NEG_INT)
    {
        READ(b, B);
        INT_RESULT(subtracts, 0, krl_int_in(b));
    }
    STEP(NOT_BITS)
    {
        READ(b, B);
        A = krl_of_int(~krl_int_in(b));
        NEXT();
    }
    BIT_STEP(AND_BITS, krl_of_int, &)
    BIT_STEP(OR_BITS, krl_of_int, |)
    BIT_STEP(EXOR_BITS, krl_of_int, ^)
    BIT_STEP(AND_BOOL, krl_of_bool, &)
    BIT_STEP(OR_BOOL, krl_of_bool, |)
    BIT_STEP(EXOR_BOOL, krl_of_bool, ^)
    STEP(AND_BITS_K)
    {
        READ(b, B);
        A = krl_of_int(krl_int_in(b) & pc->c);
        NEXT();
    }
    STEP(NOT_BOOL)
    {
        READ(b, B);
        A = krl_of_bool(!krl_int_in(b));
        NEXT();
    }
    REAL_STEP(ADD, +)
    REAL_STEP(SUB, -)
    REAL_STEP(MUL, *)
    STEP(DIV_REAL)
    {
        READ(b, B);
        READ(c, C);
        FAULT_IF(krl_real_in(c) == 0, division_by_zero);
        REAL_RESULT(krl_real_in(b) / krl_real_in(c));
    }
    STEP(DIV_REAL_K) /* not zero */
    {
        READ(b, B);
        REAL_RESULT(krl_real_in(b) / krl_real_of_bits((uint32_t)pc->c));
    }
    STEP(NEG_REAL)
    {
        READ(b, B);
        A = krl_of_real(-krl_real_in(b));
        NEXT();
    }
    STEP(INT_TO_REAL)
    {
        READ(b, B);
        A = krl_of_real((float)krl_int_in(b));
        NEXT();
    }
    STEP(REAL_TO_INT)
    {
        READ(b, B);
        int32_t result;
        FAULT_IF(rounds(krl_real_in(b), &result), overflow);
        A = krl_of_int(result);
        NEXT();
    }
    STEP(INT_TO_CHAR)
    {
        READ(b, B);
        if (UNLIKELY((uint32_t)krl_int_in(b) > 255))
            FAULT(INADMISSIBLE);
        A = b;
        NEXT();
    }
    STEP(FUNCTION)
    {
        float result, other = 0;
        READ(b, B);
        if (pc->tag == KRL_ATAN2) {
            READ(c, C);
            other = krl_real_in(c);
        }
        fault = krl_compute((enum krl_function)pc->tag, krl_real_in(b), other, &result);
        if (UNLIKELY(fault != KRL_FINE))
            goto failed;
        A = krl_of_real(result);
        NEXT();
    }
    STEP(TEXT)
    {
        krl_call_text(machine, (enum krl_text_function)pc->tag, &machine->program.builtins[pc->b], &A);
        NEXT();
    }

    /* ---- calls */
    STEP(CALL)
    {
        const struct krl_routine *callee = &machine->routines[pc->b];
        int32_t extent = machine->extent + pc->c;
        FAULT_IF(machine->open >= machine->most_calls || callee->frame > KRL_MAX_CELLS - extent, stack);
        struct krl_call *call = &machine->calls[machine->open++];
        call->step = (int32_t)(pc + 1 - machine->steps);
        call->code = machine->code;
        call->fp = (int32_t)(fp - cells);
        call->extent = machine->extent;
        call->statement = statement;
        call->serial = machine->serial;
        fp = &A;
        call->result = (int32_t)(fp - cells);
        for (int32_t i = callee->received; i < callee->frame; i++)
            fp[i] = KRL_NOTHING;
        machine->code = pc->b;
        machine->extent = extent;
        machine->serial = callee->is_owner ? ++machine->serials : 0;
        statement = -1;
        pc = callee->entry;
        GO();
    }
    STEP(CALL_COPY)
    {
        const struct krl_routine *callee = &machine->routines[pc->b];
        int32_t extent = machine->extent + pc->c;
        FAULT_IF(machine->open >= machine->most_calls || callee->frame > KRL_MAX_CELLS - extent, stack);
        struct krl_call *call = &machine->calls[machine->open++];
        call->step = (int32_t)(pc + 1 - machine->steps);
        call->code = machine->code;
        call->fp = (int32_t)(fp - cells);
        call->extent = machine->extent;
        call->statement = statement;
        call->serial = machine->serial;
        call->result = (int32_t)(&A - cells);
        receive(machine, callee, fp + pc->d, &A);
        fp += pc->d;
        machine->code = pc->b;
        machine->extent = extent;
        machine->serial = callee->is_owner ? ++machine->serials : 0;
        statement = -1;
        pc = callee->entry;
        GO();
    }
    STEP(CHECK_CALL)
    {
        FAULT_IF(machine->open >= machine->most_calls ||
                     machine->routines[pc->b].frame > KRL_MAX_CELLS - (machine->extent + pc->c),
                 stack);
        NEXT();
    }
    STEP(RETURN_VALUE)
    {
        READ(b, B);
        if (machine->open == 0)
            goto finished;
        machine->top = machine->calls[machine->open - 1].result;
        cells[machine->top++] = b;
        goto returning;
    }
    STEP(RETURN)
    {
        if (machine->open == 0)
            goto finished;
    returning:;
        const struct krl_call *call = &machine->calls[--machine->open];
        machine->code = call->code;
        fp = cells + call->fp;
        machine->extent = call->extent;
        statement = call->statement;
        machine->serial = call->serial;
        if (UNLIKELY(call->step < 0)) {
            stopped.why = KRL_STOP_LEFT;
            goto stop;
        }
        pc = &machine->steps[call->step];
        GO();
    }
    STEP(END_ACTION)
    {
        stopped.why = KRL_STOP_ACTION;
        goto stop;
    }

    /* ---- the rest */
    STEP(AT)
    {
        statement = pc->b;
        NEXT();
    }
    STEP(FAIL)
    {
        fault = pc->b;
        goto failed;
    }
    STEP(REMEMBER_LOCAL)
    {
        machine->last = (int32_t)(&A - cells);
        NEXT();
    }
    STEP(REMEMBER_DATA)
    {
        machine->last = pc->a;
        NEXT();
    }
    STEP(PYTHON)
    {
        machine->top = (int32_t)(&A - cells);
        stopped.at = (int32_t)(pc - machine->steps);
        goto stop;
    }
#if !KRL_THREADED
    default:
        goto finished; /* there is no such step */
    dispatch:
        number_of_case = 2 * pc->op + (pc->statement >= 0);
        continue;
#endif
    }
    }

finished:
    stopped.why = KRL_STOP_END;
    goto stop;
wait:
    stopped.why = KRL_STOP_LINE;
    stopped.at = (int32_t)(pc - machine->steps);
    goto stop;
uninitialised:
    FAULT(UNINITIALISED);
overflow:
    FAULT(OVERFLOW);
division_by_zero:
    FAULT(DIVISION_BY_ZERO);
index_:
    FAULT(INDEX);
stack:
    FAULT(STACK);
failed:
    stopped.why = KRL_STOP_FAULT;
    stopped.at = fault;
stop:
    machine->fp = (int32_t)(fp - cells);
    machine->left = left;
    machine->statement = statement;
    return stopped;
}

struct krl_stopped krl_run(struct krl_machine *machine, int32_t step, int is_begun)
{
    return interpret(machine, step, is_begun, NULL);
}

void krl_thread(struct krl_step *steps, int32_t count)
{
#if KRL_THREADED
    const void *const *labels;
    interpret(NULL, 0, 0, &labels);
    for (int32_t i = 0; i < count; i++)
        steps[i].handler = labels[2 * steps[i].op + (steps[i].statement >= 0)];
#else
    (void)steps;
    (void)count;
#endif
}
