/* The machine as a Python type, for interp/native/machine.py only.
 *
 * `Core` gives access to the current frame, the open calls and all cells. Methods raise IndexError
 * for an index out of range. The attribute `top` and the addresses in cells are not checked: the
 * caller has to keep them valid.
 */
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <stdlib.h>
#include <structmember.h>

#include "load.h"
#include "vm/register_code.h"

#if defined(__unix__) || defined(__APPLE__)
#include <dlfcn.h>
#define HAS_LIBRARIES 1
#else
#define HAS_LIBRARIES 0
#endif

struct core {
    PyObject_HEAD
    struct krl_machine machine;
};

/* The type. A static variable, as the module is loaded into one interpreter only. */
static PyTypeObject *core_type;

static int is_ready(struct core *core)
{
    if (krl_ready(&core->machine))
        return 1;
    PyErr_SetString(PyExc_MemoryError, "there is not enough memory for this depth of calls");
    return 0;
}

static PyObject *core_new(PyTypeObject *type, PyObject *arguments, PyObject *keywords)
{
    static char *names[] = {"image", "depths", "traced", "most_calls", "beside", NULL};
    const char *image, *depths;
    Py_ssize_t length, depths_length;
    int traced, most_calls;
    PyObject *beside;
    if (!PyArg_ParseTupleAndKeywords(arguments, keywords, "y#y#iiO", names, &image, &length, &depths,
                                     &depths_length, &traced, &most_calls, &beside))
        return NULL;
    if (beside != Py_None && !PyObject_TypeCheck(beside, core_type)) {
        PyErr_SetString(PyExc_TypeError, "beside must be a machine or None");
        return NULL;
    }
    allocfunc allocate = (allocfunc)PyType_GetSlot(type, Py_tp_alloc);
    struct core *core = (struct core *)allocate(type, 0);
    if (core == NULL)
        return NULL;
    if (!krl_load_image(&core->machine, (const uint8_t *)image, (const int32_t *)(const void *)depths,
                        (size_t)depths_length / sizeof(int32_t), traced)) {
        Py_DECREF(core);
        PyErr_SetString(PyExc_MemoryError, "there is not enough memory for the program, or the depths are another's");
        return NULL;
    }
    struct krl_machine *other = beside == Py_None ? NULL : &((struct core *)beside)->machine;
    if (!krl_give_memory(&core->machine, most_calls, other)) {
        Py_DECREF(core);
        PyErr_SetString(PyExc_MemoryError, "there is not enough memory for this depth of calls, or the images differ");
        return NULL;
    }
    core->machine.fp = core->machine.first;
    return (PyObject *)core;
}

static void core_dealloc(PyObject *self)
{
    PyTypeObject *type = Py_TYPE(self);
    freefunc release = (freefunc)PyType_GetSlot(type, Py_tp_free);
    krl_unload(&((struct core *)self)->machine);
    release(self);
    Py_DECREF(type);
}

/* ---------------------------------------------------------------------------- cells */

static PyObject *object_of(krl_cell cell)
{
    switch (krl_tag_of(cell)) {
    case KRL_TAG_INT:
        return PyLong_FromLong(krl_int_in(cell));
    case KRL_TAG_REAL:
        return PyFloat_FromDouble(krl_real_in(cell));
    case KRL_TAG_BOOL:
        return PyBool_FromLong(krl_int_in(cell));
    case KRL_TAG_NONE:
        break;
    }
    Py_RETURN_NONE;
}

/* Converts None, a bool, a float or an int to a cell. Returns 0 with an exception for any other
 * object and for an int of more than 32 bits. */
static int cell_of(PyObject *object, krl_cell *cell)
{
    if (object == Py_None)
        *cell = KRL_NOTHING;
    else if (PyBool_Check(object))
        *cell = krl_of_bool(object == Py_True);
    else if (PyFloat_Check(object))
        *cell = krl_of_real((float)PyFloat_AsDouble(object));
    else {
        long number = PyLong_AsLong(object);
        if (number == -1 && PyErr_Occurred())
            return 0;
        if (number < INT32_MIN || number > INT32_MAX) {
            PyErr_SetString(PyExc_OverflowError, "a cell has 32 bits");
            return 0;
        }
        *cell = krl_of_int((int32_t)number);
    }
    return 1;
}

/* Returns the cell that an index names; -1 with an exception if there is none. */
static Py_ssize_t place_of(struct core *core, PyObject *key)
{
    Py_ssize_t place = PyNumber_AsSsize_t(key, PyExc_IndexError);
    if (place == -1 && PyErr_Occurred())
        return -1;
    if (place < 0 || place >= core->machine.memory->count) {
        PyErr_SetString(PyExc_IndexError, "there is no such cell");
        return -1;
    }
    return place;
}

/* Sets the first cell and the number of cells of a slice. Returns 0 with an exception if its step
 * is not 1. */
static int range_of(struct core *core, PyObject *key, Py_ssize_t *start, Py_ssize_t *count)
{
    Py_ssize_t stop, step;
    if (PySlice_Unpack(key, start, &stop, &step) < 0)
        return 0;
    if (step != 1) {
        PyErr_SetString(PyExc_ValueError, "a slice of cells must have the step 1");
        return 0;
    }
    *count = PySlice_AdjustIndices(core->machine.memory->count, start, &stop, step);
    return 1;
}

static PyObject *core_get(PyObject *self, PyObject *key)
{
    struct core *core = (struct core *)self;
    Py_ssize_t start, count;
    if (!PySlice_Check(key)) {
        start = place_of(core, key);
        return start < 0 ? NULL : object_of(core->machine.memory->cells[start]);
    }
    if (!range_of(core, key, &start, &count))
        return NULL;
    PyObject *found = PyList_New(count);
    for (Py_ssize_t i = 0; found != NULL && i < count; i++) {
        PyObject *object = object_of(core->machine.memory->cells[start + i]);
        if (object == NULL || PyList_SetItem(found, i, object) < 0)
            Py_CLEAR(found);
    }
    return found;
}

static int core_set(PyObject *self, PyObject *key, PyObject *value)
{
    struct core *core = (struct core *)self;
    Py_ssize_t start, count;
    if (value == NULL) {
        PyErr_SetString(PyExc_TypeError, "cells cannot be deleted");
        return -1;
    }
    if (!PySlice_Check(key)) {
        krl_cell cell;
        start = place_of(core, key);
        if (start < 0 || !cell_of(value, &cell))
            return -1;
        core->machine.memory->cells[start] = cell;
        return 0;
    }
    if (!range_of(core, key, &start, &count))
        return -1;
    if (!PyList_Check(value) || PyList_Size(value) != count) {
        PyErr_SetString(PyExc_ValueError, "a list with the same number of cells is required");
        return -1;
    }
    for (Py_ssize_t i = 0; i < count; i++) {
        krl_cell cell;
        if (!cell_of(PyList_GetItem(value, i), &cell))
            return -1;
        core->machine.memory->cells[start + i] = cell;
    }
    return 0;
}

/* ---------------------------------------------------------------------------- running */

static int is_code(struct core *core, int code)
{
    if (code >= 0 && code < core->machine.program.code_count)
        return 1;
    PyErr_SetString(PyExc_IndexError, "there is no such code object");
    return 0;
}

static PyObject *core_begin(PyObject *self, PyObject *arguments)
{
    struct core *core = (struct core *)self;
    int code;
    if (!PyArg_ParseTuple(arguments, "i", &code) || !is_code(core, code) || !is_ready(core))
        return NULL;
    krl_begin(&core->machine, code);
    Py_RETURN_NONE;
}

static PyObject *core_step(PyObject *self, PyObject *arguments)
{
    struct core *core = (struct core *)self;
    int code, place;
    if (!PyArg_ParseTuple(arguments, "ii", &code, &place) || !is_code(core, code))
        return NULL;
    const struct krl_routine *routine = &core->machine.routines[code];
    if (place < 0 || place >= routine->code->length || routine->steps[place] < 0) {
        PyErr_SetString(PyExc_IndexError, "the instruction cannot be reached");
        return NULL;
    }
    return PyLong_FromLong(routine->steps[place]);
}

static PyObject *core_about(PyObject *self, PyObject *arguments)
{
    struct core *core = (struct core *)self;
    int number;
    if (!PyArg_ParseTuple(arguments, "i", &number))
        return NULL;
    if (number < 0 || number >= core->machine.step_count) {
        PyErr_SetString(PyExc_IndexError, "there is no such step");
        return NULL;
    }
    const struct krl_step *step = &core->machine.steps[number];
    return Py_BuildValue("iii", (int)step->tag, (int)step->b, (int)step->statement);
}

static PyObject *core_run(PyObject *self, PyObject *arguments)
{
    struct core *core = (struct core *)self;
    int step, is_begun;
    if (!PyArg_ParseTuple(arguments, "ii", &step, &is_begun))
        return NULL;
    const struct krl_routine *routine = &core->machine.routines[core->machine.code];
    Py_ssize_t place = step < 0 ? -1 : core->machine.steps + step - routine->entry;
    if (place < 0 || step >= core->machine.step_count) {
        PyErr_SetString(PyExc_IndexError, "the step is not one of the code object that runs");
        return NULL;
    }
    if (!is_ready(core))
        return NULL;
    struct krl_stopped stopped = krl_run(&core->machine, step, is_begun);
    return PyLong_FromLong((long)stopped.at << 3 | (long)stopped.why);
}

static PyObject *core_open(PyObject *self, PyObject *arguments)
{
    struct core *core = (struct core *)self;
    int code;
    if (!PyArg_ParseTuple(arguments, "i", &code) || !is_code(core, code))
        return NULL;
    if (!is_ready(core))
        return NULL;
    return PyBool_FromLong(krl_open(&core->machine, code));
}

static PyObject *core_close(PyObject *self, PyObject *Py_UNUSED(ignored))
{
    struct core *core = (struct core *)self;
    if (core->machine.open == 0) {
        PyErr_SetString(PyExc_IndexError, "no call is open");
        return NULL;
    }
    krl_close(&core->machine);
    Py_RETURN_NONE;
}

/* Returns code object, first cell, statement and serial number of the frame that an open call
 * returns to. The outermost call is 0. */
static PyObject *core_call(PyObject *self, PyObject *arguments)
{
    const struct krl_machine *machine = &((struct core *)self)->machine;
    int number;
    if (!PyArg_ParseTuple(arguments, "i", &number))
        return NULL;
    if (number < 0 || number >= machine->open) {
        PyErr_SetString(PyExc_IndexError, "there is no such call");
        return NULL;
    }
    const struct krl_call *call = &machine->calls[number];
    return Py_BuildValue("iiii", (int)call->code, (int)call->fp, (int)call->statement, (int)call->serial);
}

/* Returns the first cell of the frame with a serial number, or None if its routine has ended. */
static PyObject *core_frame_of(PyObject *self, PyObject *arguments)
{
    const struct krl_machine *machine = &((struct core *)self)->machine;
    int serial;
    if (!PyArg_ParseTuple(arguments, "i", &serial))
        return NULL;
    if (machine->serial == serial)
        return PyLong_FromLong(machine->fp);
    for (int32_t i = machine->open - 1; i >= 0; i--)
        if (machine->calls[i].serial == serial)
            return PyLong_FromLong(machine->calls[i].fp);
    Py_RETURN_NONE;
}

/* Returns the first cell of the current frame's operand stack. */
static PyObject *core_floor(PyObject *self, void *Py_UNUSED(closure))
{
    const struct krl_machine *machine = &((struct core *)self)->machine;
    return PyLong_FromLong(machine->fp + machine->routines[machine->code].frame);
}

/* Returns a snapshot of all that determines how the run continues: the current frame, the open
 * calls, the cells of the data lists and those of the frames. */
static PyObject *core_snapshot(PyObject *self, PyObject *Py_UNUSED(ignored))
{
    const struct krl_machine *machine = &((struct core *)self)->machine;
    const krl_cell *cells = machine->memory->cells;
    const int32_t frame[] = {machine->code, machine->fp, machine->extent, machine->statement,
                             machine->serial, machine->serials, machine->left, machine->quota,
                             machine->whole, machine->stops, machine->top};
    const Py_ssize_t cell = (Py_ssize_t)sizeof *cells;
    return Py_BuildValue("y#y#y#y#", (const char *)frame, (Py_ssize_t)sizeof frame, (const char *)machine->calls,
                         (Py_ssize_t)sizeof *machine->calls * machine->open, (const char *)cells,
                         cell * machine->program.data_cells, (const char *)(cells + machine->first),
                         cell * (machine->top - machine->first));
}

/* ---------------------------------------------------------------------------- register code */

static const char *const step_names[] = {
#define STEP_NAME(name) #name,
    KRL_STEPS(STEP_NAME)
#undef STEP_NAME
};

/* Returns all steps as tuples, with step numbers for the targets of jumps. */
static PyObject *core_steps(PyObject *self, PyObject *Py_UNUSED(ignored))
{
    const struct krl_machine *machine = &((struct core *)self)->machine;
    PyObject *found = PyList_New(machine->step_count);
    for (int32_t i = 0; found != NULL && i < machine->step_count; i++) {
        const struct krl_step *step = &machine->steps[i];
        int32_t d = KRL_IS_JUMP(step->op) ? i + step->d / (int32_t)sizeof *step : step->d;
        int32_t e = KRL_IS_THREE(step->op) ? machine->arrays[step->c].third : (int32_t)((uint32_t)step->c + 1);
        PyObject *one = Py_BuildValue("siiiiiii", step_names[step->op], (int)step->a, (int)step->b, (int)step->c,
                                      (int)d, (int)step->tag, (int)step->statement, (int)e);
        if (one == NULL || PyList_SetItem(found, i, one) < 0)
            Py_CLEAR(found);
    }
    return found;
}

/* Returns the table of arrays as tuples: base, width, dimensions, three sizes, and the register of
 * a third index. */
static PyObject *core_arrays(PyObject *self, PyObject *Py_UNUSED(ignored))
{
    const struct krl_machine *machine = &((struct core *)self)->machine;
    PyObject *found = PyList_New(machine->array_count);
    for (int32_t i = 0; found != NULL && i < machine->array_count; i++) {
        const struct krl_array *array = &machine->arrays[i];
        PyObject *one = Py_BuildValue("iiiiiii", (int)array->base, (int)array->width, (int)array->dimensions,
                                      (int)array->sizes[0], (int)array->sizes[1], (int)array->sizes[2],
                                      (int)array->third);
        if (one == NULL || PyList_SetItem(found, i, one) < 0)
            Py_CLEAR(found);
    }
    return found;
}

static void enter_compiled(struct krl_machine *machine)
{
    for (const int32_t *entry = machine->entries; entry != NULL && *entry >= 0; entry++)
        if (*entry < machine->step_count)
            krl_stop_at(&machine->steps[*entry], KRL_STOP_COMPILED);
}

/* Replaces all breakpoints and returns their number. While there are any, native code is not
 * entered. Skips steps at which no statement begins, and invalid conditions. */
static PyObject *core_break_at(PyObject *self, PyObject *arguments)
{
    struct krl_machine *machine = &((struct core *)self)->machine;
    PyObject *places;
    if (!PyArg_ParseTuple(arguments, "O!", &PyList_Type, &places))
        return NULL;
    krl_thread(machine->steps, machine->step_count);
    free(machine->breaks);
    machine->break_count = 0;
    machine->breaks = malloc(((size_t)PyList_Size(places) + 1) * sizeof *machine->breaks);
    if (machine->breaks == NULL)
        return PyErr_NoMemory();
    for (Py_ssize_t i = 0; i < PyList_Size(places); i++) {
        struct krl_break one;
        PyObject *right;
        if (!PyArg_ParseTuple(PyList_GetItem(places, i), "iiipO", &one.step, &one.relation, &one.cell,
                              &one.is_of_frame, &right) || !cell_of(right, &one.right))
            return NULL;
        if (one.step < 0 || one.step >= machine->step_count || machine->steps[one.step].statement < 0 ||
            one.relation >= 6 || one.cell < 0 || one.cell >= machine->memory->count)
            continue;
        krl_stop_at(&machine->steps[one.step], KRL_STOP_BREAK);
        machine->breaks[machine->break_count++] = one;
    }
    if (machine->break_count == 0)
        enter_compiled(machine);
    return PyLong_FromLong(machine->break_count);
}

/* Loads a shared object that was compiled from the steps of this machine; its native code runs from
 * now on. The library is never unloaded. Raises OSError if it cannot be loaded. */
static PyObject *core_load(PyObject *self, PyObject *arguments)
{
    static const struct krl_outside outside = {krl_is_plain, krl_compute, krl_compose, krl_invert, krl_call_text};
    struct krl_machine *machine = &((struct core *)self)->machine;
    const char *path;
    if (!PyArg_ParseTuple(arguments, "s", &path))
        return NULL;
#if HAS_LIBRARIES
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const uint32_t *layout = library == NULL ? NULL : dlsym(library, "krl_layout");
    const int32_t *entries = library == NULL ? NULL : dlsym(library, "krl_entries");
    if (layout == NULL || entries == NULL || *layout != KRL_LAYOUT) {
        PyErr_SetString(PyExc_OSError, library == NULL ? dlerror() : "it was compiled for another machine");
        return NULL;
    }
    *(void **)&machine->compiled = dlsym(library, "krl_go");
    machine->outside = &outside;
    machine->entries = entries;
    enter_compiled(machine);
    Py_RETURN_NONE;
#else
    (void)outside, (void)machine;
    PyErr_SetString(PyExc_OSError, "this system has no shared objects");
    return NULL;
#endif
}

/* ---------------------------------------------------------------------------- the type */

static PyMethodDef core_methods[] = {
    {"begin", core_begin, METH_VARARGS, "begin(code): open the first frame, whose cells have no values."},
    {"step", core_step, METH_VARARGS, "step(code, place): the step of an instruction, which must be a jump target."},
    {"about", core_about, METH_VARARGS, "about(step): kind of stop, instruction, and LINE or -1."},
    {"run", core_run, METH_VARARGS, "run(step, is_begun): 8 times the step where it stopped, plus the reason."},
    {"snapshot", core_snapshot, METH_NOARGS, "snapshot(): the complete state as bytes: frame, calls, data, stack."},
    {"open_frame", core_open, METH_VARARGS, "open_frame(code): open a frame; False if there is no room."},
    {"close_frame", core_close, METH_NOARGS, "close_frame(): return to the previous frame."},
    {"call", core_call, METH_VARARGS, "call(number): code, first cell, statement, serial of an open call."},
    {"frame_of", core_frame_of, METH_VARARGS, "frame_of(serial): first cell of an open frame, or None."},
    {"steps", core_steps, METH_NOARGS, "steps(): name, a, b, c, d, tag, LINE and e of each step."},
    {"arrays", core_arrays, METH_NOARGS, "arrays(): base, width, dimensions, three sizes, register of the third index of each."},
    {"break_at", core_break_at, METH_VARARGS, "break_at(steps): set breakpoints; return how many could be set."},
    {"load", core_load, METH_VARARGS, "load(library): run the native code of these steps."},
    {NULL, NULL, 0, NULL},
};

#define MEMBER(name, flags) {#name, T_INT, offsetof(struct core, machine.name), flags, NULL}
static PyMemberDef core_members[] = {
    MEMBER(code, READONLY),   MEMBER(fp, READONLY), MEMBER(serial, READONLY), MEMBER(open, READONLY),
    MEMBER(statement, 0),     MEMBER(left, 0),      MEMBER(last, 0),          MEMBER(top, 0),
    MEMBER(most_calls, 0),    MEMBER(quota, 0),     MEMBER(whole, 0),         MEMBER(stops, 0),
    MEMBER(functions, 0),     MEMBER(traced, READONLY),
    {NULL, 0, 0, 0, NULL},
};

static PyGetSetDef core_getset[] = {
    {"floor", core_floor, NULL, "the first cell of the operand stack of the running frame", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot core_slots[] = {
    {Py_tp_doc, "A program ready to run, and its memory. Core(image, depths, traced, most_calls, beside)."},
    {Py_tp_new, core_new},
    {Py_tp_dealloc, core_dealloc},
    {Py_tp_methods, core_methods},
    {Py_tp_members, core_members},
    {Py_tp_getset, core_getset},
    {Py_mp_subscript, core_get},
    {Py_mp_ass_subscript, core_set},
    {0, NULL},
};

static PyType_Spec core_spec = {
    "interp.native._core.Core", sizeof(struct core), 0, Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, core_slots,
};

static int execute(PyObject *module)
{
    core_type = (PyTypeObject *)PyType_FromSpec(&core_spec);
    return core_type == NULL ? -1 : PyModule_AddObjectRef(module, "Core", (PyObject *)core_type);
}

static PyModuleDef_Slot module_slots[] = {
    {Py_mod_exec, execute},
    {0, NULL},
};

static struct PyModuleDef definition = {
    PyModuleDef_HEAD_INIT, "_core", "The bytecode machine in C.", 0, NULL, module_slots, NULL, NULL, NULL,
};

PyMODINIT_FUNC PyInit__core(void)
{
    return PyModuleDef_Init(&definition);
}
