enum light { RED, AMBER, GREEN };

struct seen {
    enum light last;
    int times, busy;
};

int work(int n)
{
    struct seen lanes[5] = {0};
    enum light now = RED;
    int passed = 0, k = 1;
    for (int i = 1; i <= n; i++) {
        switch (now) {
        case RED: now = GREEN; break;
        case GREEN: now = AMBER; passed++; break;
        case AMBER: now = RED; break;
        }
        lanes[k].busy = now == GREEN && lanes[k].last != GREEN;
        lanes[k].last = now;
        if (lanes[k].busy || now == RED)
            lanes[k].times++;
        if (++k > 4)
            k = 1;
    }
    return passed + lanes[1].times + lanes[4].times;
}
