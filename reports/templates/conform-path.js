// A case's path from above and from the front: set-points, measured, analytic, other executors,
// and the positions that its checks name.

const views = [["from above", 0, 1, "X", "Y"], ["from the front", 0, 2, "X", "Z"]];

const places = /^(?:pose|passes|misses|leaves|joins) (\S+) (\S+) (\S+)/;
const isRow = (row) => row.every(Number.isFinite);

/** The position that a check expects, and the actual one if the check failed. */
function placesOf(checks) {
  return checks.flatMap(({ text, state, actual }) => {
    const wanted = (places.exec(text) ?? []).slice(1).map(Number);
    if (wanted.length !== 3 || !isRow(wanted)) return [];
    const seen = state === "unmet" && text.startsWith("pose") ? actual.split(/\s+/).slice(0, 3).map(Number) : [];
    return [[`place ${state === "unmet" ? "bad" : "good"}`, text, wanted], ...(seen.length === 3 && isRow(seen) ? [["place seen", `seen: ${actual}`, seen]] : [])];
  });
}

function overlay(results, checks) {
  const layers = [];
  results.forEach((result) => {
    const { poses, poses_meas: measured, analytic } = result.path;
    const who = `${result.executor} ${result.robot}`;
    if (analytic?.length) layers.push(["ideal", "analytic", analytic]);
    if (poses?.length) layers.push([layers.some(([kind]) => kind === "set") ? "other" : "set", `set-points, ${who}`, poses]);
    if (measured?.length) layers.push(["meas", `measured, ${who}`, measured]);
  });
  if (!layers.length) return null;
  const marks = placesOf(checks);
  const holder = el("div", "plot");
  const draw = () => {
    const width = holder.clientWidth || 560;
    const each = (width - 24) / 2;
    const height = Math.min(260, each);
    const root = svg("svg", { width, height: height + 18, viewBox: `0 0 ${width} ${height + 18}`, role: "img" });
    root.append(svg("title", {}, `The path of the tool, ${counted(layers.length, "layer")}`));
    views.forEach(([title, i, j, across, up], n) => {
      const all = [...layers.flatMap(([, , rows]) => rows), ...marks.map(([, , row]) => row)];
      const ends = [i, j].map((k) => [Math.min(...all.map((row) => row[k])), Math.max(...all.map((row) => row[k]))]);
      const reach = Math.max(1, ...ends.map(([low, high]) => high - low)) * 1.1;
      const scale = Math.min(each, height) / reach;
      const centre = ends.map(([low, high]) => (low + high) / 2);
      const x = (row) => n * (each + 24) + each / 2 + scale * (row[i] - centre[0]);
      const y = (row) => height / 2 - scale * (row[j] - centre[1]);
      root.append(svg("rect", { x: n * (each + 24), y: 0, width: each, height, fill: "none", stroke: "var(--faint)" }),
        svg("text", { x: n * (each + 24) + 6, y: height + 14 }, `${title}: ${across} right, ${up} up; ${reach.toFixed(0)} mm wide`));
      for (const [kind, name, rows] of layers) {
        const line = svg("path", { class: kind, d: rows.map((row, k) => `${k ? "L" : "M"}${x(row).toFixed(1)},${y(row).toFixed(1)}`).join("") });
        line.append(svg("title", {}, name));
        root.append(line);
      }
      for (const [kind, name, row] of marks) {
        const [cx, cy] = [x(row), y(row)];
        const cross = svg("path", { class: kind, d: `M${cx - 5},${cy}H${cx + 5}M${cx},${cy - 5}V${cy + 5}` });
        cross.append(svg("title", {}, name));
        root.append(cross);
      }
    });
    holder.replaceChildren(root);
  };
  const key = ([kind, name]) => {
    const sample = svg("svg", { width: 22, height: 10, "aria-hidden": "true" });
    sample.append(svg("path", { class: kind, d: kind.startsWith("place") ? "M6,5H16M11,0V10" : "M0,5H22" }));
    return el("span", "key", sample, name);
  };
  const kinds = [...layers, ...new Map(marks.map((mark) => [mark[0], mark])).values()];
  const keys = el("p", "keys", ...kinds.map(key));
  return [part("Path", holder, keys), () => whenResized(holder, draw)];
}
