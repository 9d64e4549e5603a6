#include <stdio.h>
#include <string.h>

int work(int n)
{
    const char *word = "part";
    char line[81];
    int sum = 0;
    for (int i = 1; i <= n; i++) {
        int place = snprintf(line, sizeof line, "%s %4d: %8.3f|%-6d", word, i, (double)((float)i * 0.37f), 0);
        sum += place + (int)strlen(line);
    }
    return sum;
}
