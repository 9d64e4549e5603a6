static float a[25][25], b[25][25], c[25][25];

int work(int n)
{
    for (int i = 1; i <= n; i++)
        for (int j = 1; j <= n; j++) {
            a[i][j] = i - j;
            b[i][j] = i + j;
        }
    for (int i = 1; i <= n; i++)
        for (int j = 1; j <= n; j++) {
            float sum = 0;
            for (int k = 1; k <= n; k++)
                sum += a[i][k] * b[k][j];
            c[i][j] = sum;
        }
    return c[n][1];
}
