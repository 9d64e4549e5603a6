int work(int n)
{
    int sum = 1, code = 1;
    for (int i = 1; i <= n; i++)
        switch (code) {
        case 1: sum += 3; code = 4; break;
        case 2: sum -= 1; code = 7; break;
        case 3: sum *= 2; code = 6; break;
        case 4: case 5: sum += code; code -= 2; break;
        case 6: code = 8; break;
        case 7: sum /= 3; code = 5; break;
        default: code = 1;
        }
    return sum;
}
