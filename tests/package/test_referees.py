# SPDX-License-Identifier: Apache-2.0
"""Other programs load each robot before and after: same kinematics and masses under new names."""

from __future__ import annotations

import importlib.util
import io
import math
import re
import shutil
import subprocess
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from expected_names import ROBOT, new_names
from lxml import etree
from paths import FIXTURES
from real_robots import corpus_files, spread, wheel_files

from multibot_rewrite import MultibotError, rewrite, rewrite_all, strip

# MuJoCo writes its warnings into a file of the working folder.
pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("here")]

SIBLINGS = FIXTURES / "robots" / "siblings.urdf"
HAS_PIN = importlib.util.find_spec("pinocchio") is not None
HAS_MUJOCO = importlib.util.find_spec("mujoco") is not None
CHECK_URDF = shutil.which("check_urdf")
OPTIONS: tuple[dict[str, str], ...] = ({}, {"layout": "L2", "affix": "prefix"})
FEW, MANY = 6, 50
# Below this share of loadable files a referee says nothing about the rewrite.
LEAST_LOADED = 0.6

needs_pin = pytest.mark.skipif(not HAS_PIN, reason="pinocchio is missing: pip install pin")
needs_mujoco = pytest.mark.skipif(not HAS_MUJOCO, reason="mujoco is missing: pip install mujoco")
needs_check = pytest.mark.skipif(
    CHECK_URDF is None, reason="check_urdf is missing: apt install liburdfdom-tools"
)


class Key(NamedTuple):
    """A name with its kind: ``link``, ``joint``, or anything else for what is never renamed."""

    kind: str
    name: str


class Report(NamedTuple):
    """What a referee sees: places of frames, masses, and how things hang together."""

    frames: Mapping[Key, np.ndarray]
    masses: Mapping[Key, float]
    structure: frozenset[tuple[Key, ...]]


Angles = Mapping[str, float]
Referee = Callable[[bytes, Angles], Report]


def angles_of(joints: Iterable[str]) -> Angles:
    """Return a value for each joint by its position, so that it is the same before and after."""
    return {name: math.sin(1.0 + 0.37 * at) / 2 for at, name in enumerate(joints)}


def links(names: Iterable[str]) -> list[Key]:
    """Keys of links."""
    return [Key("link", name) for name in names]


# ---------------------------------------------------------------- one function per referee


def with_yourdfpy(data: bytes, angles: Angles) -> Report:
    """Forward kinematics of every link, masses of the inertials."""
    import yourdfpy  # takes a second

    off = dict.fromkeys(("load_meshes", "load_collision_meshes"), False)
    robot = yourdfpy.URDF.load(io.BytesIO(data), build_collision_scene_graph=False, **off)
    robot.update_cfg({name: angles[name] for name in robot.actuated_joint_names})
    frames = {key: robot.get_transform(key.name).copy() for key in links(robot.link_map)}
    heavy = [link for link in robot.robot.links if link.inertial is not None]
    masses = {Key("link", link.name): float(link.inertial.mass or 0) for link in heavy}
    return Report(frames, masses, frozenset(map(joint_row, robot.robot.joints)))


def joint_row(joint: Any) -> tuple[Key, ...]:
    """Return a joint of yourdfpy with what it joins and mimics."""
    mimic = [Key("joint", joint.mimic.joint)] if joint.mimic else []
    ends = links((joint.parent, joint.child))
    return (Key("joint", joint.name), Key("type", joint.type), *ends, *mimic)


def with_pinocchio(data: bytes, angles: Angles) -> Report:
    """Frames and joints by name: a postfix may change their order, and that of q."""
    import pinocchio as pin  # type: ignore[import-not-found]

    model = pin.buildModelFromXML(data.decode())
    state = model.createData()
    pin.framesForwardKinematics(model, state, configuration(model, angles))
    placed = zip(model.frames, state.oMf, strict=True)
    frames = {frame_key(frame): place.homogeneous for frame, place in placed}
    joints = [Key("joint", name) for name in model.names]
    masses = {key: model.inertias[at].mass for at, key in enumerate(joints)}
    pairs = zip(joints, [joints[parent] for parent in model.parents], strict=True)
    return Report(frames, masses, frozenset(pairs))


def frame_key(frame: Any) -> Key:
    """Return a frame of pinocchio: that of a link (a BODY), or of a joint, fixed or not."""
    return Key("link" if str(frame.type) == "BODY" else "joint", frame.name)


def configuration(model: Any, angles: Angles) -> np.ndarray:
    """q for the angles; a continuous joint takes cosine and sine."""
    import pinocchio as pin

    q = pin.neutral(model)
    for at in range(1, model.njoints):
        joint, name = model.joints[at], model.names[at]
        if joint.nq == 1:
            q[joint.idx_q] = angles[name]
        elif joint.nq == 2 and joint.nv == 1:
            q[joint.idx_q : joint.idx_q + 2] = math.cos(angles[name]), math.sin(angles[name])
    return np.asarray(q)


def with_mujoco(data: bytes, angles: Angles) -> Report:
    """Body poses and masses, without meshes: they are not there."""
    import mujoco  # type: ignore[import-not-found]

    model = mujoco.MjModel.from_xml_string(without_meshes(data))
    state = mujoco.MjData(model)
    for at in range(model.njnt):
        if model.jnt_type[at] in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
            state.qpos[model.jnt_qposadr[at]] = angles[model.joint(at).name]
    mujoco.mj_kinematics(model, state)
    bodies = links(model.body(at).name for at in range(model.nbody))
    poses = {key: np.hstack((state.xpos[at], state.xquat[at])) for at, key in enumerate(bodies)}
    masses = {key: float(model.body_mass[at]) for at, key in enumerate(bodies)}
    parents = [(key, bodies[model.body_parentid[at]]) for at, key in enumerate(bodies)]
    return Report(poses, masses, frozenset(parents))


COMPILER = {
    "balanceinertia": "true",
    "boundmass": "0.001",
    "boundinertia": "0.0001",
    "fusestatic": "false",
    "strippath": "false",
}


def without_meshes(data: bytes) -> str:
    """Return the text as MuJoCo takes it: no meshes, no bad inertials, a lenient compiler."""
    root = etree.fromstring(data)
    for part in list(root.iter("visual", "collision", "inertial", "mujoco")):
        parent = part.getparent()
        if parent is not None and not taken_by_mujoco(part):
            parent.remove(part)
    etree.SubElement(etree.SubElement(root, "mujoco"), "compiler", COMPILER)
    return etree.tostring(root, encoding="unicode")


def taken_by_mujoco(part: etree._Element) -> bool:
    """Can MuJoCo load this visual, collision or inertial?"""
    if part.tag == "inertial":
        return positive(part)
    return part.tag != "mujoco" and part.find("geometry/mesh") is None


def positive(inertial: etree._Element) -> bool:
    """Has it a mass and a positive definite inertia?"""
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    if mass is None or inertia is None or float(mass.get("value", "0")) <= 0:
        return False
    xx, xy, xz, yy, yz, zz = (
        float(inertia.get(f"i{axis}", "0")) for axis in ("xx", "xy", "xz", "yy", "yz", "zz")
    )
    moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return bool(moments.min() > 0)


def with_check_urdf(data: bytes, angles: Angles) -> Report:
    """Return the tree that check_urdf prints, as paths from the root; siblings have no order."""
    assert CHECK_URDF
    done = subprocess.run([CHECK_URDF, "/dev/stdin"], input=data, capture_output=True, check=False)
    output = done.stdout.decode()
    if done.returncode or "Successfully Parsed XML" not in output:
        raise ValueError(output + done.stderr.decode())
    return Report({}, {}, frozenset(printed_paths(output)))


def printed_paths(output: str) -> list[tuple[Key, ...]]:
    """Each line of the printed tree as the names from the root to it."""
    (root,) = re.findall(r"^root Link: (.*) has \d+ child", output, re.MULTILINE)
    path = links([root])
    found = [tuple(path)]
    for gap, name in re.findall(r"^( +)child\(\d+\):  (.*)$", output, re.MULTILINE):
        path = [*path[: len(gap) // 4], Key("link", name)]
        found.append(tuple(path))
    return found


# ---------------------------------------------------------------- before and after


class Trial(NamedTuple):
    """One file, one set of options: ``problem`` is empty when all is equal, None if not loadable."""

    name: str
    problem: str | None


def compare(referee: Referee, name: str, data: bytes, options: dict[str, str]) -> Trial:
    """Load the file as it is and rewritten; what the referee sees must be the same."""
    names = new_names(etree.fromstring(data), options, ROBOT)
    try:
        before = referee(data, angles_of(names.joint))
    except Exception:
        return Trial(name, None)
    output = rewrite(data, ROBOT, **options).data
    try:
        after = referee(output, angles_of(names.joint.values()))
    except Exception as error:
        return Trial(name, f"not loaded any more: {type(error).__name__}: {error}")
    return Trial(name, "; ".join(differences(before, after, names._asdict())))


def differences(before: Report, after: Report, names: dict[str, dict[str, str]]) -> list[str]:
    """Where the second report is not the first under new names; numbers are compared exactly."""
    rows = {tuple(renamed(key, names) for key in row) for row in before.structure}
    wrong = sorted(rows ^ after.structure)[:4]
    return [
        *number_differences("frames", before.frames, after.frames, names),
        *number_differences("masses", before.masses, after.masses, names),
        *([f"structure: {wrong}"] if wrong else []),
    ]


def number_differences(
    what: str, old: Mapping[Key, Any], new: Mapping[Key, Any], names: dict[str, dict[str, str]]
) -> list[str]:
    """Return the same for one table of numbers."""
    wanted = {renamed(key, names): value for key, value in old.items()}
    if wanted.keys() != new.keys():
        return [f"{what}: {sorted(wanted.keys() ^ new.keys())[:4]}"]
    gaps = {key: float(np.abs(np.subtract(wanted[key], new[key])).max()) for key in new}
    wrong = [f"{key}: {gap}" for key, gap in gaps.items() if gap != 0.0]
    return [f"{what} differ: {wrong[:4]}"] if wrong else []


def renamed(key: Key, names: dict[str, dict[str, str]]) -> Key:
    """Return the key under its new name."""
    return key._replace(name=names.get(key.kind, {}).get(key.name, key.name))


def trials(referee: Referee, files: Mapping[str, Path], options: dict[str, str]) -> list[Trial]:
    """Every file that the rewrite takes."""
    found = []
    for name, path in files.items():
        data = path.read_bytes()
        try:
            rewrite(data, ROBOT, **options)
        except MultibotError:
            continue
        found.append(compare(referee, name, data, options))
    return found


def judge(found: list[Trial], least: float = LEAST_LOADED) -> None:
    """No file differs, and enough of them were loaded to mean something."""
    wrong = [f"{trial.name}: {trial.problem}" for trial in found if trial.problem]
    assert not wrong, f"{len(wrong)} of {len(found)} files:\n" + "\n".join(wrong[:20])
    loaded = sum(trial.problem == "" for trial in found)
    assert loaded >= max(1, least * len(found)), f"only {loaded} of {len(found)} files loaded"


def all_files() -> dict[str, Path]:
    """Fixtures, corpus and wheels, as far as they are there."""
    fixtures = {path.name: path for path in sorted((FIXTURES / "robots").glob("*.urdf"))}
    found = {**fixtures, **corpus_files(), **wheel_files()}
    return {name: path for name, path in found.items() if is_xml(path)}


def is_xml(path: Path) -> bool:
    """Can the referees read it? Gazebo's parser takes prefixes that are not declared, theirs do not."""
    with suppress(etree.XMLSyntaxError):
        return etree.fromstring(path.read_bytes()) is not None
    return False


def sample() -> dict[str, Path]:
    """Return the fixtures and some of the rest."""
    files = all_files()
    inside = {name: path for name, path in files.items() if FIXTURES in path.parents}
    return {**inside, **spread(files, FEW)}


REFEREES = [
    pytest.param(with_yourdfpy, id="yourdfpy"),
    pytest.param(with_pinocchio, id="pinocchio", marks=needs_pin),
    pytest.param(with_mujoco, id="mujoco", marks=needs_mujoco),
    pytest.param(with_check_urdf, id="check_urdf", marks=needs_check),
]


@pytest.mark.parametrize("referee", REFEREES)
def test_same_robot(referee: Referee) -> None:
    judge(trials(referee, sample(), OPTIONS[0]))


@pytest.mark.deep
@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("referee", REFEREES)
def test_same_robot_for_many(
    referee: Referee, options: dict[str, str], corpus: dict[str, Path]
) -> None:
    judge(trials(referee, spread(all_files(), MANY), options))


def seen(referee: Referee, old: bytes, new: bytes) -> list[str]:
    """Return what a referee says about the siblings with one thing changed."""
    data = SIBLINGS.read_bytes()
    assert old in data
    angles = angles_of(("joint_1", "joint_10", "joint_1_b"))
    return differences(referee(data, angles), referee(data.replace(old, new), angles), {})


@pytest.mark.parametrize("referee", REFEREES)
def test_a_referee_sees_another_name(referee: Referee) -> None:
    assert seen(referee, b'"tenth"', b'"tenth"') == []
    assert seen(referee, b'"tenth"', b'"other"')


@pytest.mark.parametrize("referee", REFEREES[:3])
def test_a_referee_sees_another_number(referee: Referee) -> None:
    assert "frames differ" in seen(referee, b'xyz="2 0 0"', b'xyz="2 0 1e-12"')[0]
    assert "masses differ" in seen(referee, b'<mass value="3"', b'<mass value="3.0000001"')[0]


# ---------------------------------------------------------------- the order of siblings


def codes(options: dict[str, str]) -> list[str]:
    """Return what a rewrite of the siblings warns about."""
    findings = rewrite(SIBLINGS, ROBOT, **options).findings
    return [finding.code for finding in findings]


def test_a_new_order_of_siblings_is_warned_about() -> None:
    assert codes({}) == ["MB405"]
    assert codes({"affix": "prefix"}) == []
    assert rewrite(SIBLINGS, ROBOT, separators={"joint": "/"}).findings == ()


def joint_order(data: bytes) -> list[str]:
    """Return the names in the order of pinocchio's q."""
    import pinocchio as pin

    return list(pin.buildModelFromXML(data.decode()).names)[1:]


@needs_pin
def test_the_order_does_change() -> None:
    data = SIBLINGS.read_bytes()
    old = joint_order(data)
    prefixed = joint_order(rewrite(data, ROBOT, affix="prefix").data)
    postfixed = joint_order(rewrite(data, ROBOT).data)
    assert old == ["joint_1", "joint_10", "joint_1_b"]
    assert prefixed == [f"{ROBOT}_{name}" for name in old]
    assert sorted(postfixed) == sorted(f"{name}_{ROBOT}" for name in old)
    assert postfixed != [f"{name}_{ROBOT}" for name in old]


@needs_pin
def test_the_warning_is_true_for_real_files(corpus: dict[str, Path]) -> None:
    for name, path in spread(corpus, FEW).items():
        data = path.read_bytes()
        try:
            result = rewrite(data, ROBOT)
            old, new = joint_order(data), joint_order(result.data)
        except (MultibotError, ValueError):
            continue
        if new != [f"{joint}_{ROBOT}" for joint in old]:
            assert "MB405" in {finding.code for finding in result.findings}, name


@needs_mujoco
@pytest.mark.parametrize("options", OPTIONS)
def test_two_robots_are_in_one_scene_of_mujoco(options: dict[str, str]) -> None:
    """All names of a kind are in one list there: mjCModel::CheckRepeat."""
    import mujoco

    shapes = '<{0} name="hull"><geometry><box size="1 1 1"/></geometry></{0}>'
    moments = 'ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"'
    inertial = f'<inertial><mass value="1"/><inertia {moments}/></inertial>'
    robot = (
        f'<robot name="r"><link name="base">{inertial}{shapes.format("collision")}</link>'
        f'<link name="arm">{inertial}{shapes.format("collision").replace("hull", "plate")}</link>'
        '<joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint></robot>'
    )
    scene = mujoco.MjSpec()
    for one in rewrite_all(robot, ["robot1", "robot2"], **options):
        part = mujoco.MjSpec.from_string(one.data.decode())
        scene.attach(part, frame=scene.worldbody.add_frame(), prefix="")
        assert strip(one.data, one.robot, **options) == robot.encode()
    model = scene.compile()
    names = {model.geom(at).name for at in range(model.ngeom)}
    assert len(names) == 4
    assert all("robot1" in it or "robot2" in it for it in names)
