// The charts over the steps: the parse rate, and a small chart for each metric. Pointing at a step
// marks it in all of them.

const steps = page.steps;
const last = steps.length - 1;
const open = (n) => goTo(steps[n].anchor);

function rateChart() {
  const links = new Map([...document.querySelectorAll("#biggest a")].map((link) => [link.dataset.step, link]));
  lineChart(byId("rate"), () => ({
    label: `Files that parse: ${percent(steps[0].parsed, page.files)} at the start, ${percent(steps[last].parsed, page.files)} after ${counted(last, "construct")}; the table below holds the same figures`,
    height: 300,
    series: [
      { name: "files", hue: "blue", values: steps.map((step) => (100 * step.parsed) / page.files), isFilled: true },
      { name: "bytes", hue: "mark", values: steps.map((step) => (100 * step.parsedBytes) / page.bytes) },
    ],
    y: [0, 100],
    xName: "constructs accepted",
    xText: number,
    yText: (value) => `${value} %`,
    tip(n) {
      const step = steps[n];
      return [el("b", "", n ? `${step.number}. ${step.title}` : step.title),
        `${n ? `${signed(step.restored - step.broken)} files, then ` : ""}${number(step.parsed)} of ${number(page.files)} parse (${percent(step.parsed, page.files)}; ${percent(step.parsedBytes, page.bytes)} of the bytes)`];
    },
    point(n) {
      for (const [anchor, link] of links) link.classList.toggle("on", steps[n]?.anchor === anchor);
    },
    open,
    group: "steps",
  }));
}

const written = (value) => value.toLocaleString("en-GB", { maximumFractionDigits: Math.abs(value) < 10 ? 2 : Math.abs(value) < 100 ? 1 : 0 });

function metricChart(name, meaning, values) {
  const [first, final] = [values[0], values[last]];
  const now = el("span", "now");
  const holder = el("div", "plot small");
  byId("metrics").append(el("figure", "metric", el("figcaption", "", el("b", "", name), now, el("span", "meaning", meaning)), holder));
  const point = (n) => now.replaceChildren(...(n === null ? [written(first), el("i", "", " → "), written(final)] : [el("i", "", `after ${n}: `), written(values[n])]));
  point(null);
  // From zero if the curve keeps enough height; never so narrow that small changes look large.
  const [least, high] = [Math.min(...values), Math.max(...values)];
  const low = least >= 0 && least < high / 2 ? 0 : Math.min(least, high - Math.abs(high) / 5);
  const room = (high - low || 1) / 12;
  lineChart(holder, () => ({
    label: `${name}: ${written(first)} at the start, ${written(final)} at the end`,
    height: 56,
    series: [{ values, hue: "blue", isFilled: true }],
    y: [low, high + room],
    point,
    open,
    group: "steps",
  }));
}

function metricCharts() {
  metricChart("failing lines", "in files that do not parse yet", steps.map((step) => step.failing));
  for (const name of Object.keys(steps[last].metrics)) metricChart(name, page.meanings[name] ?? "", steps.map((step) => step.metrics[name] ?? 0));
}
