#include <math.h>

struct frame {
    float x, y, z, a, b, c;
};

static const double degree = 0.017453292519943295;

static void matrix(const struct frame *f, double m[3][3])
{
    double ca = cos(f->a * degree), sa = sin(f->a * degree);
    double cb = cos(f->b * degree), sb = sin(f->b * degree);
    double cc = cos(f->c * degree), sc = sin(f->c * degree);
    double made[3][3] = {{ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc},
                         {sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc},
                         {-sb, cb * sc, cb * cc}};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            m[i][k] = made[i][k];
}

static struct frame compose(const struct frame *one, const struct frame *other)
{
    double left[3][3], right[3][3], m[3][3], moved[3];
    matrix(one, left);
    matrix(other, right);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            m[i][k] = left[i][0] * right[0][k] + left[i][1] * right[1][k] + left[i][2] * right[2][k];
        moved[i] = left[i][0] * other->x + left[i][1] * other->y + left[i][2] * other->z;
    }
    double flat = sqrt(m[0][0] * m[0][0] + m[1][0] * m[1][0]);
    double a = flat > 1e-7 ? atan2(m[1][0], m[0][0]) : 0;
    double c = flat > 1e-7 ? atan2(m[2][1], m[2][2]) : atan2(-m[1][2], m[1][1]);
    return (struct frame){one->x + moved[0], one->y + moved[1], one->z + moved[2],
                          a / degree, atan2(-m[2][0], flat) / degree, c / degree};
}

int work(int n)
{
    struct frame at = {100, 0, 50, 0, 0, 0}, step = {8, 4, 0, 90, 0, 0}, back = {0, 0, -1, 0, 0, 90};
    for (int i = 1; i <= n; i++) {
        at = compose(&at, &step);
        if (at.z > 0)
            at = compose(&at, &back);
    }
    return (int)floorf(at.x + at.y + at.z + 0.5f);
}
