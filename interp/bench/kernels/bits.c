int work(int n)
{
    int state = 1, ones = 0;
    for (int i = 1; i <= n; i++) {
        state = state & 1 ? state / 2 ^ 46080 : state / 2;
        for (int rest = state & (state ^ 21845); rest != 0; rest &= rest - 1)
            ones++;
    }
    return ones;
}
