// The timing diagram of inputs and outputs with the marks of triggers and interrupts, and the
// program's lines beside the time axis.

const ROW = 20;
const MARKED = new Set(["trigger", "interrupt_enter", "interrupt_leave", "brake", "resume", "message", "fault", "collision", "torque"]);
const SWITCHING = new Set(["in", "out", "anout"]);

/** Draws steps between events, with the `level` of each in pixels, to the end of the run. */
function steps(u, x, list, level) {
  u.ctx.beginPath();
  list.forEach((event, n) => {
    const y = level(event);
    u.ctx[n ? "lineTo" : "moveTo"](x(event.t), y);
    u.ctx.lineTo(x(list[n + 1]?.t ?? end), y);
  });
  u.ctx.stroke();
}

/** Draws the lines that moved the arm and those that were executed as steps over time: a row for each, file by file. */
function lineChart() {
  const motions = motionStarts.filter((event) => event.at);
  if (!motions.length && !advanceRun.length) return;
  const fileOf = (place) => place.slice(0, place.lastIndexOf(":"));
  const numberOf = (place) => Number(place.split(":").at(-1));
  const seen = [...new Set([...motions, ...advanceRun].map((event) => event.at))];
  const files = [...new Set(seen.map(fileOf))];
  const places = seen.sort((a, b) => files.indexOf(fileOf(a)) - files.indexOf(fileOf(b)) || numberOf(a) - numberOf(b));
  const rows = new Map(places.map((place, row) => [place, row]));
  const last = places.length - 1;
  chart("Program lines", {
    height: 140,
    y: [-0.5 - last * 0.05, last * 1.05 + 0.5],
    isDown: true,
    ticks: [...new Set([0, Math.round(last / 2), last])].map((row) => [row, places[row].split("/").at(-1)]),
    keys: [{ name: "main run", hue: "blue" }, { name: "advance run", hue: "mark" }],
    paint: (u, x) => {
      for (const [list, hue] of [[advanceRun, "mark"], [motions, "blue"]]) {
        u.ctx.strokeStyle = colourOf(hue);
        steps(u, x, list, (event) => u.valToPos(rows.get(event.at), "y", true));
      }
    },
  });
}

const isOn = (value) => value === true || (typeof value === "number" && value !== 0);
const signalName = ({ signal, name, number: index, kind }) => (signal && index !== undefined ? `${signal}[${index}]` : String(signal ?? name ?? kind));

function signalChart() {
  const rows = new Map();
  for (const event of events) {
    if (!SWITCHING.has(event.kind)) continue;
    const name = signalName(event);
    if (!rows.has(name)) rows.set(name, []);
    rows.get(name).push(event);
  }
  const marks = events.filter((event) => MARKED.has(event.kind));
  if (!rows.size && !marks.length) return;
  const names = [...rows.keys()].slice(0, 40);
  chart("Signals", {
    height: ROW * (names.length + 1) + 30,
    y: [-names.length, 1],
    ticks: names.map((name, row) => [-row - 0.5, name]),
    keys: marks.length ? [{ name: "trigger, interrupt, brake, message, contact", hue: "mark" }] : [],
    paint: (u, x) => {
      const dense = devicePixelRatio;
      u.ctx.textBaseline = "middle";
      names.forEach((name, row) => {
        const list = rows.get(name);
        const [top, base] = [0.2, 0.9].map((share) => u.valToPos(-row - share, "y", true));
        u.ctx.fillStyle = colourOf("blue-bar");
        list.forEach((event, n) => isOn(event.value) && u.ctx.fillRect(x(event.t), top, Math.max(1, x(list[n + 1]?.t ?? end) - x(event.t)), base - top));
        u.ctx.strokeStyle = u.ctx.fillStyle = colourOf("ink");
        const before = isOn(list[0].value) ? { t: 0, value: false } : { t: 0, value: list[0].value };
        steps(u, x, [before, ...list], (event) => (isOn(event.value) ? top : base));
        if (list.some((event) => typeof event.value === "number" && ![0, 1].includes(event.value))) inTurn(u, x, list, (event) => String(event.value), (top + base) / 2);
      });
      u.ctx.strokeStyle = u.ctx.fillStyle = colourOf("mark");
      u.ctx.lineWidth = 1.5 * dense;
      for (const mark of marks) u.ctx.fillRect(x(mark.t), u.bbox.top, 1.5 * dense, u.bbox.height);
      inTurn(u, x, marks, (mark) => mark.kind.replace("_", " "), u.valToPos(0.5, "y", true));
    },
  });
}

/** Draws the texts of events, as many as fit without overlaps. */
function inTurn(u, x, list, word, y) {
  const gap = 4 * devicePixelRatio;
  let free = u.bbox.left;
  for (const event of list) {
    const width = u.ctx.measureText(word(event)).width;
    const isLast = x(event.t) + gap + width > u.bbox.left + u.bbox.width;
    const at = isLast ? x(event.t) - gap - width : x(event.t) + gap;
    if (at < free || event.t < span.from || event.t > span.to) continue;
    u.ctx.save();
    [u.ctx.strokeStyle, u.ctx.lineWidth] = [colourOf("page"), gap];
    u.ctx.strokeText(word(event), at, y);
    u.ctx.restore();
    u.ctx.fillText(word(event), at, y);
    free = at + width + gap;
  }
}

if (end > 1) for (const draw of [lineChart, signalChart, speedChart, axisCharts]) draw();
byId("no-charts").hidden = charts.length > 0;
if (!charts.length) for (const part of [byId("charts"), byId("charts").previousElementSibling, byId("axis").parentElement]) part.hidden = true;
