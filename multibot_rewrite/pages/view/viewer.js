"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const stage = document.getElementById("stage"), about = document.getElementById("about");
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const make = (tag, words, ...inside) => {
  const it = Object.assign(document.createElement(tag), words);
  it.append(...inside);
  return it;
};

const bytes = (text) => Uint8Array.from(atob(text), (it) => it.charCodeAt(0)).buffer;
const geometries = data.meshes.map((it) => {
  if (it.missing) return null;
  const made = new THREE.BufferGeometry();
  made.setAttribute("position", new THREE.BufferAttribute(new Float32Array(bytes(it.v)), 3));
  // As RViz: the materials of a mesh file count more than the description's.
  if (it.c) made.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(bytes(it.c)), 3, true));
  made.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes(it.f)), 1));
  made.computeVertexNormals();
  return made;
});
// Of a robot where the description has no colour: alone grey, among others its own.
const OWN = [[0.30, 0.47, 0.70], [0.90, 0.52, 0.20], [0.35, 0.62, 0.32], [0.62, 0.42, 0.66],
  [0.78, 0.36, 0.38], [0.25, 0.62, 0.64], [0.80, 0.66, 0.20], [0.54, 0.41, 0.33]];
data.robots.forEach((it, at) => { it.colour = data.robots.length > 1 ? OWN[at % OWN.length] : [0.72, 0.75, 0.8]; });
const matrix = (rows) => new THREE.Matrix4().set(...rows.flat());

function shapeOf([kind, size, pose, colour, mesh, missing], own) {
  const geometry = kind === "mesh" ? geometries[mesh] : null;
  const box = missing || (kind === "mesh" && !geometry);
  let made;
  if (box) made = new THREE.BoxGeometry(0.1, 0.1, 0.1);
  else if (kind === "mesh") made = geometry;
  else if (kind === "box") made = new THREE.BoxGeometry(...size);
  else if (kind === "sphere") made = new THREE.SphereGeometry(size[0], 32, 16);
  else made = new THREE.CylinderGeometry(size[0], size[0], size[1], 32).rotateX(Math.PI / 2);
  const painted = Boolean(geometry && geometry.getAttribute("color"));
  const [r, g, b, a = 1] = painted ? [1, 1, 1] : colour.length ? colour : own;
  const look = new THREE.MeshLambertMaterial({
    color: new THREE.Color(r, g, b), vertexColors: painted, transparent: a < 1, opacity: a, side: THREE.DoubleSide,
    wireframe: Boolean(box),
  });
  const it = new THREE.Mesh(made, look);
  it.applyMatrix4(matrix(pose));
  if (kind === "mesh" && geometry) it.scale.multiply(new THREE.Vector3(...size));
  return it;
}

function labelOf(text, colour) {
  const canvas = make("canvas"), pen = canvas.getContext("2d");
  pen.font = "32px monospace";
  canvas.width = Math.ceil(pen.measureText(text).width) + 8;
  canvas.height = 40;
  pen.font = "32px monospace";
  Object.assign(pen, { fillStyle: colour, strokeStyle: css("--page"), lineWidth: 6, lineJoin: "round" });
  pen.strokeText(text, 4, 30);
  pen.fillText(text, 4, 30);
  const look = new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false, sizeAttenuation: false });
  const it = new THREE.Sprite(look);
  it.scale.set(canvas.width / 1600, canvas.height / 1600, 1);
  it.center.set(0, 0);
  return it;
}

const stateOf = (robot, name) =>
  robot.heard[name] || (robot.names[name] && robot.names[name][0] !== name ? "changed" : "kept");
const colourOf = (state) =>
  css({ changed: "--changed", heard: "--heard", kept: "--kept" }[state] || "--bad");

// A robot as written, or as it was before: the same shapes under other names.
function build(robot, before) {
  const root = new THREE.Group(), links = {}, labels = [], axes = [];
  const shown = (name) => (before && robot.names[name] ? robot.names[name][0] : name);
  for (const [name, shapes] of Object.entries(robot.links)) {
    const group = (links[name] = new THREE.Group());
    for (const shape of shapes) {
      const it = shapeOf(shape, robot.colour);
      it.userData = { robot, link: name };
      group.add(it);
    }
    const frame = new THREE.AxesHelper(0.12);
    const label = labelOf(shown(name), colourOf(before ? "kept" : stateOf(robot, name)));
    axes.push(frame);
    label.userData = { robot, link: name };
    labels.push(label);
    group.add(frame, label);
  }
  const moving = {};
  for (const [name, type, parent, child, pose, axis] of robot.joints) {
    const at = new THREE.Group(), turn = new THREE.Group();
    at.applyMatrix4(matrix(pose));
    at.add(turn);
    turn.add(links[child]);
    if (links[parent]) links[parent].add(at);
    moving[name] = { turn, type, axis: new THREE.Vector3(...axis).normalize() };
  }
  const children = new Set(robot.joints.map((it) => it[3]));
  for (const [name, it] of Object.entries(links)) if (!children.has(name)) root.add(it);
  const [x, y, z, roll, pitch, yaw] = robot.pose;
  root.position.set(x, y, z);
  root.rotation.set(roll, pitch, yaw, "ZYX");
  return { root, links, labels, axes, moving };
}

function move(robot, name, value) {
  for (const it of robot.built) {
    const joint = it.moving[name];
    if (!joint) continue;
    if (joint.type === "prismatic") joint.turn.position.copy(joint.axis).multiplyScalar(value);
    else joint.turn.quaternion.setFromAxisAngle(joint.axis, value);
  }
  for (const [other, , , , , , , , mimic] of robot.joints)
    if (mimic && mimic[0] === name) move(robot, other, value * mimic[1] + mimic[2]);
}

const scene = new THREE.Scene();
const light = new THREE.DirectionalLight(0xffffff, 0.8);
scene.add(new THREE.AmbientLight(0xffffff, 0.55), light);
const grid = new THREE.GridHelper(20, 20, 0x8890a0, 0xc5cbd5).rotateX(Math.PI / 2);
grid.material.transparent = true;
grid.material.opacity = 0.4;
scene.add(grid);
const views = new Map();
for (const robot of data.robots) {
  const own = build(robot, false), before = build(robot, true);
  robot.built = [own, before];
  scene.add(own.root, before.root);
  views.set(robot.name, [own]);
  views.set(`${robot.name} before the rewrite`, [before]);
}
views.set("all robots", data.robots.map((it) => it.built[0]));
const ghosts = buildHeard();

const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
renderer.setPixelRatio(window.devicePixelRatio);
renderer.autoClear = false;
stage.append(renderer.domElement);
const camera = new THREE.PerspectiveCamera(45, 1, 0.01, 500);
camera.up.set(0, 0, 1);
const controls = new THREE.TrackballControls(camera, renderer.domElement);
controls.rotateSpeed = 2.5;
controls.staticMoving = true;

const left = document.getElementById("left"), right = document.getElementById("right");
left.append(make("option", { textContent: "all robots" }));
right.append(make("option", { textContent: "nothing" }));
for (const name of views.keys()) {
  if (name !== "all robots") left.append(make("option", { textContent: name }));
  right.append(make("option", { textContent: name }));
}
const toggles = { frames: document.getElementById("frames"), labels: document.getElementById("labels"),
  tf: document.getElementById("tf") };

// The name of the link that was clicked is shown, the others where they are asked for.
let picked = "";
const isPicked = ({ userData: { robot, link } }) => Boolean(robot) && `${robot.name} link ${link}` === picked;

function show(name) {
  const chosen = views.get(name) || [];
  for (const robot of data.robots)
    for (const it of robot.built) {
      it.root.visible = chosen.includes(it);
      for (const one of it.axes) one.visible = toggles.frames.checked;
      for (const one of it.labels) one.visible = toggles.labels.checked || isPicked(one);
    }
  showHeard(chosen);
}

// Names beside each other, and none below the edge: one that would cover a nearer one is left out.
function spread(chosen, width, height) {
  scene.updateMatrixWorld();
  camera.updateMatrixWorld();
  const pixels = height / (2 * Math.tan((camera.fov * Math.PI) / 360)), taken = [];
  const names = [...chosen.flatMap((it) => it.labels), ...ghosts.map((it) => it.label)].filter((it) => it.visible);
  const placed = names.map((it) => ({ it, at: it.getWorldPosition(new THREE.Vector3()) }));
  for (const one of placed) one.far = isPicked(one.it) ? 0 : one.at.distanceTo(camera.position);
  for (const { it, at } of placed.sort((one, other) => one.far - other.far)) {
    at.project(camera);
    const x = ((at.x + 1) / 2) * width, y = ((1 - at.y) / 2) * height;
    const wide = it.scale.x * pixels, high = it.scale.y * pixels, up = y > high ? high : 0;
    const start = Math.min(x, Math.max(0, width - wide)), area = [start, y - up, start + wide, y - up + high];
    it.center.set((x - start) / wide, up ? 0 : 1);
    it.visible = at.z < 1 && taken.every((its) => area[0] > its[2] || its[0] > area[2] || area[1] > its[3] || its[1] > area[3]);
    if (it.visible) taken.push(area);
  }
  return taken;
}

function draw() {
  const width = stage.clientWidth, height = stage.clientHeight;
  const both = right.value !== "nothing", part = both ? width / 2 : width;
  light.position.copy(camera.position);
  camera.aspect = part / height;
  camera.updateProjectionMatrix();
  renderer.setScissorTest(true);
  renderer.setViewport(0, 0, width, height);
  renderer.setScissor(0, 0, width, height);
  renderer.clear();
  [left.value, right.value].slice(0, both ? 2 : 1).forEach((name, at) => {
    renderer.setViewport(at * part, 0, part, height);
    renderer.setScissor(at * part, 0, part, height);
    show(name);
    spread(views.get(name) || [], part, height);
    renderer.render(scene, camera);
  });
}

function resize() {
  renderer.setSize(stage.clientWidth, stage.clientHeight);
  controls.handleResize();
  draw();
}

// Whether the picture is as fit left it: one that nobody turned is fitted to each new size.
let untouched = true;
function fit() {
  untouched = true;
  draw();
  show(left.value);
  const box = new THREE.Box3();
  for (const it of views.get(left.value)) box.expandByObject(it.root);
  for (const it of ghosts) if (it.parts[0].visible) box.expandByObject(it.parts[0]);
  if (box.isEmpty()) box.setFromCenterAndSize(new THREE.Vector3(), new THREE.Vector3(1, 1, 1));
  const middle = box.getCenter(new THREE.Vector3());
  const reach = Math.max(0.3, box.getSize(new THREE.Vector3()).length() / 2) / Math.min(1, camera.aspect);
  controls.target.copy(middle);
  camera.position.copy(middle).add(new THREE.Vector3(1, -1.2, 0.8).normalize().multiplyScalar(reach * 3));
  camera.lookAt(middle);
  controls.update();
  draw();
}

// What is said of a link, joint or the whole robot.
function rows(robot, name) {
  const before = robot.names[name] ? robot.names[name][0] : name;
  const found = robot.changes.filter(([, , , old, made]) => old === before || made === name);
  return table(found);
}

function table(changes) {
  const body = make("table");
  for (const [line, kind, path, old, made, rule] of changes)
    body.append(make("tr", {},
      make("td", {}, `line ${line}`),
      make("td", { title: path }, make("code", { textContent: old || "added" }), " → ",
        make("code", { textContent: made }), make("br"), `${kind}, ${rule}`)));
  return body;
}

function describe(robot, name, kind) {
  showPicked(`${robot.name} ${kind} ${name}`, name || robot.name);
  if (!name) {
    about.append(make("p", {}, `${robot.file}: ${robot.changes.length} values are changed.`),
      asHeard(robot), sliders(robot), table(robot.changes));
    return;
  }
  const [before, line] = robot.names[name] || [name, 0];
  const list = make("dl", {}, make("dt", {}, kind), make("dd", {}, name),
    make("dt", {}, "before"), make("dd", {}, before === name ? "the same" : before));
  if (line) list.append(make("dt", {}, "declared"), make("dd", {}, `${robot.file}:${line}`));
  const words = { heard: "is heard", silent: "is not heard", elsewhere: "is heard below another frame" };
  if (robot.heard[name]) list.append(make("dt", {}, robot.topic), make("dd", {}, words[robot.heard[name]]));
  about.append(list);
  for (const shape of robot.links[name] || [])
    if (shape[5]) about.append(make("p", { className: "missing", textContent: `${shape[5]}: shown as a box` }));
  about.append(sliders(robot, kind === "joint" ? name : ""), rows(robot, name));
}

// A plugin goes on until the next one begins.
function describePlugin(robot, at) {
  const [name, loads, line] = robot.plugins[at], end = (robot.plugins[at + 1] || [, , Infinity])[2];
  const found = robot.changes.filter(([where, , path]) => where >= line && where < end && path.includes("/plugin"));
  showPicked(`${robot.name} plugin ${at}`, name);
  about.append(make("dl", {}, make("dt", {}, "plugin"), make("dd", {}, loads),
    make("dt", {}, "declared"), make("dd", {}, `${robot.file}:${line}`)),
    found.length ? table(found) : make("p", { textContent: "Nothing in it is changed." }));
}

function showPicked(id, title) {
  picked = id;
  about.replaceChildren(make("h2", { textContent: title }));
  for (const it of document.querySelectorAll(".picked")) it.classList.remove("picked");
  const button = document.getElementById(id);
  if (button) button.classList.add("picked");
  draw();
}

function plugins(robot) {
  const list = make("ul");
  robot.plugins.forEach(([name], at) => {
    const it = make("button", { type: "button", textContent: name, id: `${robot.name} plugin ${at}`, className: "kept" });
    it.addEventListener("click", () => describePlugin(robot, at));
    list.append(make("li", {}, it));
  });
  return robot.plugins.length ? make("details", { open: true }, make("summary", { textContent: "plugins" }), list) : "";
}

function sliders(robot, only) {
  const list = make("div");
  for (const [name, , , , , , lower, upper, mimic] of robot.joints) {
    if (lower >= upper || mimic || (only && only !== name)) continue;
    const slider = make("input", { type: "range", min: lower, max: upper, step: "any", value: robot.at?.[name] ?? Math.min(Math.max(0, lower), upper) });
    slider.setAttribute("aria-label", name);
    slider.addEventListener("input", () => {
      (robot.at ??= {})[name] = Number(slider.value);
      move(robot, name, Number(slider.value));
      compare(robot);
      draw();
    });
    list.append(make("label", {}, make("code", { textContent: name }), slider));
  }
  return list;
}

function branch(robot, link) {
  const below = robot.joints.filter((it) => it[2] === link);
  const item = make("li", {}, entry(robot, link, "link"));
  if (below.length) {
    const list = make("ul");
    for (const it of below) {
      const one = branch(robot, it[3]);
      one.prepend(entry(robot, it[0], "joint"), make("br"));
      list.append(one);
    }
    item.append(list);
  }
  return item;
}

function entry(robot, name, kind) {
  const state = kind === "link" ? stateOf(robot, name) : (robot.names[name] || [name])[0] === name ? "kept" : "changed";
  const it = make("button", { type: "button", textContent: kind === "joint" ? `⤷ ${name}` : name,
    className: state, id: `${robot.name} ${kind} ${name}` });
  it.addEventListener("click", () => describe(robot, name, kind));
  return kind === "link" ? withApart(robot, name, it) : it;
}

for (const robot of data.robots) {
  const children = new Set(robot.joints.map((it) => it[3]));
  const list = make("ul");
  for (const link of Object.keys(robot.links)) if (!children.has(link)) list.append(branch(robot, link));
  const dot = make("span", { className: "dot" });
  dot.style.background = `rgb(${robot.colour.map((it) => Math.round(255 * it)).join()})`;
  const head = make("summary", {}, robot.name, dot);
  head.addEventListener("click", () => describe(robot, "", "robot"));
  document.getElementById("tree").append(make("details", { open: data.robots.length < 4 }, head,
    robot.bare ? make("p", { className: "missing", textContent: robot.bare }) : "", list, plugins(robot)));
}

// A click, not the end of a drag.
let pressed = [0, 0];
renderer.domElement.addEventListener("pointerdown", (it) => (pressed = [it.clientX, it.clientY]));
renderer.domElement.addEventListener("click", (it) => {
  if (Math.hypot(it.clientX - pressed[0], it.clientY - pressed[1]) > 4) return;
  const area = renderer.domElement.getBoundingClientRect();
  const both = right.value !== "nothing", part = both ? area.width / 2 : area.width;
  const second = it.clientX - area.left > part, x = it.clientX - area.left - (second ? part : 0);
  show(second ? right.value : left.value);
  const ray = new THREE.Raycaster();
  ray.setFromCamera({ x: (2 * x) / part - 1, y: 1 - (2 * (it.clientY - area.top)) / area.height }, camera);
  const seen = (one) => { for (let at = one; at; at = at.parent) if (!at.visible) return false; return true; };
  const hit = ray.intersectObjects(scene.children, true).find((one) => one.object.userData.link && seen(one.object));
  if (hit) describe(hit.object.userData.robot, hit.object.userData.link, "link");
});

// What a drag does, by keys.
const KEYS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
const NEARER = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 };
Object.assign(renderer.domElement, { tabIndex: 0, role: "application", ariaLabel:
  `${data.robots.map((it) => it.name).join(", ")} in 3D: arrow keys turn, + and - come nearer and go away, 0 fits all` });
renderer.domElement.addEventListener("keydown", (it) => {
  const [turn, rise] = KEYS[it.key] || [0, 0], from = camera.position.clone().sub(controls.target);
  if (!(it.key in KEYS || it.key in NEARER || it.key === "0") || it.ctrlKey || it.metaKey || it.altKey) return;
  it.preventDefault();
  if (it.key === "0") return fit();
  untouched = false;
  const side = from.clone().cross(camera.up).normalize();
  from.applyAxisAngle(camera.up.clone().normalize(), turn).applyAxisAngle(side, rise).multiplyScalar(NEARER[it.key] || 1);
  camera.position.copy(controls.target).add(from);
  camera.lookAt(controls.target);
  controls.update();
  draw();
});

for (const it of [left, right]) it.addEventListener("change", () => { resize(); fit(); });
for (const it of Object.values(toggles)) it.addEventListener("change", draw);
document.getElementById("fit").addEventListener("click", fit);
controls.addEventListener("change", draw);
controls.addEventListener("start", () => { untouched = false; });
// In a report the page may run before it has a size, and a camera that is placed then sees nothing.
new ResizeObserver(() => {
  resize();
  if (untouched) fit();
  document.body.dataset.ready = "yes";
}).observe(stage);
(function animate() { requestAnimationFrame(animate); controls.update(); })();
data.robots.forEach(compare);
describe(data.robots[0], "", "robot");
