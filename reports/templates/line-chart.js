// Charts of values over steps, drawn by uPlot.

const CHART_FONT = "11.5px system-ui, sans-serif";

/**
 * Draws a chart into `holder` and returns a function that redraws it. Each time `describe()` returns:
 * `series`, each { values, hue, name, isFilled } over 0, 1, 2, …, in the range `y`, as steps unless
 * `isJoined`; `label`, a description in words; `xName` and `xText(n)`, `yText(value)`, without which
 * the axis is omitted; a `limit`.
 * `tip(n)` returns the text beside the step under the pointer. `point(n)` is called with that step, or
 * null if there is none, and `open(n)` on a click. Charts of one `group` mark the same step.
 */
function lineChart(holder, describe) {
  const tip = el("div", "tip");
  const drawing = el("div", "drawing");
  drawing.setAttribute("role", "img");
  holder.replaceChildren(drawing, tip);
  let shown = null;

  function draw() {
    shown?.destroy();
    tip.hidden = true;
    const given = describe();
    const { series, y, height, xText, yText, point = () => {}, open = () => {} } = given;
    const last = series[0].values.length - 1;
    drawing.setAttribute("aria-label", given.label);
    const axis = { stroke: colourOf("soft"), font: CHART_FONT, labelFont: CHART_FONT, ticks: { show: false } };
    const named = series.some(({ name }) => name);

    function pointed(u) {
      const n = u.cursor.idx ?? null;
      point(n);
      tip.hidden = n === null || !given.tip;
      if (tip.hidden) return;
      tip.replaceChildren(...given.tip(n));
      const [left, top] = [u.over.offsetLeft + u.valToPos(n, "x"), u.over.offsetTop + u.valToPos(series[0].values[n], "y")];
      const flip = left > holder.clientWidth / 2;
      tip.style.left = flip ? "auto" : `${left + 12}px`;
      tip.style.right = flip ? `${holder.clientWidth - left + 12}px` : "auto";
      tip.style.top = `${Math.max(0, Math.min(top + 14, height - 90))}px`;
    }

    shown = new uPlot({
      width: holder.clientWidth || 640,
      height,
      padding: [8, named ? 58 : 14, xText ? 0 : 7, yText ? 0 : 4],
      legend: { show: false },
      cursor: { x: Boolean(given.tip), y: false, points: { size: 7, fill: (_, i) => colourOf(series[i - 1].hue) }, drag: { x: false, y: false }, sync: given.group ? { key: given.group } : undefined },
      scales: { x: { time: false, range: () => [0, last] }, y: { range: () => y } },
      axes: [
        { ...axis, show: Boolean(xText), size: 20, gap: 3, space: 40, incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000], grid: { show: false }, label: given.xName, labelSize: 15, values: (_, marks) => marks.map(xText) },
        { ...axis, show: Boolean(yText), size: 46, space: 34, grid: { stroke: colourOf("faint"), width: 1 }, values: (_, marks) => marks.map(yText) },
      ],
      series: [{}, ...series.map(({ hue, isFilled }) => ({
        stroke: colourOf(hue),
        fill: isFilled ? colourOf("blue-wash") : undefined,
        width: 1.75,
        paths: given.isJoined ? uPlot.paths.linear() : uPlot.paths.stepped({ align: 1 }),
        points: { show: !named && (last <= 60 || !given.tip), filter: () => (given.tip ? null : [last]), size: 6, fill: colourOf("page") },
      }))],
      hooks: { draw: [limitLine, names], setCursor: [pointed] },
    }, [series[0].values.map((_, n) => n), ...series.map(({ values }) => values)], drawing);
    shown.over.addEventListener("click", () => { if (shown.cursor.idx !== null) open(shown.cursor.idx); });

    function limitLine(u) {
      if (given.limit === undefined || given.limit <= y[0]) return;
      const [{ ctx, bbox }, at] = [u, u.valToPos(given.limit, "y", true)];
      ctx.save();
      ctx.strokeStyle = colourOf("dim");
      ctx.fillStyle = colourOf("soft");
      ctx.font = `${11.5 * devicePixelRatio}px system-ui, sans-serif`;
      ctx.textAlign = "left";
      ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(bbox.left, at);
      ctx.lineTo(bbox.left + bbox.width, at);
      ctx.stroke();
      ctx.fillText(yText(given.limit), bbox.left + 5 * devicePixelRatio, at + 14 * devicePixelRatio);
      ctx.restore();
    }

    /** Draws the names at the ends of their lines, without overlaps. */
    function names({ ctx, bbox, valToPos }) {
      ctx.save();
      ctx.font = `600 ${11.5 * devicePixelRatio}px system-ui, sans-serif`;
      ctx.textAlign = "left";
      ctx.textBaseline = "middle";
      let above = -Infinity;
      const ends = series.filter(({ name }) => name).map((one) => ({ ...one, at: valToPos(one.values[last], "y", true) }));
      for (const { name, hue, at } of ends.sort((a, b) => a.at - b.at)) {
        above = Math.max(at, above + 15 * devicePixelRatio);
        ctx.fillStyle = colourOf(hue);
        ctx.fillText(name, bbox.left + bbox.width + 8 * devicePixelRatio, above);
      }
      ctx.restore();
    }
  }

  whenResized(holder, draw);
  whenRecoloured(draw);
  return draw;
}
