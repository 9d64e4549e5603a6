static int twice(int x)
{
    return x + x + 2;
}

static int lesser(int x, int y)
{
    return x < y ? x : y;
}

static void count_down(int *x)
{
    --*x;
}

int work(int n)
{
    int sum = 0;
    for (int i = 1; i <= n; i++) {
        sum = lesser(i, twice(sum));
        count_down(&sum);
    }
    return sum;
}
