#include <string.h>

int work(int n)
{
    char line[81];
    int sum = 0;
    for (int i = 1; i <= n; i++) {
        line[0] = 0;
        for (int k = 1; k <= 40; k++) {
            strcat(line, "AB");
            sum += (int)strlen(line) - k;
        }
    }
    return sum / n + (int)strlen(line);
}
