// The arm for three.js: the chain of links, the tool, and the current frames.

const ALARM = path.t.length ? new THREE.Color("#d01818") : null; // of what touches something

/** Returns the matrix of a frame, given as sixteen numbers row by row. */
const frameOf = (numbers) => new THREE.Matrix4().set(...numbers);

/** Returns a group that is fixed in a frame. */
function fixed(numbers) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  if (numbers) group.matrix.copy(frameOf(numbers));
  return group;
}

function lineOf(points, material) {
  return new THREE.Line(new THREE.BufferGeometry().setFromPoints(points.map((point) => new THREE.Vector3(...point))), material);
}

/** Returns the three axes of a frame in their usual colours. */
function triad(size, colours) {
  const group = fixed();
  colours.forEach((material, i) => group.add(lineOf([[0, 0, 0], [0, 0, 0].map((_, j) => (i === j ? size : 0))], material)));
  return group;
}

/** Returns a rod, with round ends if it `moves`; `facets` is half the number of its sides. */
function rod({ start, end: tip, radius, colour }, facets, moves) {
  const [from, to] = [new THREE.Vector3(...start), new THREE.Vector3(...tip)];
  const length = from.distanceTo(to);
  let shape = new THREE.CylinderGeometry(radius, radius, length, 2 * facets);
  if (length < 1) shape = new THREE.SphereGeometry(radius, 2 * facets, facets);
  else if (moves) shape = new THREE.CapsuleGeometry(radius, length, facets >> 1, 2 * facets);
  const mesh = new THREE.Mesh(shape, new THREE.MeshLambertMaterial({ color: new THREE.Color().setRGB(...colour.slice(0, 3), "srgb") }));
  mesh.position.copy(from).lerp(to, 0.5);
  if (length >= 1) mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), to.sub(from).normalize());
  return mesh;
}

/** Returns an object of the scene; a mesh, whose shape is unknown here, is a small ball at its origin. */
function body({ shape, edges: [x, y, z] }, facets) {
  const shapes = {
    box: () => new THREE.BoxGeometry(x, y, z),
    cylinder: () => new THREE.CylinderGeometry(x / 2, x / 2, z, 3 * facets).rotateX(Math.PI / 2),
    sphere: () => new THREE.SphereGeometry(x / 2, 2 * facets, facets),
  };
  const geometry = Object.hasOwn(shapes, shape) ? shapes[shape]() : new THREE.SphereGeometry(20, 2 * facets, facets);
  return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: "#8aa0b8", transparent: true, opacity: 0.75 }));
}

/**
 * The arm in `scene`: `follow(time)` moves it to its position at a time. `tip()` then returns the
 * position of its tool in mm in $WORLD, or null without an arm.
 */
function armIn(scene, facets, lines) {
  const { links, hand, flange, tools, objects } = page.arm;
  const meshes = [];
  const add = (group, name, mesh) => {
    group.add(mesh);
    meshes.push({ name: name.replaceAll("_", " "), mesh, colour: mesh.material.color.clone() });
  };
  const joints = links.map(() => new THREE.Group());
  links.forEach((link, n) => {
    const frame = fixed(link.frame);
    frame.add(joints[n]);
    for (const shape of link.shapes) add(joints[n], link.name, rod(shape, facets, link.joint >= 0));
    (joints[link.parent] ?? scene).add(frame);
  });
  const toolTimes = tools.map((frames) => frames.t);
  const reach = links.slice(1).reduce((sum, { frame }) => sum + Math.hypot(frame[3], frame[7], frame[11]), 0);
  const [tool, base] = [0.06, 0.1].map((share) => triad(Math.max(30, share * reach), lines.axes));
  const wrist = fixed(flange);
  const stem = lineOf([[0, 0, 0], [0, 0, 0]], lines.tool);
  wrist.add(stem, tool);
  joints[hand]?.add(wrist);
  if (tools.length) scene.add(base);
  for (const object of objects) {
    const frame = fixed(object.frame);
    add(frame, object.name, body(object, facets));
    (object.held ? wrist : scene).add(frame);
  }
  const axes = links.map((link) => new THREE.Vector3(...link.axis));

  function follow(time) {
    const at = valuesAt(time);
    links.forEach((link, n) => {
      if (!path.axes[link.joint]) return;
      const value = at(path.axes[link.joint]);
      if (link.linear) joints[n].position.copy(axes[n]).multiplyScalar(value);
      else joints[n].quaternion.setFromAxisAngle(axes[n], (value * Math.PI) / 180);
    });
    const touched = new Set([...touching(time)].map((name) => name.replaceAll("_", " ")));
    for (const { name, mesh, colour } of meshes) mesh.material.color.copy(touched.has(name) ? ALARM : colour);
    const frames = tools[Math.max(0, placeAt(toolTimes, time))];
    if (frames) {
      tool.matrix.copy(frameOf(frames.tool));
      base.matrix.copy(frameOf(frames.base));
      stem.geometry.setFromPoints([new THREE.Vector3(), new THREE.Vector3().setFromMatrixPosition(tool.matrix)]);
    }
    scene.updateMatrixWorld(true); // fixed frames are not renewed otherwise before they are drawn
  }
  function tip() {
    if (!joints[hand] || !tools.length) return null;
    return new THREE.Vector3().setFromMatrixPosition(tool.matrixWorld).toArray();
  }
  return { follow, tip, isThere: links.length > 0 };
}
