int work(int n)
{
    int i = 0, even = 0;
again:
    if (i >= n)
        goto done;
    i++;
    if ((i & 1) == 1)
        goto again;
    even++;
    goto again;
done:
    return even;
}
