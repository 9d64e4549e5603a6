/* Fuzzer of images: no image may do harm, however it is damaged.
 *
 * Damages words of an image, repairs its header and, if the image is still accepted, runs each of
 * its code objects for some statements. Replies to requests are pseudo-random, seeded by the
 * checksum of the image. At every stop, the cells of variables must hold values of their types:
 * this finds wrong stores that sanitizers cannot see.
 *
 * With KRL_LIBFUZZER this is a target of libFuzzer, otherwise a program:
 * krl_fuzz SECONDS SEED IMAGE...
 */
#include "image/reader.h"
#include "load.h"
#include "vm/register_code.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { STATEMENTS = 300, PER_SLICE = 40, STOPS = 400, DEPTH = 8, MOST_BREAKS = 64, LARGEST = 1 << 16 };

static uint64_t images, accepted, runs, stops, faults;

/* ---------------------------------------------------------------------------- random numbers */

static uint32_t state = 1;

static uint32_t draw(uint32_t below)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state % below;
}

static krl_cell drawn_cell(const struct krl_program *program, int32_t type)
{
    static const int32_t numbers[] = {0, 1, 2, 3, -1, 8, 100, INT32_MAX, INT32_MIN};
    static const float reals[] = {0, 1, -1, 0.5f, 90, 180, 1e-40f, FLT_MAX, -FLT_MAX};
    if (draw(8) == 0)
        return KRL_NOTHING;
    switch (type) {
    case KRL_TYPE_INT:
        return krl_of_int(numbers[draw(9)]);
    case KRL_TYPE_REAL:
        return krl_of_real(reals[draw(9)]);
    case KRL_TYPE_BOOL:
        return krl_of_bool((int)draw(2));
    case KRL_TYPE_CHAR:
        return krl_of_int((int32_t)draw(256));
    default:
        return krl_of_int((int32_t)draw((uint32_t)program->types[type].count));
    }
}

static void draw_cells(struct krl_machine *machine, int32_t address, int32_t type)
{
    for (int32_t i = 0; i < machine->program.types[type].size; i++)
        machine->cells[address + i] = drawn_cell(&machine->program, krl_kind_at(&machine->program, type, i));
}

/* ---------------------------------------------------------------------------- invariants */

static void check_variable(const struct krl_machine *machine, int32_t address, int32_t type)
{
    /* At most 64 cells of a variable are checked, evenly spaced. */
    int32_t size = machine->program.types[type].size, stride = 1 + size / 64;
    for (int32_t i = 0; i < size; i += stride) {
        krl_cell cell = machine->cells[address + i];
        int32_t kind = krl_kind_at(&machine->program, type, i);
        if (cell != KRL_NOTHING &&
            (!krl_is_word_of(&machine->program, krl_int_in(cell), kind) ||
             krl_cell_of_word(krl_int_in(cell), kind) != cell)) {
            fprintf(stderr, "cell %d of type %d holds %llx\n", address + i, kind, (unsigned long long)cell);
            abort();
        }
    }
}

static void check_cells(const struct krl_machine *machine)
{
    const struct krl_program *program = &machine->program;
    const struct krl_code *code = &program->codes[machine->code];
    for (int32_t i = 0; i < program->data_count; i++)
        check_variable(machine, program->data[i].address, program->data[i].type);
    for (int32_t i = 0; i < code->slot_count; i++)
        if (code->slots[i].passed.mode == KRL_BY_VALUE)
            check_variable(machine, machine->fp + code->slots[i].offset, code->slots[i].passed.type);
}

/* ---------------------------------------------------------------------------- requests and interrupts */

/* Replies to a request or a call of a predefined function: pops its inputs, stores a random result,
 * and sometimes changes the variables that it has references to. */
static void answer(struct krl_machine *machine, const struct krl_entry *entry)
{
    int is_large = entry->result >= 0 && !krl_is_plain(&machine->program, entry->result);
    krl_cell *top = machine->cells + machine->top;
    if (is_large)
        draw_cells(machine, krl_int_in(*--top), entry->result);
    for (int32_t i = entry->input_count - 1; i >= 0; i--) {
        top -= krl_stack_cells(&entry->inputs[i]);
        if (entry->inputs[i].mode == KRL_BY_REFERENCE && draw(4) == 0)
            draw_cells(machine, krl_int_in(*top), entry->inputs[i].type);
    }
    if (entry->result >= 0 && !is_large) {
        krl_cell result = drawn_cell(&machine->program, entry->result);
        *top++ = result == KRL_NOTHING ? krl_cell_of_word(0, entry->result) : result;
    }
    machine->top = (int32_t)(top - machine->cells);
}

/* Returns a random action or condition of the current code object, or -1 if the number that is
 * drawn is none. */
static int32_t owned(const struct krl_machine *machine)
{
    int32_t number = (int32_t)draw((uint32_t)machine->program.code_count);
    return machine->program.codes[number].owner == machine->code ? number : -1;
}

static void run(struct krl_machine *machine, int32_t step, int depth, int *statements);

/* Runs an action or a condition in a frame of its own, which is closed afterwards. At most three
 * are nested. */
static void interrupt(struct krl_machine *machine, int depth, int *statements)
{
    int32_t number = depth < 3 ? owned(machine) : -1, open = machine->open, top = machine->top;
    if (number < 0 || !krl_open(machine, number))
        return;
    machine->most_calls++;
    run(machine, (int32_t)(machine->routines[number].entry - machine->steps), depth + 1, statements);
    while (machine->open > open)
        krl_close(machine);
    machine->most_calls--;
    machine->top = top; /* drops the result of a condition */
}

/* Returns the step where the routine continues if the current statement ends early; -1 if no
 * statement has begun. */
static int32_t behind(const struct krl_machine *machine)
{
    const struct krl_code *code = &machine->program.codes[machine->code];
    if (machine->statement < 0)
        return -1;
    return machine->routines[machine->code].steps[code->body[machine->statement].operands[1]];
}

/* Runs from a step until the code object ends, a fault is not handled, the budget of statements is
 * used up, or it has stopped STOPS times. `depth` counts nested interrupts. */
static void run(struct krl_machine *machine, int32_t step, int depth, int *statements)
{
    int is_begun = 0, open = machine->open;
    for (int i = 0; i < STOPS; i++) {
        if (!krl_ready(machine))
            abort();
        struct krl_stopped stopped = krl_run(machine, step, is_begun);
        is_begun = 0;
        stops++;
        if (stopped.why == KRL_STOP_LEFT) /* the frame of a condition has ended; its caller continues */
            return;
        check_cells(machine);
        switch (stopped.why) {
        case KRL_STOP_BREAK:
        case KRL_STOP_LINE:
            *statements -= PER_SLICE;
            if (*statements <= 0)
                return;
            machine->left = PER_SLICE;
            machine->statement = machine->steps[stopped.at].statement;
            step = stopped.at;
            is_begun = 1;
            break;
        case KRL_STOP_FAULT:
            faults++;
            /* Half of the faults are handled, as by ON_ERROR_PROCEED. */
            step = draw(2) && machine->open >= open ? behind(machine) : -1;
            if (step < 0)
                return;
            break;
        case KRL_STOP_STEP: {
            const struct krl_step *at = &machine->steps[stopped.at];
            const struct krl_instruction *instruction =
                &machine->program.codes[machine->code].body[at->b];
            step = stopped.at + 1;
            if (at->tag != KRL_MATTER_INSTRUCTION)
                break;
            if (instruction->op == KRL_UNLINKED)
                return;
            if (instruction->op == KRL_LINE) {
                machine->statement = at->b;
                if (--*statements <= 0)
                    return;
            }
            machine->stops = (int32_t)draw(4);
            if (draw(4) == 0)
                interrupt(machine, depth, statements);
            if (instruction->op == KRL_ASK)
                answer(machine, &machine->program.asks[instruction->operands[0]]);
            else if (instruction->op == KRL_BUILTIN)
                answer(machine, &machine->program.builtins[instruction->operands[0]]);
            break;
        }
        default:
            return;
        }
    }
}

/* ---------------------------------------------------------------------------- images */

static void put_word(uint8_t *bytes, uint32_t word)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(word >> 8 * i);
}

/* Makes the header valid: magic, format, length and checksum. */
static void seal(uint8_t *image, size_t length)
{
    memcpy(image, KRL_IMAGE_MAGIC, 4);
    put_word(image + 4, KRL_IMAGE_FORMAT);
    put_word(image + 8, (uint32_t)length);
    put_word(image + 12, krl_checksum(image + 16, length - 16));
}

/* Changes up to four words behind the first five, which `seal` writes or the reader compares. */
static void damage(uint8_t *image, size_t length)
{
    uint32_t words = (uint32_t)(length / 4), changes = draw(3) ? 1 : 1 + draw(4);
    for (uint32_t i = 0; i < changes && words > 5; i++) {
        /* Half of the changes are in the second half of the image, which has the instructions. */
        uint32_t from = draw(2) ? words - (words - 5) / 2 - 1 : 5;
        uint8_t *place = image + 4 * (from + draw(words - from));
        switch (draw(8)) {
        case 0: put_word(place, draw(40)); break;
        case 1: put_word(place, draw(KRL_OPCODE_COUNT)); break;
        case 2: put_word(place, (uint32_t)-1 - draw(3)); break;
        case 3: put_word(place, krl_word_at(place) + draw(33) - 16); break;
        case 4: memcpy(place, image + 4 * (5 + draw(words - 5)), 4); break;
        default: put_word(place, krl_word_at(place) + draw(5) - 2); break;
        }
    }
}

static int try_image(const uint8_t *data, size_t length)
{
    static uint8_t image[LARGEST];
    struct krl_machine machine;
    struct krl_refusal why;
    if (length < 20 || length > LARGEST)
        return 0;
    memcpy(image, data, length);
    seal(image, length);
    images++;
    state = krl_checksum(image, length) | 1;
    if (!krl_load_image(&machine, image, length, (int)draw(32), &why))
        return 0;
    accepted++;
    if (!krl_give_memory(&machine, DEPTH, NULL))
        abort();
    if ((machine.breaks = calloc(MOST_BREAKS, sizeof *machine.breaks)) == NULL)
        abort();
    for (int32_t step = draw(4) ? machine.step_count : 0; step < machine.step_count; step++)
        if (machine.steps[step].statement >= 0 && draw(4) == 0 && machine.break_count < MOST_BREAKS) {
            krl_stop_at(&machine.steps[step], KRL_STOP_BREAK);
            machine.breaks[machine.break_count++] = (struct krl_break){
                step, (int32_t)draw(7) - 1, (int32_t)draw(9), (int)draw(2), krl_of_int((int32_t)draw(3))};
        }
    for (int32_t code = 0; code < machine.program.code_count; code++) {
        int statements = STATEMENTS;
        machine.fp = machine.first;
        machine.open = 0;
        if (!krl_ready(&machine))
            abort();
        krl_begin(&machine, code);
        machine.left = machine.whole = PER_SLICE;
        machine.functions = STATEMENTS;
        runs++;
        run(&machine, (int32_t)(machine.routines[code].entry - machine.steps), 0, &statements);
    }
    krl_unload(&machine);
    return 0;
}

static void report(void)
{
    fprintf(stderr, "%llu images, %llu of them accepted, %llu code objects run, %llu stops, %llu faults\n",
            (unsigned long long)images, (unsigned long long)accepted, (unsigned long long)runs,
            (unsigned long long)stops, (unsigned long long)faults);
}

#ifdef KRL_LIBFUZZER

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t largest);

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    (void)count, (void)arguments;
    atexit(report);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t largest, unsigned int seed)
{
    state = seed | 1;
    if (draw(16) == 0 || size < 24)
        size = LLVMFuzzerMutate(data, size, largest);
    else
        damage(data, size);
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return try_image(data, size);
}

#else

int main(int count, char **arguments)
{
    static uint8_t seeds[64][LARGEST];
    static size_t lengths[64];
    static uint8_t image[LARGEST];
    uint32_t seed_count = 0, seed;
    if (count < 4) {
        fprintf(stderr, "krl_fuzz SECONDS SEED IMAGE...\n");
        return 2;
    }
    for (int i = 3; i < count && seed_count < 64; i++) {
        FILE *file = fopen(arguments[i], "rb");
        if (file == NULL)
            continue;
        lengths[seed_count] = fread(seeds[seed_count], 1, LARGEST, file);
        fclose(file);
        if (lengths[seed_count] < LARGEST && lengths[seed_count] > 24)
            seed_count++;
    }
    if (seed_count == 0) {
        fprintf(stderr, "krl_fuzz: there is no image to begin with\n");
        return 2;
    }
    seed = (uint32_t)strtoul(arguments[2], NULL, 10) | 1;
    for (uint32_t i = 0; i < seed_count; i++)
        try_image(seeds[i], lengths[i]);
    for (time_t end = time(NULL) + strtol(arguments[1], NULL, 10); time(NULL) < end;) {
        for (int i = 0; i < 100; i++) {
            state = seed;
            uint32_t chosen = draw(seed_count);
            memcpy(image, seeds[chosen], lengths[chosen]);
            damage(image, lengths[chosen]);
            seed = draw(UINT32_MAX) | 1;
            try_image(image, lengths[chosen]);
        }
    }
    report();
    return 0;
}

#endif
