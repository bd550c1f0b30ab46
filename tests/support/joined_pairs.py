# SPDX-License-Identifier: Apache-2.0
"""Pairs of public parts, what the joined robot of each is, and what other programs make of it.

    python tests/support/joined_pairs.py

prints the table of docs/contributing/measurements.md. linkforge-core and urdf-compose are asked where
they are installed; MuJoCo takes no meshes here, since there are none beside the files.
"""

from __future__ import annotations

import importlib.util
import io
import math
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from lxml import etree
from real_robots import corpus_files, wheel_files

from multibot_rewrite import Joined, Part, join

PREFIX = "p_"
POSE = (0.1, -0.2, 0.05, 0.3, -0.4, 1.2)
_KUKA = "kroshu+kuka_robot_descriptions/"
_AIRO = "airo-models/airo_models/"
# A file and the link that the part is fixed to.
HOSTS = {
    "hex-util-urdf/hex_util_urdf/urdf/archer_y6/empty.urdf": "link_6",
    "ros-industrial+universal_robot/ur_description__urdf__ur10e.urdf": "tool0",
    f"{_KUKA}kuka_agilus_support__urdf__kr6_r700_2.urdf": "flange",
    f"{_KUKA}kuka_lbr_iiwa_support__urdf__lbr_iiwa14_r820.urdf": "flange",
    "xArm-Developer+xarm_ros2/xarm_description__urdf__xarm_device.urdf": "link_eef",
    "frankaemika+franka_ros2/franka_description__robots__panda_arm.urdf": "panda_link8",
    "ros-industrial+fanuc/fanuc_lrmate200id_support__urdf__lrmate200id.urdf": "tool0",
    "husarion+panther_ros/panther_description__urdf__panther__sim.urdf": "cover_link",
    "ridgeback+ridgeback/ridgeback_description__urdf__ridgeback.urdf": "mid_mount",
}
TOOLS = (
    "ros-industrial+robotiq/robotiq_2f_85_gripper_visualization__urdf__robotiq_arg2f_85_model.urdf",
    f"{_AIRO}grippers/schunk_egk40/urdf/schunk_egk40.urdf",
    f"{_AIRO}cameras/realsense/d435/d435.urdf",
    "dexmate-urdf/dexmate_urdf/robots/hands/dexd_gripper/dexd_gripper.urdf",
    "frankaemika+franka_ros2/franka_description__robots__hand.urdf",
    "fiveages-sim+robot_descriptions/gripper__robotiq_description__xacro__robot.urdf",
    "pal-robotics+pal_robotiq_gripper/pal_robotiq_85_gripper__pal_robotiq_85_description__robots__"
    "pal_robotiq_85_gripper.urdf",
    "ignitionrobotics+ign_ros2_control/gz_ros2_control_demos__urdf__test_gripper_mimic_joint_position"
    ".urdf",
    "shadow-robot+sr_common/sr_description__robots__sr_hand.urdf",
    "issaiass+realsense2_description/urdf__test_d435_camera.urdf",
    "xArm-Developer+xarm_ros2/xarm_description__urdf__xarm_device.urdf",
)


class Pair(NamedTuple):
    """Two files, and the link of the first that the second is fixed to."""

    host: Path
    at: str
    tool: Path


@cache
def pairs() -> Mapping[str, Pair]:
    """All pairs whose files are there, by their names."""
    files = {**corpus_files(), **wheel_files()}
    hosts = {name: at for name, at in HOSTS.items() if name in files}
    return {
        f"{Path(host).stem[-24:]} + {Path(tool).stem[-24:]}": Pair(files[host], at, files[tool])
        for host, at in hosts.items()
        for tool in TOOLS
        if tool in files
    }


def joined_pair(pair: Pair) -> Joined:
    """Return the joined robot, with a prefix for the part."""
    return join([Part(pair.host, name="host"), Part(pair.tool, pair.at, POSE, PREFIX, "tool")])


def plain(data: bytes) -> etree._Element:
    """Return the root without comments."""
    return etree.fromstring(data, etree.XMLParser(remove_comments=True))


def root_of(root: etree._Element) -> str:
    """Return the link that is no child."""
    children = {it.get("link") for it in root.iterfind("joint/child")}
    return next(
        it.get("name", "") for it in root.iterfind("link") if it.get("name") not in children
    )


# ------------------------------------------------------------- what pinocchio sees


class Seen(NamedTuple):
    """Where the links are in the world, for joints at angles of their own; the joints that move, and
    the mass of all."""

    links: Mapping[str, np.ndarray]
    joints: frozenset[str]
    mass: float


def seen(data: bytes, prefix: str = "") -> Seen:
    """Return a description as pinocchio has it; joints behind ``prefix`` have their name's angle."""
    import pinocchio as pin  # type: ignore[import-not-found]

    model = pin.buildModelFromXML(etree.tostring(plain(data), encoding="unicode"))
    state, q = model.createData(), pin.neutral(model)
    for at in range(1, model.njoints):
        joint, angle = model.joints[at], angle_of(model.names[at].removeprefix(prefix))
        if joint.nq == 1:
            q[joint.idx_q] = angle
        elif joint.nq == 2 and joint.nv == 1:
            q[joint.idx_q : joint.idx_q + 2] = math.cos(angle), math.sin(angle)
    pin.framesForwardKinematics(model, state, q)
    frames = zip(model.frames, state.oMf, strict=True)
    placed = {it.name: at.homogeneous for it, at in frames if str(it.type) == "BODY"}
    mass = sum(it.mass for it in model.inertias)
    return Seen(placed, frozenset(model.names), mass)


def angle_of(joint: str) -> float:
    """Return an angle that belongs to a name."""
    return math.sin(sum(map(ord, joint))) / 2


def pose_matrix() -> np.ndarray:
    """``POSE`` as yaw after pitch after roll."""
    x, y, z, roll, pitch, yaw = POSE
    c, s = np.cos, np.sin
    turn_x = np.array([[1, 0, 0], [0, c(roll), -s(roll)], [0, s(roll), c(roll)]])
    turn_y = np.array([[c(pitch), 0, s(pitch)], [0, 1, 0], [-s(pitch), 0, c(pitch)]])
    turn_z = np.array([[c(yaw), -s(yaw), 0], [s(yaw), c(yaw), 0], [0, 0, 1]])
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = turn_z @ turn_y @ turn_x, (x, y, z)
    return made


def largest_gap(pair: Pair, data: bytes, prefix: str) -> float:
    """How far, in metres or as a part of a rotation, a link is from where its part has it."""
    whole, host = seen(data, prefix), seen(pair.host.read_bytes(), prefix)
    tool = seen(pair.tool.read_bytes())
    base = whole.links[pair.at] @ pose_matrix()
    gaps = [np.abs(whole.links[name] - at).max() for name, at in host.links.items()]
    gaps += [
        np.abs(whole.links[prefix + name] - base @ at).max()
        for name, at in tool.links.items()
        if name not in ("world", "universe")
    ]
    return float(max(gaps))


# ------------------------------------------------------------- what others make of it

COUNTED = ("links", "moving joints", "transmissions", "ros2_control", "gazebo blocks")
# What should not be there: uses of a link or joint that is not there, and names that are there twice.
WRONG = ("loose names", "names twice")


def counted(data: bytes) -> Counter[str]:
    """Return what is in a text: a URDF, or what MuJoCo writes."""
    root = plain(data)
    if root.tag == "mujoco":
        # The world is no body of the robot.
        bodies, joints = len(list(root.iter("body"))), len(list(root.iterfind(".//body/joint")))
        return Counter({"links": bodies, "moving joints": joints})
    moving = [it for it in root.iterfind("joint") if it.get("type") != "fixed"]
    found = {
        "links": len(root.findall("link")),
        "moving joints": len(moving),
        "transmissions": len(root.findall("transmission")),
        "ros2_control": len(root.findall("ros2_control")),
        "gazebo blocks": len(root.findall("gazebo")),
        "loose names": len(set(loose_names(root))),
        "names twice": len(set(names_twice(root))),
    }
    return Counter(found)


def loose_names(root: etree._Element) -> Iterator[str]:
    """Yield uses of a link or joint that is not there."""
    links = {it.get("name") for it in root.iterfind("link")} | {"world"}
    joints = {it.get("name") for it in root.iterfind("joint")}
    for block in root.iterfind("gazebo"):
        name = block.get("reference")
        if name and name not in links | joints:
            yield name
        for it in block.iter("bodyName", "frameName", "gz_frame_id", "body_name", "base_link"):
            if it.text and it.text.strip() not in links:
                yield it.text
        for it in block.iter("jointName", "joint_name", "joint", "mimicJoint"):
            if it.text and it.text.strip() and it.text.strip() not in joints:
                yield it.text
    for path in ("transmission/joint", "ros2_control/joint"):
        yield from (
            it.get("name", "") for it in root.iterfind(path) if it.get("name") not in joints
        )
    yield from (
        it.get("joint", "") for it in root.iterfind("joint/mimic") if it.get("joint") not in joints
    )


def names_twice(root: etree._Element) -> Iterator[tuple[str, str]]:
    """Yield what urdfdom and ros2_control refuse, or take the first of."""
    for tag in ("link", "joint", "material", "transmission", "ros2_control"):
        names = Counter(it.get("name", "") for it in root.iterchildren(tag))
        yield from ((tag, name) for name, many in names.items() if many > 1)


def twins() -> Mapping[str, Pair]:
    """Each file as a part of itself: every name is there twice but for the prefix."""
    found = {it.host: it.at for it in pairs().values()}
    ends = {it.tool: root_of(plain(it.tool.read_bytes())) for it in pairs().values()}
    return {path.name: Pair(path, at, path) for path, at in {**ends, **found}.items()}


def crossed(pair: Pair, data: bytes) -> int:
    """How many uses in the second of two twins name a link or joint of the first one."""
    root = plain(pair.host.read_bytes())
    names = {it.get("name", "") for tag in ("link", "joint") for it in root.iterchildren(tag)}
    return _uses(plain(data), names - {"world"}) - _uses(root, names - {"world"})


def _uses(root: etree._Element, names: set[str]) -> int:
    parts = [it for tag in USING for it in root.iterfind(tag)]
    # Of a <collision> in a block sdformat takes the children alone (parser_urdf.cc).
    inside = [it for part in parts for it in part.iter("*") if it.tag != "collision"]
    texts = [(it.text or "").strip() for it in inside]
    values = [value for it in inside for value in it.attrib.values()]
    return sum(it in names for it in (*texts, *values))


USING = ("gazebo", "transmission", "ros2_control", "joint/mimic")


def by_mujoco(pair: Pair) -> bytes:
    """MjSpec.attach."""
    import mujoco  # type: ignore[import-not-found]

    host, tool = (mujoco.MjSpec.from_string(for_mujoco(it)) for it in (pair.host, pair.tool))
    body = host.body(pair.at)
    x, y, z, *_ = POSE
    frame = body.add_frame(pos=[x, y, z])
    host.attach(tool, prefix=PREFIX, frame=frame)
    host.compile()
    text: str = host.to_xml()
    return text.encode()


def for_mujoco(path: Path) -> str:
    """Return a description without meshes, with MuJoCo's compiler told to keep all links."""
    root = plain(path.read_bytes())
    for it in (*root.iter("visual", "collision"), *root.iterchildren("mujoco")):
        above = it.getparent()
        if above is not None and (it.tag == "mujoco" or it.find("geometry/mesh") is not None):
            above.remove(it)
    told = {"fusestatic": "false", "balanceinertia": "true", "boundmass": "0.001"}
    told |= {"boundinertia": "0.0001"}
    etree.SubElement(etree.SubElement(root, "mujoco"), "compiler", told)
    return etree.tostring(root, encoding="unicode")


def by_linkforge(pair: Pair) -> bytes:
    """RobotBuilder.attach of linkforge-core."""
    from linkforge.core.composer import RobotBuilder  # type: ignore[import-not-found]
    from linkforge.core.generators import URDFGenerator  # type: ignore[import-not-found]
    from linkforge.core.parsers import URDFParser  # type: ignore[import-not-found]

    host, tool = (URDFParser().parse(it) for it in (pair.host, pair.tool))
    builder = RobotBuilder("host")
    builder.robot = host
    builder.attach(tool, pair.at, prefix=PREFIX, xyz=POSE[:3], rpy=POSE[3:])
    text: str = URDFGenerator().generate(builder.robot, validate=False)
    return text.encode()


def by_urdf_compose(pair: Pair) -> bytes:
    """Return what urdf-compose connects; it takes neither a prefix nor a pose."""
    from urdf_compose import compose  # type: ignore[import-not-found]
    from urdf_compose.resolve_connections import URDFDefConn  # type: ignore[import-not-found]
    from urdf_compose.urdf_obj import ExplicitURDFObj  # type: ignore[import-not-found]

    host, tool = (ExplicitURDFObj(it, check=False) for it in (pair.host, pair.tool))
    ends = URDFDefConn(pair.at, root_of(plain(pair.tool.read_bytes())))
    made = compose.raise_if_compose_error(compose.general_urdf_append(host, [(tool, ends)], False))
    with tempfile.TemporaryDirectory() as folder:
        made.write_xml(Path(folder) / "r.urdf")
        return (Path(folder) / "r.urdf").read_bytes()


def by_join(pair: Pair) -> bytes:
    """Return the pair as this package joins it."""
    return joined_pair(pair).data


OTHERS: Mapping[str, tuple[str, Callable[[Pair], bytes]]] = {
    "multibot join": ("multibot_rewrite", by_join),
    "MuJoCo attach": ("mujoco", by_mujoco),
    "linkforge-core": ("linkforge.core", by_linkforge),
    "urdf-compose": ("urdf_compose", by_urdf_compose),
}


def row_of_twins(make: Callable[[Pair], bytes]) -> str:
    """How many twins a program makes, and how many uses in them are crossed."""
    found = []
    for pair in twins().values():
        try:
            with redirect_stderr(io.StringIO()), redirect_stdout(io.StringIO()):
                found.append(crossed(pair, make(pair)))
        except Exception as error:
            print(f"{pair.host.name} twice: {error}"[:160], file=sys.stderr)
    return f"{len(found)} | {max(0, sum(found))}"


class Row(NamedTuple):
    """What a program makes of all pairs."""

    name: str
    made: int
    found: Counter[str]
    wanted: Counter[str]
    gap: float | None


def row_of(name: str, make: Callable[[Pair], bytes]) -> Row:
    """Ask a program for each pair; what it refuses is not counted."""
    found: Counter[str] = Counter()
    wanted: Counter[str] = Counter()
    made, gaps = 0, []
    for pair in pairs().values():
        try:
            with redirect_stderr(io.StringIO()), redirect_stdout(io.StringIO()):
                data = make(pair)
        except Exception as error:
            print(f"{name}: {pair.host.name} + {pair.tool.name}: {error}"[:160], file=sys.stderr)
            continue
        made += 1
        found += counted(data)
        wanted += counted(pair.host.read_bytes()) + counted(pair.tool.read_bytes())
        gaps += list(_gap(pair, data))
    return Row(name, made, found, wanted, max(gaps) if gaps else None)


def _gap(pair: Pair, data: bytes) -> Iterator[float]:
    try:
        yield largest_gap(pair, data, PREFIX)
    except (KeyError, ValueError, etree.XMLSyntaxError):
        return


def table() -> Iterator[str]:
    """Yield the rows for the page."""
    heads = (f"pairs of {len(pairs())}", *COUNTED, *WRONG, "largest gap")
    heads += (f"twins of {len(twins())}", "crossed names")
    yield f"| program | {' | '.join(heads)} |"
    yield f"|---|{'--:|' * len(heads)}"
    for name, (module, make) in OTHERS.items():
        if not _is_there(module):
            print(f"{name} is not installed", file=sys.stderr)
            continue
        it = row_of(name, make)
        cells = [f"{it.found[what]} of {it.wanted[what]}" for what in COUNTED]
        cells += [str(max(0, it.found[what] - it.wanted[what])) for what in WRONG]
        gap = "" if it.gap is None else f"{it.gap:.0e}" if it.gap else "0"
        cells += [gap, row_of_twins(make)]
        yield f"| {name} | {it.made} | {' | '.join(cells)} |"


def _is_there(module: str) -> bool:
    try:
        return importlib.util.find_spec(module) is not None
    except ModuleNotFoundError:
        return False


def main(arguments: Any = None) -> None:
    """Print the table."""
    print("\n".join(table()))


if __name__ == "__main__":
    main()
