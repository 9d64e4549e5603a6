/* Functions of numbers and poses, as in interp/values/builtins.py and interp/values/frames.py.
 *
 * Everything is computed in double precision, in the same order as there, and each result is
 * rounded to single precision once.
 */
#include "machine.h"

#include <math.h>

static const double PI = 3.141592653589793;
#define DEGREE (PI / 180.0)
#define RADIAN (180.0 / PI)

/* The x axis of a pose counts as vertical if its projection onto the xy plane, which has length 0
 * to 1, is shorter than this. */
static const double UPRIGHT = 1e-6;

/* Converts degrees [FCT-02] to radians, modulo 360 first: that is exact for large angles. */
static double radians(double degrees)
{
    return fmod(degrees, 360.0) * DEGREE;
}

/* Rounds to single precision. Returns a fault if the result is not finite. */
static int single(double wide, float *result)
{
    *result = (float)wide;
    return krl_is_finite(*result) ? KRL_FINE : KRL_FAULT_OVERFLOW;
}

enum krl_function krl_function_of(struct krl_text name, int32_t arguments)
{
    static const char *const names[] = {"ABS", "SQRT", "SIN", "COS", "TAN", "ACOS", "ATAN2"};
    for (int function = KRL_ABS; function < KRL_FUNCTIONS; function++)
        if (name.length == strlen(names[function]) &&
            memcmp(name.bytes, names[function], name.length) == 0 &&
            arguments == (function == KRL_ATAN2 ? 2 : 1))
            return (enum krl_function)function;
    return KRL_FUNCTIONS;
}

int krl_compute(enum krl_function function, float one, float other, float *result)
{
    double number = one;
    switch (function) {
    case KRL_SIN:
        return single(sin(radians(number)), result);
    case KRL_COS:
        return single(cos(radians(number)), result);
    case KRL_TAN:
        if (fabs(fmod(number, 180.0)) == 90.0)
            return KRL_FAULT_DOMAIN;
        return single(tan(radians(number)), result);
    case KRL_ACOS:
        if (!(number >= -1 && number <= 1))
            return KRL_FAULT_DOMAIN;
        return single(acos(number) * RADIAN, result);
    case KRL_ATAN2:
        if (one == 0 && other == 0)
            return KRL_FAULT_DOMAIN;
        return single(atan2(number, other) * RADIAN, result);
    case KRL_ABS: case KRL_SQRT: /* the step FUNCTION computes these */
    case KRL_FUNCTIONS:
        break;
    }
    return KRL_FAULT_OPERAND;
}

/* ---------------------------------------------------------------------------- poses */

/* Reads X, Y, Z, A, B, C (mm and degrees), the first cells of every pose. Returns a fault if one
 * has no value. */
static int read_pose(const krl_cell *cells, double *pose)
{
    for (int i = 0; i < 6; i++) {
        if (cells[i] == KRL_NOTHING)
            return KRL_FAULT_UNINITIALISED;
        pose[i] = krl_real_in(cells[i]);
    }
    return KRL_FINE;
}

static void write_pose(krl_cell *cells, const float *pose)
{
    for (int i = 0; i < 6; i++)
        cells[i] = krl_of_real(pose[i]);
}

static void rotation(const double *pose, double *m)
{
    double a = radians(pose[3]), b = radians(pose[4]), c = radians(pose[5]);
    double sin_a = sin(a), cos_a = cos(a);
    double sin_b = sin(b), cos_b = cos(b);
    double sin_c = sin(c), cos_c = cos(c);
    m[0] = cos_a * cos_b;
    m[1] = cos_a * sin_b * sin_c - sin_a * cos_c;
    m[2] = cos_a * sin_b * cos_c + sin_a * sin_c;
    m[3] = sin_a * cos_b;
    m[4] = sin_a * sin_b * sin_c + cos_a * cos_c;
    m[5] = sin_a * sin_b * cos_c - cos_a * sin_c;
    m[6] = -sin_b;
    m[7] = cos_b * sin_c;
    m[8] = cos_b * cos_c;
}

static float angle(double radians)
{
    float degrees = (float)(radians * RADIAN);
    return degrees == -180.0f ? 180.0f : degrees + 0.0f;
}

/* Computes A, B, C [ARI-09], in degrees, from a rotation matrix. */
static void angles(const double *m, float *result)
{
    double across = m[3], along = m[0];
    if (sqrt(along * along + across * across) < UPRIGHT) {
        across = 0.0;
        along = 1.0;
    }
    double a = atan2(across, along);
    double sin_a = sin(a), cos_a = cos(a);
    double b = atan2(-m[6], cos_a * m[0] + sin_a * m[3]);
    double c = atan2(sin_a * m[2] - cos_a * m[5], cos_a * m[4] - sin_a * m[1]);
    result[0] = angle(a);
    result[1] = angle(b);
    result[2] = angle(c);
}

static void turned(const double *m, const double *place, double *result)
{
    for (int row = 0; row < 3; row++, m += 3)
        result[row] = m[0] * place[0] + m[1] * place[1] + m[2] * place[2];
}

int krl_compose(krl_cell *target, const krl_cell *left, const krl_cell *right, int32_t size)
{
    double one[6], other[6], m[9], n[9], product[9], place[3];
    float result[6];
    if (read_pose(left, one) != KRL_FINE || read_pose(right, other) != KRL_FINE)
        return KRL_FAULT_UNINITIALISED;
    rotation(one, m);
    rotation(other, n);
    turned(m, other, place);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            product[3 * row + column] = m[3 * row] * n[column] + m[3 * row + 1] * n[3 + column] +
                                        m[3 * row + 2] * n[6 + column];
    for (int i = 0; i < 3; i++)
        if (single(one[i] + place[i], &result[i]) != KRL_FINE)
            return KRL_FAULT_OVERFLOW;
    angles(product, result + 3);
    memmove(target, right, (size_t)size * sizeof *target);
    write_pose(target, result);
    return KRL_FINE;
}

int krl_invert(krl_cell *target, const krl_cell *pose, int32_t size)
{
    double one[6], m[9], place[3];
    float result[6];
    if (read_pose(pose, one) != KRL_FINE)
        return KRL_FAULT_UNINITIALISED;
    rotation(one, m);
    double back[9] = {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
    turned(back, one, place);
    for (int i = 0; i < 3; i++)
        if (single(-place[i], &result[i]) != KRL_FINE)
            return KRL_FAULT_OVERFLOW;
    angles(back, result + 3);
    write_pose(target, result);
    memset(target + 6, 0, (size_t)(size - 6) * sizeof *target);
    return KRL_FINE;
}
