// Strips over one time axis: speeds against their limits. The signals and lines are in run-signals.

const span = { from: 0, to: end };
const strips = [];
const LEFT = 150;
const RIGHT = 16;
const across = (time, width) => LEFT + ((width - LEFT - RIGHT) * (time - span.from)) / (span.to - span.from || 1);

/** A strip of a given height; `paint(root, x, width)` draws what it shows. */
function strip(title, keys, height, paint) {
  const holder = el("div", "plot");
  holder.style.minHeight = `${height}px`;
  const heading = el("h3", "", title, keys.map(([name, hue]) => {
    const key = el("span", "key", name);
    key.style.setProperty("--hue", `var(${hue})`);
    return key;
  }));
  let cross = null;
  let width = 0;
  const draw = () => {
    width = holder.clientWidth || 900;
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
    root.append(svg("title", {}, title));
    const x = (time) => Math.min(width - RIGHT, Math.max(LEFT, across(time, width)));
    for (const [from, to] of blends) {
      if (to >= span.from && from <= span.to) root.append(svg("rect", { class: "blend", x: x(from), width: Math.max(0.5, x(to) - x(from)), y: 0, height: height - 16 }));
    }
    paint(root, x, width, height);
    ruler(root, x, height);
    const picked = svg("rect", { class: "picked", y: 0, height: height - 16, width: 0 });
    cross = svg("line", { class: "cross", y1: 0, y2: height - 16, x1: x(moment), x2: x(moment) });
    const hit = svg("rect", { class: "hit", x: LEFT, y: 0, width: Math.max(1, width - LEFT - RIGHT), height });
    root.append(picked, cross, hit);
    pointing(hit, root, picked, width);
    holder.replaceChildren(root);
  };
  followers.push((time) => {
    if (!cross) return;
    const at = across(time, width);
    const isSeen = at >= LEFT - 0.5 && at <= width - RIGHT + 0.5;
    cross.setAttribute("visibility", isSeen ? "visible" : "hidden");
    cross.setAttribute("x1", at);
    cross.setAttribute("x2", at);
  });
  strips.push(draw);
  byId("charts").append(el("div", "strip", heading, holder));
  whenResized(holder, draw);
}

function ruler(root, x, height) {
  const length = span.to - span.from;
  const rough = 10 ** Math.floor(Math.log10(length / 6));
  const step = [1, 2, 5, 10].map((n) => n * rough).find((one) => length / one <= 9);
  const digits = Math.max(0, 6 - Math.floor(Math.log10(step) + 1e-9));
  for (let time = Math.ceil(span.from / step) * step; time <= span.to; time += step) {
    root.append(svg("line", { class: "grid", x1: x(time), x2: x(time), y1: 0, y2: height - 16 }),
      svg("text", { x: x(time), y: height - 3, "text-anchor": "middle" }, `${seconds(time, Math.min(digits, 6))} s`));
  }
}

/** The pointer chooses a moment, a drag a span. */
function pointing(hit, root, picked, width) {
  const at = (event) => span.from + ((event.clientX - root.getBoundingClientRect().left - LEFT) * (span.to - span.from)) / (width - LEFT - RIGHT);
  let begun = null;
  hit.addEventListener("pointermove", (event) => {
    pointAt(at(event), "charts");
    if (begun === null) return;
    const [from, to] = [begun, at(event)].sort((a, b) => a - b);
    picked.setAttribute("x", across(from, width));
    picked.setAttribute("width", Math.max(0, across(to, width) - across(from, width)));
  });
  hit.addEventListener("pointerdown", (event) => {
    begun = at(event);
    hit.setPointerCapture(event.pointerId);
  });
  hit.addEventListener("pointerup", (event) => {
    const [from, to] = [begun, at(event)].sort((a, b) => a - b);
    begun = null;
    picked.setAttribute("width", 0);
    if (across(to, width) - across(from, width) > 6) enlarge(from, to);
  });
  hit.addEventListener("dblclick", () => enlarge(0, end));
}

function enlarge(from, to) {
  Object.assign(span, { from: Math.max(0, from), to: Math.min(end, Math.max(to, from + 1000)) });
  for (const draw of strips) draw();
}

/** The path of values over the times of the path, only as dense as there are pixels. */
function curve(values, x, y, width) {
  const first = Math.max(0, placeAt(path.t, span.from));
  const last = Math.min(path.t.length - 1, placeAt(path.t, span.to) + 1);
  const stride = Math.max(1, Math.floor((last - first) / (2 * width)));
  let d = "";
  for (let n = first; n <= last; n += stride) d += `${d ? "L" : "M"}${x(path.t[n]).toFixed(1)},${y(values[n]).toFixed(1)}`;
  return d;
}

function scale(root, y, values, unit, width) {
  for (const value of values) {
    root.append(svg("line", { class: "grid", x1: LEFT, x2: width - RIGHT, y1: y(value), y2: y(value) }),
      svg("text", { x: LEFT - 8, y: y(value) + 4, "text-anchor": "end" }, `${value.toLocaleString("en-GB", { maximumFractionDigits: 2 })} ${unit}`));
  }
}

function speedStrip() {
  if (!path.speed.length) return;
  const limit = page.limits.speed;
  const most = Math.max(...path.speed, 1e-3);
  const high = limit && limit < 3 * most ? Math.max(limit, most) * 1.08 : most * 1.15;
  strip("Speed of the tool", limit ? [["limit", "--mark"]] : [], 110, (root, x, width, height) => {
    const y = (value) => 6 + ((height - 26) * (high - value)) / high;
    scale(root, y, [0, most / 2, most], "m/s", width);
    if (limit && limit <= high) root.append(svg("line", { class: "bound", x1: LEFT, x2: width - RIGHT, y1: y(limit), y2: y(limit) }));
    root.append(svg("path", { class: "trace", d: curve(path.speed, x, y, width) }));
  });
}

function axisStrip() {
  if (!path.axes.length || !page.limits.axes.length) return;
  const hues = path.axes.map((_, i) => `--h${i % 6}`);
  const shares = path.axes.map((values, i) => values.map((value) => (100 * value) / (page.limits.axes[i] || 1)));
  strip("Speed of the axes, per cent of their limits", shares.map((_, i) => [i < 6 ? `A${i + 1}` : `E${i - 5}`, hues[i]]), 150, (root, x, width, height) => {
    const y = (value) => 6 + ((height - 26) * (110 - value)) / 220;
    scale(root, y, [-100, 0, 100], "%", width);
    for (const value of [-100, 100]) root.append(svg("line", { class: "bound", x1: LEFT, x2: width - RIGHT, y1: y(value), y2: y(value) }));
    shares.forEach((values, i) => {
      const line = svg("path", { class: "trace", d: curve(values, x, y, width) });
      line.style.setProperty("--hue", `var(${hues[i]})`);
      root.append(line);
    });
  });
}
