// The timing diagram of inputs and outputs with the marks of triggers and interrupts, and the
// program's lines beside the time axis.

const ROW = 20;

/** The lines that moved the arm, and those that were executed, as steps over time. */
function lineStrip() {
  const motions = events.filter((event) => event.kind === "motion_start" && event.at);
  const ahead = events.filter((event) => ["line", "motion_planned"].includes(event.kind) && event.at && event.task !== "submit");
  if (!motions.length && !ahead.length) return;
  const numbers = [...motions, ...ahead].map((event) => Number(event.at.split(":").at(-1)));
  const [low, high] = [Math.min(...numbers), Math.max(...numbers)];
  strip("Program lines", [["main run", "--blue"], ["advance run", "--mark"]], 130, (root, x, width, height) => {
    const y = (line) => 8 + ((height - 30) * (line - low)) / (high - low || 1);
    for (const line of [...new Set([low, Math.round((low + high) / 2), high])]) {
      root.append(svg("line", { class: "grid", x1: LEFT, x2: width - RIGHT, y1: y(line), y2: y(line) }),
        svg("text", { x: LEFT - 8, y: y(line) + 4, "text-anchor": "end" }, `line ${line}`));
    }
    for (const [list, hue] of [[ahead, "--mark"], [motions, "--blue"]]) {
      let d = "";
      for (const event of list) {
        const at = y(Number(event.at.split(":").at(-1)));
        d += d ? `H${x(event.t).toFixed(1)}V${at.toFixed(1)}` : `M${x(event.t).toFixed(1)},${at.toFixed(1)}`;
      }
      if (!d) continue;
      const line = svg("path", { class: "trace", d: `${d}H${x(end).toFixed(1)}` });
      line.style.setProperty("--hue", `var(${hue})`);
      root.append(line);
    }
  });
}

const isOn = (value) => value === true || (typeof value === "number" && value !== 0);
const signalName = ({ signal, name, number: index, kind }) => (signal && index !== undefined ? `${signal}[${index}]` : String(signal ?? name ?? kind));
const switching = new Set(["in", "out", "anout"]);

function signalStrip() {
  const rows = new Map();
  for (const event of events) {
    if (!switching.has(event.kind)) continue;
    const name = signalName(event);
    if (!rows.has(name)) rows.set(name, []);
    rows.get(name).push(event);
  }
  const marks = events.filter((event) => ["trigger", "interrupt_enter", "interrupt_leave", "brake", "resume", "message", "fault", "advance_stop"].includes(event.kind));
  if (!rows.size && !marks.length) return;
  const names = [...rows.keys()].slice(0, 40);
  strip("Signals", [["trigger, interrupt, brake, message", "--mark"]], ROW * (names.length + 1) + 24, (root, x, width, height) => {
    for (const mark of marks) {
      if (mark.kind === "advance_stop" || mark.t < span.from || mark.t > span.to) continue;
      const line = svg("line", { class: "marker", x1: x(mark.t), x2: x(mark.t), y1: 2, y2: height - 16 });
      line.append(svg("title", {}, `${mark.kind} at ${seconds(mark.t, 6)} s`));
      root.append(line);
    }
    let free = -Infinity;
    for (const mark of marks) {
      if (mark.kind === "advance_stop" || mark.t < span.from || mark.t > span.to || x(mark.t) < free) continue;
      const label = mark.kind.replace("_", " ");
      root.append(svg("text", { class: "marks", x: x(mark.t) + 3, y: 12 }, label));
      free = x(mark.t) + 7 * label.length + 8;
    }
    names.forEach((name, row) => {
      const [top, base] = [ROW * (row + 1) + 3, ROW * (row + 2) - 2];
      root.append(svg("text", { x: LEFT - 8, y: base - 3, "text-anchor": "end" }, name));
      const list = rows.get(name);
      const isAnalog = list.some((event) => typeof event.value === "number" && ![0, 1].includes(event.value));
      let d = `M${x(span.from).toFixed(1)},${base}`;
      list.forEach((event, n) => {
        const y = isOn(event.value) ? top : base;
        d += `H${x(event.t).toFixed(1)}V${y}`;
        if (isOn(event.value)) {
          const to = x(list[n + 1]?.t ?? end);
          root.append(svg("rect", { class: "high", x: x(event.t), y: top, width: Math.max(0.5, to - x(event.t)), height: base - top }));
        }
        if (isAnalog && event.t >= span.from && event.t <= span.to) root.append(svg("text", { x: x(event.t) + 3, y: base - 3 }, String(event.value)));
      });
      root.append(svg("path", { class: "level", d: `${d}H${x(span.to).toFixed(1)}` }));
    });
  });
}

lineStrip();
signalStrip();
speedStrip();
axisStrip();
