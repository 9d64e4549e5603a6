// The chart of the mending order: files that parse after mending the first n clusters.

const FIRST_STEPS = 40;

function chart() {
  const holder = byId("chart");
  const links = [...byId("steps").querySelectorAll("a")];
  const total = data.mending.length;
  const parsed = [data.parsed, ...data.mending.map(([, count]) => count)];
  const share = (count) => `${number(count)} of ${number(data.files)} parse (${percent(count, data.files)})`;
  let whole = true;

  const draw = lineChart(holder, () => {
    const values = parsed.slice(0, (whole ? total : FIRST_STEPS) + 1).map((count) => (100 * count) / data.files);
    const low = values[0] < 40 ? 0 : Math.floor(Math.min(...values) / 10) * 10 - (values[0] % 10 < 2 ? 10 : 0);
    return {
      label: `Files that parse: ${percent(data.parsed, data.files)} today, ${percent(parsed[total], data.files)} after ${counted(total, "cluster")}; the list beside the chart holds the same figures`,
      height: 250,
      series: [{ values, hue: "blue", isFilled: true }],
      y: [low, 100],
      limit: 95,
      xName: "clusters mended",
      xText: number,
      yText: (value) => `${value} %`,
      tip(n) {
        if (!n) return [el("b", "", "Today"), share(parsed[0])];
        const gain = parsed[n] - parsed[n - 1];
        return [el("b", "", `${n}. ${clusters[indexOf.get(data.mending[n - 1][0])].title}`),
          `${gain < 0 ? "−" : "+"}${counted(Math.abs(gain), "file")}, then ${share(parsed[n])}`];
      },
      point(n) {
        links.find((link) => link.classList.contains("on"))?.classList.remove("on");
        if (n) links[n - 1].classList.add("on");
      },
      open: (n) => { if (n) goTo(data.mending[n - 1][0]); },
    };
  });
  if (total > FIRST_STEPS) {
    holder.append(el("div", "range", button(`First ${FIRST_STEPS}`, (self) => {
      whole = !whole;
      self.textContent = whole ? `First ${FIRST_STEPS}` : `All ${number(total)}`;
      draw();
    })));
  }

  byId("steps").addEventListener("click", (event) => {
    const link = event.target.closest("a");
    if (!link) return;
    event.preventDefault();
    goTo(link.dataset.cluster);
  });
}
