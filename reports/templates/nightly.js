// Small curves over the nightly runs, one for each figure.

const runs = page.runs;
const short = (value) => value.toLocaleString("en-GB", { maximumSignificantDigits: 4 });

function runCurve(title, values) {
  const known = values.filter((value) => typeof value === "number");
  if (known.length < 2) return null;
  const [width, height] = [260, 64];
  const [low, high] = [Math.min(...known, 0), Math.max(...known)];
  const x = (n) => 4 + ((width - 8) * n) / Math.max(1, values.length - 1);
  const y = (value) => height - 6 - ((height - 12) * (value - low)) / (high - low || 1);
  const root = svg("svg", { width: "100%", height, viewBox: `0 0 ${width} ${height}`, preserveAspectRatio: "none", role: "img" });
  root.append(svg("title", {}, `${title}: ${known.map(short).join(", ")}`), svg("line", { class: "axis", x1: 4, x2: width - 4, y1: y(low), y2: y(low) }));
  let d = "";
  values.forEach((value, n) => { if (typeof value === "number") d += `${d ? "L" : "M"}${x(n).toFixed(1)},${y(value).toFixed(1)}`; });
  root.append(svg("path", { class: "curve", d }));
  const last = values.length - 1;
  if (typeof values[last] === "number") root.append(svg("circle", { class: "dot", r: 3, cx: x(last), cy: y(values[last]) }));
  const holder = el("div", "plot");
  holder.append(root);
  return el("figure", "chart", el("h3", "", title, el("span", "", short(known.at(-1)))), holder);
}

const benches = [...new Set(runs.flatMap((run) => Object.keys(run.bench)))];
const curves = [
  ["files that parse, %", runs.map((run) => (typeof run.parsed === "number" ? 100 * run.parsed : null))],
  ["runs of cases that pass", runs.map((run) => run.passed)],
  ["runs of cases that fail", runs.map((run) => run.failed)],
  ["divergences of the fuzzer", runs.map((run) => run.divergences)],
  ...benches.map((name) => [name, runs.map((run) => run.bench[name] ?? null)]),
];
const drawn = curves.map(([title, values]) => runCurve(title, values)).filter(Boolean);
if (drawn.length) document.getElementById("curves").replaceChildren(...drawn);
