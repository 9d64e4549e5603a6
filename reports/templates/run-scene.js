// The arm and the path of its tool in space, with programmed points.

const POINTS = 2_000; // points that are marked, and pieces of the path without WebGL, at most
const POSES = 12; // at which the arm must be in the picture
const DIRECTIONS = { slanted: [1, -1.2, 0.8], front: [1, 0, 0.001], side: [0, -1, 0.001], above: [0, -0.001, 1] };

/** Returns the renderer and its facets: WebGL, with its picture kept for printing, or else SVG. */
function rendererFor(canvas) {
  const context = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
  if (!context) return { renderer: new THREE.SVGRenderer(), facets: 6, light: 1 };
  const renderer = new THREE.WebGLRenderer({ canvas, context });
  return { renderer, facets: 16, light: Math.PI };
}

function scene() {
  const holder = byId("scene");
  if (!holder || !path.t.length) return;
  const overlay = holder.querySelector("canvas");
  const pen = overlay.getContext("2d");
  const { renderer, facets, light } = rendererFor(document.createElement("canvas"));
  holder.prepend(renderer.domElement);

  const world = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(30, 1, 10, 1e5);
  camera.up.set(0, 0, 1);
  const sun = new THREE.DirectionalLight("#fff", 0.75 * light);
  camera.add(sun);
  sun.position.set(-1, 2, 1);
  world.add(camera, new THREE.AmbientLight("#fff", 0.45 * light));

  const hues = ["blue", "blend", "mark", "ink", "x-axis", "y-axis", "z-axis"];
  const lines = Object.fromEntries(hues.map((hue) => [hue, new THREE.LineBasicMaterial({ linewidth: 1.5 })]));
  const arm = armIn(world, facets, { axes: ["x-axis", "y-axis", "z-axis"].map((hue) => lines[hue]), tool: lines.ink });
  lines.mark.depthFunc = THREE.LessDepth; // measured and planned path are all but one: what was planned is seen
  const points = page.points.filter((point) => point.place.length === 3).slice(0, POINTS);
  const toolTimes = page.arm.tools.map((frames) => frames.t);
  const tool = [0, 1, 2].map((i) => path.tool.map((place) => place[i]));
  const trace = new THREE.Box3().setFromPoints([...path.tool, ...points.map((point) => point.place)].map((place) => new THREE.Vector3(...place)));
  if (trace.isEmpty()) trace.expandByPoint(new THREE.Vector3());
  tracePath();
  const whole = trace.clone();
  for (let n = 0; arm.isThere && n <= POSES; n += 1) {
    arm.follow((n / POSES) * end);
    whole.expandByObject(world);
  }
  const { grid, step, arrow } = ground();

  /** Returns a key of the tool at a time; where it changes, the path is drawn separately. */
  function toolAt(time) {
    return String(page.arm.tools[placeAt(toolTimes, time)]?.tool);
  }

  function tracePath() {
    const stride = renderer.isWebGLRenderer ? 1 : Math.ceil(path.tool.length / POINTS);
    const add = (rows, hue) => rows.length > 1 && world.add(lineOf(rows, lines[hue]));
    let piece = [];
    let wasBlending = false;
    let tool = toolAt(0);
    path.tool.forEach((place, n) => {
      if (n % stride && n < path.tool.length - 1) return;
      if (toolAt(path.t[n]) !== tool) {
        add(piece, wasBlending ? "blend" : "blue");
        [piece, tool] = [[], toolAt(path.t[n])];
      }
      piece.push(place);
      const is = isBlending(path.t[n]);
      if (is === wasBlending && n < path.tool.length - 1) return;
      add(piece, wasBlending ? "blend" : "blue");
      piece = [place];
      wasBlending = is;
    });
    add(path.measured.filter((_, n) => n % stride === 0), "mark");
  }

  /** Returns a grid on the ground as wide as the scene, with lines at a round distance. */
  function ground() {
    const size = whole.getSize(new THREE.Vector3());
    const rough = Math.max(size.x, size.y, 10) / 8;
    const power = 10 ** Math.floor(Math.log10(rough));
    const distance = power * [1, 2, 5, 10].find((n) => n * power >= rough);
    const count = 2 * Math.ceil(Math.max(size.x, size.y) / (2 * distance) + 1);
    const tiles = new THREE.GridHelper(count * distance, count);
    tiles.rotation.x = Math.PI / 2;
    const middle = whole.getCenter(new THREE.Vector3());
    tiles.position.set(Math.round(middle.x / distance) * distance, Math.round(middle.y / distance) * distance, Math.min(0, trace.min.z));
    const length = Math.max(distance, size.length() / 6);
    const origin = triad(length, ["x-axis", "y-axis", "z-axis"].map((hue) => lines[hue]));
    world.add(tiles, origin);
    return { grid: tiles, step: distance, arrow: length };
  }

  // ------------------------------------------------------------------ looking

  const controls = new THREE.OrbitControls(camera, holder);
  holder.style.touchAction = "pan-y"; // one finger upwards moves the page
  let shown = arm.isThere ? whole : trace;

  function look(direction = null) {
    const ball = shown.getBoundingSphere(new THREE.Sphere());
    const narrow = Math.min(1, camera.aspect);
    const distance = (Math.max(ball.radius, 20) * 1.02) / Math.sin((narrow * camera.fov * Math.PI) / 360);
    const way = direction ? new THREE.Vector3(...direction) : camera.position.clone().sub(controls.target);
    controls.target.copy(ball.center);
    camera.position.copy(ball.center).addScaledVector(way.normalize(), distance);
    controls.update();
    soon();
  }

  function resize() {
    const [width, height] = [holder.clientWidth, holder.clientHeight];
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(width, height, false); // as wide as it is on paper, the style says
    overlay.width = width * devicePixelRatio;
    overlay.height = height * devicePixelRatio;
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
  }

  // ------------------------------------------------------------------ drawing

  function recolour() {
    for (const [hue, material] of Object.entries(lines)) material.color.set(colourOf(hue));
    world.remove(grid);
    grid.material.vertexColors = false;
    grid.material.color.set(colourOf("line"));
    world.add(grid);
    soon();
  }

  const seenAt = (place) => {
    const { x, y, z } = new THREE.Vector3(...place).project(camera);
    return z < 1 ? [((1 + x) * holder.clientWidth) / 2, ((1 - y) * holder.clientHeight) / 2] : null;
  };

  /** Draws a mark; returns its box. */
  function dot(at, radius, fill, ring) {
    pen.beginPath();
    pen.arc(...at, radius, 0, 2 * Math.PI);
    pen.fillStyle = fill;
    pen.fill();
    pen.strokeStyle = ring;
    pen.stroke();
    return [at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius];
  }

  /** Draws marks of points, and those of their names that overlap neither one another nor a mark. */
  function marks() {
    const [ink, soft, paper, mark] = ["ink", "soft", "panel", "mark"].map(colourOf);
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    pen.clearRect(0, 0, holder.clientWidth, holder.clientHeight);
    pen.font = "11.5px system-ui, sans-serif";
    pen.lineWidth = 1.2;
    const taken = [];
    const name = (text, [x, y], colour) => {
      const box = [x, y - 10, x + pen.measureText(text).width, y + 3];
      const isFree = taken.every(([left, top, right, bottom]) => box[2] < left || box[0] > right || box[3] < top || box[1] > bottom);
      if (!isFree || box[0] < 0 || box[2] > holder.clientWidth || box[1] < 0) return false;
      taken.push(box);
      pen.lineWidth = 3;
      pen.strokeStyle = paper;
      pen.strokeText(text, x, y);
      pen.lineWidth = 1.2;
      pen.fillStyle = colour;
      pen.fillText(text, x, y);
      return true;
    };
    const current = motionStarts[placeAt(startTimes, moment)]?.motion;
    const seen = points.map((point) => [point, seenAt(point.place)]).filter(([, at]) => at);
    for (const [point, at] of seen) taken.push(dot(at, 3, point.blended ? paper : ink, ink));
    const place = arm.tip() ?? (tool[0].length ? tool.map(valuesAt(moment)) : null);
    const now = place && seenAt(place);
    byId("place").textContent = place ? `tool at X ${place[0].toFixed(1)} Y ${place[1].toFixed(1)} Z ${place[2].toFixed(1)} mm` : "";
    if (now) taken.push(dot(now, 4.5, mark, paper));
    "XYZ".split("").forEach((text, i) => {
      const tip = seenAt([0, 1, 2].map((j) => (i === j ? arrow : 0)));
      if (tip) name(text, [tip[0] + 3, tip[1]], colourOf(`${text.toLowerCase()}-axis`));
    });
    for (const isNow of [true, false]) {
      for (const [point, [x, y]] of seen) {
        if ((point.motion === current) !== isNow) continue;
        const text = `${point.motion} ${point.kind}`;
        const left = x - 7 - pen.measureText(text).width;
        [[x + 7, y - 5], [left, y - 5], [x + 7, y + 13], [left, y + 13]].some((at) => name(text, at, isNow ? ink : soft));
      }
    }
    name(`grid ${number(step)} mm`, [10, holder.clientHeight - 10], soft);
  }

  function draw() {
    arm.follow(moment);
    renderer.render(world, camera);
    marks();
  }

  const soon = atNextFrame(draw);
  controls.addEventListener("change", soon);
  holder.addEventListener("keydown", (event) => {
    const [turn, tilt] = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key] ?? [0, 0];
    const nearer = { "+": 0.8, "-": 1.25 }[event.key];
    if (!turn && !tilt && !nearer) return;
    event.preventDefault();
    const way = camera.position.clone().sub(controls.target);
    const height = Math.asin(way.z / way.length()) + tilt;
    const length = way.length() * (nearer ?? 1);
    way.applyAxisAngle(camera.up, turn);
    way.z = 0;
    way.setLength(length * Math.cos(Math.min(1.55, Math.max(-1.55, height))));
    way.z = length * Math.sin(Math.min(1.55, Math.max(-1.55, height)));
    camera.position.copy(controls.target).add(way);
    controls.update();
    soon();
  });
  for (const [id, direction] of Object.entries(DIRECTIONS)) byId(id).addEventListener("click", () => look(direction));
  const parts = { "all-of-it": whole, "path-only": trace };
  for (const [id, box] of Object.entries(parts)) {
    byId(id).addEventListener("click", () => {
      shown = box;
      look();
    });
  }
  whenRecoloured(recolour);
  followers.push(soon);
  whenResized(holder, () => { resize(); soon(); });
  recolour();
  look(DIRECTIONS.slanted);
}
scene();
