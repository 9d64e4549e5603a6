static void add_up(int *items, int first, int last, int level, int *sum, int *deepest)
{
    if (level > *deepest)
        *deepest = level;
    if (first == last)
        *sum += items[first - 1];
    else {
        int middle = (first + last) / 2;
        add_up(items, first, middle, level + 1, sum, deepest);
        add_up(items, middle + 1, last, level + 1, sum, deepest);
    }
}

int work(int n)
{
    int items[256], sum = 0, deepest = 0;
    for (int i = 1; i <= 256; i++)
        items[i - 1] = i;
    for (int i = 1; i <= n; i++) {
        sum = 0;
        add_up(items, 1, 256, 1, &sum, &deepest);
    }
    return sum + deepest;
}
