static _Bool flags[8191];

int work(int n)
{
    int count = 0;
    for (int round = 1; round <= n; round++) {
        count = 0;
        for (int i = 1; i <= 8190; i++)
            flags[i] = 1;
        for (int i = 1; i <= 8190; i++)
            if (flags[i]) {
                int prime = i + i + 1;
                for (int k = i + prime; k <= 8190; k += prime)
                    flags[k] = 0;
                count++;
            }
    }
    return count;
}
