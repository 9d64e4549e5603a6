// The nightly runs: how many results passed and failed in each.

function trend() {
  const holder = byId("trend");
  const runs = page.runs;
  if (!holder || runs.length < 2) return;
  const count = (verdict) => runs.map((run) => run.verdicts[verdict]);
  for (const [name, hue, values] of [["passed", "pass", count("pass")], ["failed", "fail", count("fail")]]) {
    const plot = el("div", "plot small");
    holder.append(plot);
    lineChart(plot, () => ({
      label: `Results that ${name} in ${counted(runs.length, "nightly run")}; ${number(values.at(-1))} in the last`,
      height: 72,
      series: [{ name, hue, values }],
      isJoined: true,
      y: [0, Math.max(...values, 1)].map((value, n, [, high]) => value + (n ? high : -high) / 12),
      xText: name === "failed" ? (n) => runs[n]?.date.slice(5, 10) : null,
      yText: number,
      tip: (n) => [el("b", "", runs[n].date.slice(0, 10)), `${number(values[n])} ${name}`],
      group: "runs",
    }));
  }
}
