// Charts over a common time axis, drawn by uPlot: position, speed, acceleration and torque, with limits.

const span = { from: 0, to: end };
const charts = [];
const SIDE = 12;
const isNarrow = () => byId("charts").clientWidth < 600;
const axisWidth = () => (isNarrow() ? 68 : 130);

/**
 * Draws a chart of `series`, each { name, hue, values, told, unit, digits } over the times of the path.
 * `told` are the values shown as numbers if they differ from those drawn. `lines` are limits;
 * `paint(chart, x)` draws everything else. `y` is [lowest, highest], with the lowest at the top if
 * `isDown`; `ticks` are the labels of the axis.
 */
function chart(title, { height, series = [], lines = [], y, ticks = null, keys = [], isDown = false, paint = () => {} }) {
  const holder = el("div", "plot");
  const values = new Map();
  const heading = el("h3", "", title, [...series, ...keys].map((one) => {
    const value = el("span", "value");
    if (one.values) values.set(one, value);
    const key = el("span", "key", one.name, value);
    key.style.setProperty("--hue", `var(--${one.hue})`);
    return key;
  }));
  holder.setAttribute("role", "img");
  holder.setAttribute("aria-label", title);
  byId("charts").append(el("div", "strip", heading, holder));

  const times = path.t.map((time) => time / 1e6);
  const data = series.length ? [times, ...series.map((one) => one.values)] : [[0, end / 1e6], [null, null]];
  let [shown, cursor] = [null, null];

  const place = () => {
    if (!shown) return;
    const at = shown.valToPos(moment / 1e6, "x");
    cursor.hidden = at < -0.5 || at > shown.over.clientWidth + 0.5;
    cursor.style.left = `${at}px`;
    const now = series.length ? valuesAt(moment) : null;
    for (const [one, value] of values) value.textContent = `${now(one.told ?? one.values).toLocaleString("en-GB", { minimumFractionDigits: one.digits, maximumFractionDigits: one.digits })} ${one.unit}`;
  };

  function draw() {
    shown?.destroy();
    const [soft, faint] = ["soft", "faint"].map(colourOf);
    const axis = { stroke: soft, font: "11.5px system-ui, sans-serif", grid: { stroke: faint, width: 1 }, ticks: { show: false } };
    shown = new uPlot({
      width: Math.max(200, holder.clientWidth),
      height,
      padding: [8, SIDE, 0, 0],
      legend: { show: false },
      cursor: { x: false, y: false, points: { show: false }, drag: { x: true, y: false, setScale: false }, bind: { dblclick: () => () => enlarge(0, end) } },
      scales: { x: { time: false, range: () => [span.from / 1e6, span.to / 1e6] }, y: { range: () => y, dir: isDown ? -1 : 1 } },
      axes: [
        { ...axis, size: 22, gap: 4, space: 70, values: (_, marks) => marks.map((mark) => `${+mark.toFixed(6)} s`) },
        { ...axis, size: axisWidth(), ...(ticks ? { splits: () => ticks.map(([at]) => at), values: (u) => ticks.map(([, text]) => shortened(u, text)) } : { space: 28 }) },
      ],
      series: [{}, ...(series.length ? series : [{ hue: "ink" }]).map((one) => ({ stroke: colourOf(one.hue), width: 1.25, dash: one.dash, points: { show: false } }))],
      hooks: {
        drawAxes: [bands],
        draw: [limitLines, (u) => painted(u, (x) => paint(u, x))],
        setSelect: [(u) => {
          const { left, width } = u.select;
          if (width > 6) enlarge(1e6 * u.posToVal(left, "x"), 1e6 * u.posToVal(left + width, "x"));
          u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        }],
      },
    }, data, holder);
    cursor = el("div", "cross");
    shown.over.append(cursor);
    shown.over.addEventListener("pointermove", ({ offsetX, target }) => {
      if (target === shown.over && !isPlaying()) pointAt(1e6 * shown.posToVal(offsetX, "x"), "charts");
    });
    shown.over.addEventListener("click", ({ offsetX }) => pointAt(1e6 * shown.posToVal(offsetX, "x"), "charts"));
    place();
  }

  /** Marks the spans in which two motions blend. */
  function bands(u) {
    painted(u, (x) => {
      u.ctx.fillStyle = colourOf("blue-wash");
      for (const [from, to] of blends) if (to >= span.from && from <= span.to) u.ctx.fillRect(x(from), u.bbox.top, Math.max(1, x(to) - x(from)), u.bbox.height);
    });
  }

  function limitLines(u) {
    painted(u, () => {
      u.ctx.strokeStyle = colourOf("mark");
      u.ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
      for (const value of lines) {
        u.ctx.beginPath();
        u.ctx.moveTo(u.bbox.left, u.valToPos(value, "y", true));
        u.ctx.lineTo(u.bbox.left + u.bbox.width, u.valToPos(value, "y", true));
        u.ctx.stroke();
      }
    });
  }

  charts.push({ draw, zoom: () => { shown.setScale("x", {}); place(); } });
  followers.push(place);
  whenResized(holder, draw);
  whenRecoloured(draw);
}

/** Draws within the plot of a chart; `x` of a time in pixels of its canvas. */
function painted(u, draw) {
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  u.ctx.clip();
  u.ctx.lineWidth = devicePixelRatio;
  u.ctx.textAlign = "left";
  u.ctx.font = `${11.5 * devicePixelRatio}px system-ui, sans-serif`;
  draw((time) => u.valToPos(time / 1e6, "x", true));
  u.ctx.restore();
}

/** Cuts a text at its start to fit beside a chart, because names differ at their ends. */
function shortened(u, text) {
  u.ctx.save();
  u.ctx.font = "11.5px system-ui, sans-serif";
  let fitting = text;
  for (let n = 1; n < text.length && u.ctx.measureText(fitting).width > axisWidth() - 8; n += 1) fitting = `…${text.slice(n)}`;
  u.ctx.restore();
  return fitting;
}

function enlarge(from, to) {
  Object.assign(span, { from: Math.max(0, from), to: Math.min(end, Math.max(to, from + 1000)) });
  for (const { zoom } of charts) zoom();
}

/** Returns the range of the values, extended to the limits if these are near. */
function extent(columns, bounds = []) {
  const values = columns.flatMap((column) => [column.reduce((a, b) => Math.min(a, b), Infinity), column.reduce((a, b) => Math.max(a, b), -Infinity)]);
  const most = Math.max(...values.map(Math.abs), 1e-3);
  const near = bounds.filter((bound) => Math.abs(bound) <= 5 * most);
  const [low, high] = [Math.min(0, ...values, ...near), Math.max(0, ...values, ...near)];
  const room = (high - low) * 0.06;
  return { y: [low - (low < 0 ? room : 0), high + room], lines: near };
}

function speedChart() {
  if (!path.speed.length) return;
  const series = [{ name: "set-point", hue: "blue", values: path.speed, unit: "m/s", digits: 3 }];
  const shown = extent([path.speed], limits.speed ? [limits.speed] : []);
  const keys = limits.speed ? [{ name: `limit ${number(limits.speed)}${shown.lines.length ? "" : ", beyond this scale"}`, hue: "mark" }] : [];
  chart("Speed of the tool [m/s]", { height: 130, series, keys, ...shown });
}

/** The quantities of axes: unit, field of the values, and limits [lowest, highest]. */
const plusMinus = (values) => values.map((value) => (value ? [-value, value] : null));
const QUANTITIES = [
  { title: "Position", unit: (isLinear) => (isLinear ? "mm" : "°"), digits: 1, columns: path.axes, range: limits.axes.map(([low, high]) => (high > low ? [low, high] : null)), share: "±100 % at the software limit switches" },
  { title: "Speed", unit: (isLinear) => (isLinear ? "mm/s" : "°/s"), digits: 1, columns: path.speeds, range: plusMinus(limits.speeds), share: "per cent of the limits" },
  { title: "Acceleration", unit: (isLinear) => (isLinear ? "mm/s²" : "°/s²"), digits: 0, columns: path.accelerations, range: plusMinus(limits.accelerations), share: "per cent of the limits" },
  { title: "Torque", unit: (isLinear) => (isLinear ? "N" : "Nm"), digits: 1, columns: path.torques, range: plusMinus(limits.torques), share: "per cent of the limits" },
];
const axisName = (n) => page.arm.axes[n] ?? (n < 6 ? `A${n + 1}` : `E${n - 5}`);
const axisHue = (n) => ({ hue: `h${n % 6}`, dash: n < 6 ? undefined : [6, 3] });
const isLinear = (n) => page.arm.links.some((link) => link.joint === n && link.linear);

/** Draws a quantity of one axis in its own unit. */
function axisChart({ title, unit, digits, columns, range }, n) {
  const values = columns[n];
  if (!values?.length) return;
  const bounds = range[n] ?? [];
  const series = [{ name: axisName(n), ...axisHue(n), values, unit: unit(isLinear(n)), digits }];
  const shown = extent([values], bounds);
  const limit = bounds[0] === -bounds[1] ? `limit ±${number(bounds[1])}` : `limits ${bounds.map(number).join(" and ")}`;
  const keys = bounds.length ? [{ name: `${limit}${shown.lines.length < 2 ? ", beyond this scale" : ""}`, hue: "mark" }] : [];
  chart(`${title} of ${axisName(n)} [${unit(isLinear(n))}]`, { height: 150, series, keys, ...shown });
}

/**
 * Draws a quantity of all axes: relative to their own limits, so that one pair of lines serves all, or
 * in its unit if limits are unknown.
 */
function axesChart({ title, unit, digits, columns, range, share }) {
  const isShare = range.some((bounds) => bounds);
  const series = columns.flatMap((values, n) => {
    const [low, high] = range[n] ?? (isShare ? [0, 0] : [-100, 100]);
    if (!values.length || high <= low) return [];
    const [middle, half] = [(low + high) / 2, (high - low) / 2];
    return [{ name: axisName(n), ...axisHue(n), values: values.map((value) => (100 * (value - middle)) / half), told: values, unit: unit(isLinear(n)), digits }];
  });
  if (!series.length) return;
  const shown = extent(series.map((one) => one.values), isShare ? [-100, 100] : []);
  if (isShare) Object.assign(shown, { lines: [-100, 100], y: [Math.min(shown.y[0], -108), Math.max(shown.y[1], 108)] });
  chart(`${title} of the axes${isShare ? `, ${share}` : ` [${unit(false)}], limits unknown`}`, { height: 160, series, ...shown });
}

/** Draws the charts of the selected axis, or of all. */
function axisCharts() {
  const choice = byId("axis");
  const others = [charts.length, followers.length];
  const first = byId("charts").children.length;
  page.arm.axes.forEach((name, n) => path.axes[n] && choice.append(new Option(name, n)));
  choice.parentElement.hidden = choice.options.length < 2;
  choice.addEventListener("change", show);
  function show() {
    [charts.length, followers.length] = others;
    [...byId("charts").children].slice(first).forEach((strip) => strip.remove());
    for (const quantity of QUANTITIES) {
      if (choice.value === "all") axesChart(quantity);
      else axisChart(quantity, Number(choice.value));
    }
  }
  show();
}
