#include <math.h>

int work(int n)
{
    float x = 0.0f, sum = 0.0f;
    for (int i = 1; i <= n; i++) {
        x += 0.0009765625f;
        if (x > 4.0f)
            x -= 4.0f;
        sum = sum * 0.9990234375f + sqrtf(x * x + 1.0f) / (x + 2.0f);
    }
    return (int)floorf(sum + 0.5f);
}
