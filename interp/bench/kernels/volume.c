static int c[11][11][11];

int work(int n)
{
    int sum = 0;
    for (int x = 1; x <= 10; x++)
        for (int y = 1; y <= 10; y++)
            for (int z = 1; z <= 10; z++)
                c[x][y][z] = x * y + z;
    for (int round = 1; round <= n; round++) {
        sum = 0;
        for (int x = 2; x <= 9; x++)
            for (int y = 2; y <= 9; y++)
                for (int z = 2; z <= 9; z++) {
                    c[x][y][z] = (c[x - 1][y][z] + c[x + 1][y][z] + c[x][y - 1][z] + c[x][y + 1][z]
                                  + c[x][y][z - 1] + c[x][y][z + 1]) / 6;
                    sum += c[x][y][z];
                }
    }
    return sum;
}
