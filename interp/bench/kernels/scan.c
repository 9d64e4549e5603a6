#include <stdio.h>

int work(int n)
{
    const char *line = "  42 17.5 99";
    int sum = 0;
    for (int i = 1; i <= n; i++) {
        int first, last, place;
        float middle;
        if (sscanf(line, "%d %f %d%n", &first, &middle, &last, &place) == 3)
            sum += first + last + place;
    }
    return sum;
}
