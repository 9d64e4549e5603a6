#include <math.h>

struct frame {
    float x, y, z, a, b, c;
};

int work(int n)
{
    struct frame points[101] = {0};
    float sum = 0;
    for (int i = 1; i <= 100; i++)
        points[i] = (struct frame){.x = i, .y = 100 - i, .a = 0.5f, .b = -0.25f};
    for (int step = 1; step <= n; step++)
        for (int i = 1; i <= 100; i++) {
            struct frame *point = &points[i];
            point->x += point->a;
            point->y += point->b;
            if (point->x > 100)
                point->a = -0.5f;
            if (point->y < 0)
                point->b = 0.25f;
        }
    for (int i = 1; i <= 100; i++)
        sum += points[i].x + points[i].y;
    return (int)floorf(sum + 0.5f);
}
