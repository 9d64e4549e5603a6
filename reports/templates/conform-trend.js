// The nightly runs: how many results passed and failed in each.

function trend() {
  const holder = byId("trend");
  const runs = page.runs;
  if (!holder || runs.length < 2) return;
  holder.style.minHeight = "120px";
  const passed = runs.map((run) => run.verdicts.pass);
  const failed = runs.map((run) => run.verdicts.fail);
  whenResized(holder, () => {
    const [width, height] = [holder.clientWidth || 900, 120];
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
    root.append(svg("title", {}, `${counted(runs.length, "nightly run")}; the last: ${passed.at(-1)} passed, ${failed.at(-1)} failed`));
    const x = (n) => 50 + ((width - 110) * n) / (runs.length - 1);
    const band = (values, top, bottom, name, label) => {
      const high = Math.max(...values, 1);
      const y = (value) => bottom - ((bottom - top) * value) / high;
      root.append(svg("line", { class: "grid", x1: 50, x2: width - 60, y1: bottom, y2: bottom }),
        svg("text", { x: 42, y: y(high) + 8, "text-anchor": "end" }, number(high)),
        svg("path", { class: name, d: values.map((value, n) => `${n ? "L" : "M"}${x(n).toFixed(1)},${y(value).toFixed(1)}`).join("") }),
        svg("text", { x: width - 52, y: y(values.at(-1)) + 4 }, label));
    };
    band(passed, 6, 58, "pass-line", "passed");
    band(failed, 68, 100, "fail-line", "failed");
    root.append(svg("text", { x: 50, y: 116 }, runs[0].date.slice(0, 10)),
      svg("text", { x: width - 60, y: 116, "text-anchor": "end" }, runs.at(-1).date.slice(0, 10)));
    holder.replaceChildren(root);
  });
}
