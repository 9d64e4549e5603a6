// A case's timing diagram: motions with their blends, inputs, outputs and marks over one time axis.

const signalName = ({ signal, name, number: index, kind }) => (signal && index !== undefined ? `${signal}[${index}]` : String(signal ?? name ?? kind));
const switching = new Set(["in", "out", "anout"]);
const marking = new Set(["trigger", "interrupt_enter", "brake", "resume", "message", "fault", "advance_stop", "halt", "wait"]);
const isOn = (value) => value === true || (typeof value === "number" && value !== 0);

function timing(events) {
  const timed = events.filter((event) => typeof event.t === "number");
  const end = Math.max(...timed.map((event) => event.t), 0);
  const signals = new Map();
  const motions = new Map();
  const blends = [];
  const marks = timed.filter((event) => marking.has(event.kind));
  for (const event of timed) {
    if (switching.has(event.kind)) {
      const name = signalName(event);
      if (!signals.has(name)) signals.set(name, []);
      signals.get(name).push(event);
    }
    if (event.kind === "motion_start") motions.set(event.motion, [event.t, end, event]);
    if (event.kind === "blend_start") blends.push([event.t, end]);
    if (event.kind === "blend_end" && blends.length) blends.at(-1)[1] = event.t;
    if (event.kind === "motion_end" && motions.has(event.motion)) motions.get(event.motion)[1] = event.t;
  }
  if (!end || (!signals.size && !motions.size && !marks.length)) return null;
  const names = [...signals.keys()].slice(0, 24);
  const holder = el("div", "plot");
  const height = 24 + 20 * (names.length + (motions.size ? 1 : 0) + (marks.length ? 1 : 0)) + 20;
  const draw = () => {
    const width = holder.clientWidth || 560;
    const left = 96;
    const x = (time) => left + ((width - left - 12) * time) / end;
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
    root.append(svg("title", {}, `Timing: ${counted(names.length, "signal")} over ${(end / 1e6).toFixed(3)} s`));
    const rough = 10 ** Math.floor(Math.log10(end / 4));
    const step = [1, 2, 5, 10].map((n) => n * rough).find((one) => end / one <= 6);
    for (let time = 0; time <= end; time += step) {
      root.append(svg("line", { class: "grid", x1: x(time), x2: x(time), y1: 0, y2: height - 18 }),
        svg("text", { x: x(time), y: height - 4, "text-anchor": "middle" }, `${Number((time / 1e6).toPrecision(6))} s`));
    }
    let top = 4;
    if (motions.size) {
      root.append(svg("text", { x: left - 8, y: top + 13, "text-anchor": "end" }, "motions"));
      for (const [n, [from, to, event]] of motions) {
        const bar = svg("rect", { class: "motion", x: x(from), y: top + 2, width: Math.max(1, x(to) - x(from)), height: 14 });
        bar.append(svg("title", {}, `motion ${n}, ${event.at ?? ""}: ${(from / 1e6).toFixed(6)} to ${(to / 1e6).toFixed(6)} s`));
        root.append(bar);
      }
      for (const [from, to] of blends) {
        const bar = svg("rect", { class: "blend", x: x(from), y: top + 12, width: Math.max(1, x(to) - x(from)), height: 4 });
        bar.append(svg("title", {}, `blend: ${(from / 1e6).toFixed(6)} to ${(to / 1e6).toFixed(6)} s`));
        root.append(bar);
      }
      top += 20;
    }
    for (const name of names) {
      const [high, base] = [top + 3, top + 17];
      root.append(svg("text", { x: left - 8, y: base - 2, "text-anchor": "end" }, name));
      let d = `M${left},${base}`;
      const list = signals.get(name);
      list.forEach((event, n) => {
        d += `H${x(event.t).toFixed(1)}V${isOn(event.value) ? high : base}`;
        if (!isOn(event.value)) return;
        const to = x(list[n + 1]?.t ?? end);
        const bar = svg("rect", { class: "high", x: x(event.t), y: high, width: Math.max(0.5, to - x(event.t)), height: base - high });
        bar.append(svg("title", {}, `${name} ${event.value} at ${(event.t / 1e6).toFixed(6)} s`));
        root.append(bar);
      });
      root.append(svg("path", { class: "level", d: `${d}H${width - 12}` }));
      top += 20;
    }
    if (marks.length) {
      let free = 0;
      for (const mark of marks) {
        const line = svg("line", { class: "tick", x1: x(mark.t), x2: x(mark.t), y1: 2, y2: top + 6 });
        line.append(svg("title", {}, `${mark.kind} at ${(mark.t / 1e6).toFixed(6)} s`));
        root.append(line);
        const label = mark.kind.replace("_", " ") + (mark.number ? ` ${mark.number}` : "");
        const long = 6.5 * label.length;
        const isBehind = x(mark.t) + long <= width; // else it stands before its tick
        if ((isBehind ? x(mark.t) : x(mark.t) - long) < free) continue;
        root.append(svg("text", { x: x(mark.t) + (isBehind ? 3 : -3), y: top + 14, "text-anchor": isBehind ? "start" : "end" }, label));
        free = x(mark.t) + (isBehind ? long : 0);
      }
    }
    holder.replaceChildren(root);
  };
  return [part("Timing", holder), () => whenResized(holder, draw)];
}
