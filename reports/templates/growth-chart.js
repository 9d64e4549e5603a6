// The charts over the steps: the parse rate, and one small chart a metric. They point at the same step.

const steps = page.steps;
const last = steps.length - 1;
const charts = [];

function pointAll(n) {
  for (const point of charts) point(n);
}

/** Steps are drawn as stairs: a value holds from its step to the next. */
const stairs = (values, x, y) =>
  values.map((value, n) => (n ? `H${x(n)}V${y(value)}` : `M${x(0)},${y(value)}`)).join("");

function strides(most, places) {
  return [1, 2, 5, 10, 20, 50, 100, 200, 500].find((n) => most / n <= places) ?? 1000;
}

/** Lets the pointer choose a step on `hit`, and leads to it on a click. */
function pointable(hit, root, left, width) {
  const at = (event) => {
    const offset = event.clientX - root.getBoundingClientRect().left - left;
    return Math.min(last, Math.max(0, Math.round((offset * last) / width)));
  };
  hit.addEventListener("pointermove", (event) => pointAll(at(event)));
  hit.addEventListener("pointerleave", () => pointAll(-1));
  hit.addEventListener("click", (event) => goTo(steps[at(event)].anchor));
}

// ------------------------------------------------------------------------------ the parse rate

function rateChart() {
  const holder = byId("rate");
  const links = new Map([...document.querySelectorAll("#biggest a")].map((link) => [link.dataset.step, link]));
  const tip = el("div", "tip");
  const rates = [
    ["files", steps.map((step) => (100 * step.parsed) / page.files), "curve"],
    ["bytes", steps.map((step) => (100 * step.parsedBytes) / page.bytes), "curve second"],
  ];
  let show = () => {};
  charts.push((n) => show(n));

  function draw() {
    const width = holder.clientWidth || 640;
    const height = 300;
    const [left, right, top, bottom] = [46, 58, 12, 38];
    const x = (n) => left + ((width - left - right) * n) / last;
    const y = (value) => top + ((height - top - bottom) * (100 - value)) / 100;
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
    root.append(svg("title", {}, `Files that parse: ${percent(steps[0].parsed, page.files)} at the start, ${percent(steps[last].parsed, page.files)} after ${counted(last, "construct")}; the table below holds the same figures`));
    for (let value = 100; value >= 0; value -= 20) {
      root.append(svg("line", { class: "grid", x1: left, x2: width - right, y1: y(value), y2: y(value) }),
        svg("text", { x: left - 8, y: y(value) + 4, "text-anchor": "end" }, `${value} %`));
    }
    for (let n = 0; n <= last; n += strides(last, 12)) {
      root.append(svg("text", { x: x(n), y: height - bottom + 18, "text-anchor": "middle" }, number(n)));
    }
    root.append(svg("line", { class: "axis", x1: left, x2: width - right, y1: y(0), y2: y(0) }),
      svg("text", { x: (left + width - right) / 2, y: height - 2, "text-anchor": "middle" }, "constructs accepted"));
    root.append(svg("path", { class: "area", d: `${stairs(rates[0][1], x, y)}V${y(0)}H${x(0)}Z` }));
    for (const [, values, name] of [...rates].reverse()) root.append(svg("path", { class: name, d: stairs(values, x, y) }));

    // The names stand at the ends of their lines, far enough apart to be read.
    const ends = rates.map(([name, values, kind]) => ({ name, kind, y: y(values[last]) })).sort((a, b) => a.y - b.y);
    if (ends[1].y - ends[0].y < 15) {
      const middle = Math.max((ends[0].y + ends[1].y) / 2, top + 8);
      [ends[0].y, ends[1].y] = [middle - 7.5, middle + 7.5];
    }
    for (const end of ends) root.append(svg("text", { class: `name ${end.kind}`, x: width - right + 8, y: end.y + 4 }, end.name));

    const cross = svg("line", { class: "cross", y1: top, y2: y(0), visibility: "hidden" });
    const dots = rates.map(([, , name]) => svg("circle", { class: `dot ${name}`, r: 3.5, visibility: "hidden" }));
    const hit = svg("rect", { class: "hit", x: left, y: 0, width: width - left - right + 8, height });
    root.append(cross, ...dots, hit);
    pointable(hit, root, left, width - left - right);

    let current = "";
    show = (n) => {
      links.get(current)?.classList.remove("on");
      current = n < 0 ? "" : steps[n].anchor;
      links.get(current)?.classList.add("on");
      tip.hidden = n < 0;
      for (const mark of [cross, ...dots]) mark.setAttribute("visibility", n < 0 ? "hidden" : "visible");
      if (n < 0) return;
      cross.setAttribute("x1", x(n));
      cross.setAttribute("x2", x(n));
      rates.forEach(([, values], i) => {
        dots[i].setAttribute("cx", x(n));
        dots[i].setAttribute("cy", y(values[n]));
      });
      const step = steps[n];
      tip.replaceChildren(el("b", "", n ? `${step.number}. ${step.title}` : step.title),
        el("span", "", n ? `${signed(step.restored - step.broken)} files, then ` : "",
          `${number(step.parsed)} of ${number(page.files)} parse (${percent(step.parsed, page.files)}; ${percent(step.parsedBytes, page.bytes)} of the bytes)`));
      const flip = x(n) > width / 2;
      tip.style.left = flip ? "auto" : `${x(n) + 12}px`;
      tip.style.right = flip ? `${width - x(n) + 12}px` : "auto";
      tip.style.top = `${Math.min(Math.max(y(rates[0][1][n]) + 14, top), height - 96)}px`;
    };
    tip.hidden = true;
    holder.replaceChildren(root, tip);
  }
  whenResized(holder, draw);
}

// ------------------------------------------------------------------------------- the metrics

const written = (value) => value.toLocaleString("en-GB", { maximumFractionDigits: Math.abs(value) < 10 ? 2 : Math.abs(value) < 100 ? 1 : 0 });

function metricChart(name, meaning, values) {
  const [first, final] = [values[0], values[last]];
  const now = el("span", "now");
  const holder = el("div", "plot small");
  const figure = el("figure", "metric", el("figcaption", "", el("b", "", name), now, el("span", "meaning", meaning)), holder);
  let show = () => {};
  charts.push((n) => show(n));
  const range = () => now.replaceChildren(written(first), el("i", "", " → "), written(final));

  function draw() {
    const width = holder.clientWidth || 220;
    const height = 56;
    // From zero where that leaves the line room, and never so near that little looks like much.
    const [least, high] = [Math.min(...values), Math.max(...values)];
    const low = least >= 0 && least < high / 2 ? 0 : Math.min(least, high - Math.abs(high) / 5);
    const x = (n) => 2 + ((width - 8) * n) / last;
    const y = (value) => 5 + ((height - 10) * (high - value)) / (high - low || 1);
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
    root.append(svg("title", {}, `${name}: ${written(first)} at the start, ${written(final)} at the end`));
    const floor = height - 3;
    root.append(svg("line", { class: "axis", x1: 2, x2: width - 6, y1: floor, y2: floor }));
    const line = stairs(values, x, y);
    root.append(svg("path", { class: "area", d: `${line}V${floor}H${x(0)}Z` }), svg("path", { class: "curve", d: line }));
    const dot = svg("circle", { class: "dot", r: 3 });
    const hit = svg("rect", { class: "hit", x: 0, y: 0, width, height });
    root.append(dot, hit);
    pointable(hit, root, 2, width - 8);
    show = (n) => {
      const at = n < 0 ? last : n;
      dot.setAttribute("cx", x(at));
      dot.setAttribute("cy", y(values[at]));
      dot.classList.toggle("on", n >= 0);
      if (n < 0) range();
      else now.replaceChildren(el("i", "", `after ${n}: `), written(values[n]));
    };
    show(-1);
    holder.replaceChildren(root);
  }
  return [figure, () => whenResized(holder, draw)];
}

function metricCharts() {
  const names = Object.keys(steps[last].metrics);
  const drawn = [["failing lines", "in files that do not parse yet", steps.map((step) => step.failing)],
    ...names.map((name) => [name, page.meanings[name] ?? "", steps.map((step) => step.metrics[name] ?? 0)])]
    .map((given) => metricChart(...given));
  byId("metrics").replaceChildren(...drawn.map(([figure]) => figure));
  for (const [, draw] of drawn) draw();
}
