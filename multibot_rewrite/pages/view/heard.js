// What a snapshot has of tf: its frames over the robots, and how far they are from the description.
// Functions alone: the viewer calls them before this is run.
function transformOf([x, y, z, ...turn]) {
  const rotation = new THREE.Quaternion(...turn).normalize();
  return new THREE.Matrix4().compose(new THREE.Vector3(x, y, z), rotation, new THREE.Vector3(1, 1, 1));
}

function linesOf(points, opacity) {
  const made = new THREE.BufferGeometry().setFromPoints(points.map((it) => new THREE.Vector3(...it)));
  const look = { color: css("--ghost"), depthTest: false, transparent: true, opacity };
  return new THREE.LineSegments(made, new THREE.LineBasicMaterial(look));
}

// A link of a robot by the name that it has on tf.
function linkOf(robot, frame) {
  const link = frame.startsWith(robot.prefix) ? frame.slice(robot.prefix.length) : "";
  return robot.links[link] ? link : "";
}

function ghostOf(tree, name, transform) {
  const group = new THREE.Group();
  const arm = 0.18, axes = linesOf([[0, 0, 0], [arm, 0, 0], [0, 0, 0], [0, arm, 0], [0, 0, 0], [0, 0, arm]], 1);
  const label = labelOf(name, css("--ghost"));
  label.center.set(0, 1);
  group.add(axes, label);
  const parts = [axes];
  if (transform) {
    group.applyMatrix4(transformOf(transform));
    const back = new THREE.Vector3().applyMatrix4(group.matrix.clone().invert());
    parts.push(linesOf([[0, 0, 0], back.toArray()], 0.5));
    group.add(parts[1]);
  }
  const owner = data.robots.find((it) => it.topic === tree.topic && linkOf(it, name));
  return { name, group, label, parts, robot: owner ? owner.name : tree.robot };
}

function buildTree([topic, root, robot, frames]) {
  const tree = { topic, robot }, ghosts = { [root]: ghostOf(tree, root, null) };
  for (const [name, parent, transform] of frames) {
    ghosts[name] = ghostOf(tree, name, transform);
    ghosts[parent].group.add(ghosts[name].group);
  }
  const home = data.robots.find((it) => it.name === robot);
  if (home) {
    const at = home.built[0].links[linkOf(home, root)] || home.built[0].root;
    at.updateWorldMatrix(true, false);
    ghosts[root].group.applyMatrix4(at.matrixWorld);
  }
  scene.add(ghosts[root].group);
  return Object.values(ghosts);
}

function buildHeard() {
  document.getElementById("ghosts").hidden = !data.trees.length;
  return data.trees.flatMap(buildTree);
}

function showHeard(chosen) {
  const names = data.robots.filter((it) => chosen.includes(it.built[0])).map((it) => it.name);
  for (const it of ghosts) {
    const seen = toggles.tf.checked && (it.robot ? names.includes(it.robot) : names.length > 0);
    for (const part of it.parts) part.visible = seen;
    it.label.visible = seen && toggles.labels.checked;
  }
}

// Metres and degrees between a joint as it is now and as it was heard.
function apartOf(robot, joint) {
  const heard = transformOf(robot.transforms[joint[3]]), { turn } = robot.built[0].moving[joint[0]];
  turn.updateMatrix();
  const now = matrix(joint[4]).multiply(turn.matrix);
  const at = [now, heard].map((it) => new THREE.Vector3().setFromMatrixPosition(it));
  const turned = [now, heard].map((it) => new THREE.Quaternion().setFromRotationMatrix(it));
  return [at[0].distanceTo(at[1]), THREE.MathUtils.radToDeg(turned[0].angleTo(turned[1]))];
}

function compare(robot) {
  for (const joint of robot.joints) {
    const place = document.getElementById(`${robot.name} apart ${joint[3]}`);
    if (!place) continue;
    const apart = apartOf(robot, joint), fixed = joint[1] === "fixed";
    const same = apart.every((it, at) => it <= data.same[at]);
    place.textContent = same ? "tf: the same" : `tf: ${apart[0].toFixed(3)} m, ${apart[1].toFixed(1)}° ${fixed ? "off, and fixed" : "off"}`;
    place.className = same || !fixed ? "apart" : "apart missing";
  }
}

function withApart(robot, link, button) {
  if (!(robot.transforms[link] || []).length) return button;
  return make("span", {}, button, make("span", { className: "apart", id: `${robot.name} apart ${link}` }));
}

// The value of a joint that gives what was heard.
function heardValue(robot, joint) {
  const moved = matrix(joint[4]).invert().multiply(transformOf(robot.transforms[joint[3]]));
  const axis = new THREE.Vector3(...joint[5]).normalize();
  if (joint[1] === "prismatic") return new THREE.Vector3().setFromMatrixPosition(moved).dot(axis);
  const turn = new THREE.Quaternion().setFromRotationMatrix(moved);
  const angle = 2 * Math.atan2(new THREE.Vector3(turn.x, turn.y, turn.z).dot(axis), turn.w);
  return angle > Math.PI ? angle - 2 * Math.PI : angle < -Math.PI ? angle + 2 * Math.PI : angle;
}

function asHeard(robot) {
  const moving = robot.joints.filter((it) => it[6] < it[7] && (robot.transforms[it[3]] || []).length);
  if (!moving.length) return "";
  const button = make("button", { type: "button", id: "as-heard", textContent: "joints as heard on tf" });
  button.addEventListener("click", () => {
    for (const it of moving) move(robot, it[0], ((robot.at ??= {})[it[0]] = heardValue(robot, it)));
    compare(robot);
    describe(robot, "", "robot");
    draw();
  });
  return button;
}
