// The path in space: a plain orthographic view, turned by hand.

function scene() {
  const canvas = byId("scene");
  if (!canvas || !path.t.length) return;
  const pen = canvas.getContext("2d");
  const points = page.points.filter((point) => point.place.length === 3);
  const seen = [...path.tool, ...points.map((point) => point.place)];
  const ends = [0, 1, 2].map((i) => [Math.min(...seen.map((p) => p[i])), Math.max(...seen.map((p) => p[i]))]);
  const centre = ends.map(([low, high]) => (low + high) / 2);
  const reach = Math.max(50, Math.hypot(...ends.map(([low, high]) => high - low)));
  const view = { turn: -0.9, tilt: 0.5, zoom: 1, x: 0, y: 0 };
  const blended = path.t.map((time) => blends.some(([from, to]) => from <= time && time <= to));
  let colours = {};

  function project([x, y, z]) {
    const [dx, dy, dz] = [x - centre[0], y - centre[1], z - centre[2]];
    const [c, s] = [Math.cos(view.turn), Math.sin(view.turn)];
    const [across, away] = [c * dx - s * dy, s * dx + c * dy];
    const scale = (0.8 * view.zoom * Math.min(canvas.clientWidth, canvas.clientHeight)) / reach;
    return [canvas.clientWidth / 2 + view.x + scale * across,
      canvas.clientHeight / 2 + view.y - scale * (Math.cos(view.tilt) * dz + Math.sin(view.tilt) * away)];
  }

  function line(rows, colour, width, keep = () => true) {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    let down = false;
    rows.forEach((row, n) => {
      if (!keep(n)) { down = false; return; }
      const [x, y] = project(row);
      if (down) pen.lineTo(x, y);
      else pen.moveTo(x, y);
      down = true;
    });
    pen.stroke();
  }

  function ground() {
    const step = 10 ** Math.round(Math.log10(reach / 6));
    const low = ends[2][0];
    for (const [i, j] of [[0, 1], [1, 0]]) {
      const from = Math.floor(ends[i][0] / step) - 1;
      const to = Math.ceil(ends[i][1] / step) + 1;
      const across = [Math.floor(ends[j][0] / step - 1) * step, Math.ceil(ends[j][1] / step + 1) * step];
      if (to - from > 60) continue;
      for (let n = from; n <= to; n += 1) {
        const rows = across.map((value) => { const row = [0, 0, low]; row[i] = n * step; row[j] = value; return row; });
        line(rows, colours.faint, 1);
      }
    }
    const size = reach / 8;
    const origin = [ends[0][0], ends[1][0], low];
    "XYZ".split("").forEach((name, i) => {
      const tip = origin.map((value, j) => value + (i === j ? size : 0));
      line([origin, tip], colours.dim, 1.5);
      pen.fillStyle = colours.soft;
      pen.fillText(name, ...project(tip).map((value) => value + 3));
    });
    pen.fillStyle = colours.dim;
    pen.fillText(`grid ${number(step)} mm`, 10, canvas.clientHeight - 10);
  }

  function draw() {
    const style = getComputedStyle(document.documentElement);
    colours = Object.fromEntries(["blue", "mark", "faint", "dim", "soft", "ink", "page"].map((name) => [name, style.getPropertyValue(`--${name}`)]));
    const dense = window.devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * dense;
    canvas.height = canvas.clientHeight * dense;
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    pen.font = "11.5px sans-serif";
    pen.lineJoin = "round";
    ground();
    if (path.measured.length) line(path.measured, colours.mark, 1);
    line(path.tool, colours.blue, 1.5);
    line(path.tool, colours.blue, 4, (n) => blended[n]);
    const labels = [];
    for (const point of points) {
      const [x, y] = project(point.place);
      pen.beginPath();
      pen.arc(x, y, 3.5, 0, 2 * Math.PI);
      pen.fillStyle = point.blended ? colours.page : colours.ink;
      pen.strokeStyle = colours.ink;
      pen.lineWidth = 1.2;
      pen.fill();
      pen.stroke();
      // A name that would lie upon another one is left out.
      if (!labels.some(([a, b]) => Math.abs(a - x) < 44 && Math.abs(b - y) < 12)) {
        labels.push([x, y]);
        pen.fillStyle = colours.soft;
        pen.fillText(`${point.motion} ${point.kind}`, x + 7, y - 5);
      }
    }
    const now = path.tool[Math.max(0, placeAt(path.t, moment))];
    const [x, y] = project(now);
    pen.beginPath();
    pen.arc(x, y, 5.5, 0, 2 * Math.PI);
    pen.fillStyle = colours.mark;
    pen.fill();
  }

  let waiting = false;
  const soon = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; draw(); });
  };
  const look = (turn, tilt) => Object.assign(view, { turn, tilt, x: 0, y: 0, zoom: 1 }) && soon();
  canvas.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    if (event.shiftKey || event.buttons !== 1) {
      view.x += event.movementX;
      view.y += event.movementY;
    } else {
      view.turn += event.movementX / 150;
      view.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, view.tilt + event.movementY / 150));
    }
    soon();
  });
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.zoom = Math.min(200, Math.max(0.2, view.zoom * 1.0015 ** -event.deltaY));
    soon();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const [turn, tilt] = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key] ?? [0, 0];
    if (!turn && !tilt) return;
    event.preventDefault();
    view.turn += turn;
    view.tilt += tilt;
    soon();
  });
  byId("front").addEventListener("click", () => look(-Math.PI / 2, 0));
  byId("above").addEventListener("click", () => look(-Math.PI / 2, Math.PI / 2));
  byId("slanted").addEventListener("click", () => look(-0.9, 0.5));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", soon);
  followers.push(soon);
  whenResized(canvas, draw);
}
scene();
