# SPDX-License-Identifier: Apache-2.0
"""Vendors' own descriptions of two arms, against what ``multibot join`` makes of one of them.

``MULTIBOT_SOURCES=FOLDER python tests/support/joined_duals.py`` prints the table of
docs/contributing/measurements.md. FOLDER has the checkouts; xacro expands the vendor's description
of two arms, and that of one. What is of neither arm, such as a table, is taken from the vendor's.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from lxml import etree
from vendor_sources import install, packages_below, sources_folder

from multibot_rewrite import Part, join
from multibot_rewrite.description.readback.xml import plain

UR = "ur_robot_driver/urdf/ur.urdf.xacro"
FR3 = "franka_description/robots/fr3v2/fr3v2.urdf.xacro"
SEVEN = {"dof": "7"}
FILES = ("script_filename", "output_recipe_filename", "input_recipe_filename")
XARM = "xarm_description/urdf/xarm_device.urdf.xacro"
GEN3 = "kortex_description/robots/gen3.xacro"
GEN3_ARM = {
    "gripper": "robotiq_2f_85",
    "gripper_joint_name": "robotiq_85_left_knuckle_joint",
} | SEVEN
KR6 = "kuka_agilus_support/urdf/kr6_r700_sixx.urdf.xacro"
IIWA7 = "lbr_description/urdf/iiwa7/iiwa7.xacro"
LBR_DUAL, CONFIG = "lbr_dual_arm_description", "system_config.yaml"


class Arm(NamedTuple):
    """One arm of the vendor's: ``at`` and ``pose`` are where it stands, ``mount`` the joint of the
    vendor's that holds it, which ours replaces. ``names`` is what its names begin with where an
    argument does it."""

    description: str
    arguments: Mapping[str, str]
    prefix: str
    at: str
    mount: str = ""
    pose: Sequence[float] = (0.0,) * 6
    names: str = ""


class Dual(NamedTuple):
    """A description of two arms, with its arguments, and those that it has."""

    description: str
    arguments: Mapping[str, str]
    arms: tuple[Arm, ...]


DUALS = {
    "UR, my_dual_robot_cell": Dual(
        "my_dual_robot_cell_control/urdf/my_dual_robot_cell_controlled.urdf.xacro",
        # The driver's launch file gives them for one arm.
        {f"ur_{it}": it for it in FILES},
        (
            Arm(
                UR,
                {
                    **{it: it for it in FILES},
                    "ur_type": "ur3e",
                    "name": "alice",
                    "robot_ip": "192.168.57.101",
                    "reverse_port": "50006",
                    "script_sender_port": "50007",
                    "script_command_port": "50010",
                    "trajectory_port": "50009",
                },
                "alice_",
                "alice_robot_mount",
            ),
            Arm(
                UR,
                {
                    **{it: it for it in FILES},
                    "ur_type": "ur5e",
                    "name": "bob",
                    "robot_ip": "192.168.57.100",
                    "reverse_port": "50001",
                    "script_sender_port": "50002",
                    "script_command_port": "50004",
                    "trajectory_port": "50003",
                },
                "bob_",
                "bob_robot_mount",
            ),
        ),
    ),
    "xArm, dual_xarm_device": Dual(
        "xarm_description/urdf/dual_xarm_device.urdf.xacro",
        {"dof_1": "7", "dof_2": "7"},
        tuple(
            Arm(
                "xarm_description/urdf/xarm_device.urdf.xacro",
                SEVEN | {"hw_ns": f"{prefix}xarm"},
                prefix,
                "ground",
                pose=pose,
            )
            for prefix, pose in (("L_", (0.0,) * 6), ("R_", (0.0, 1.0, 0.0, 0.0, 0.0, 0.0)))
        ),
    ),
    "Franka, fr3_duo": Dual(
        "franka_description/robots/fr3_duo/fr3_duo.urdf.xacro",
        {},
        tuple(
            Arm(FR3, {}, f"{side}_", "mount_link", f"{side}_base_joint")
            for side in ("left", "right")
        ),
    ),
    "Kinova, kortex_dual_robots": Dual(
        "kortex_description/multiple_robots/kortex_dual_robots.xacro",
        {},
        tuple(
            Arm(
                GEN3,
                {**GEN3_ARM, "robot_ip": ip},
                prefix,
                "world",
                pose=(x, 0.0, 0.0, 0.0, 0.0, 0.0),
            )
            for prefix, ip, x in (
                ("left_", "192.168.1.10", -0.25),
                ("right_", "192.168.1.11", 0.25),
            )
        ),
    ),
    "KUKA, dual_arm_template": Dual(
        "kuka_resources/urdf/dual_arm_template.urdf.xacro",
        {},
        tuple(
            Arm(
                KR6,
                {"roundtrip_time": "4000", **own},
                prefix,
                "world",
                pose=(0.0, y, 0.0, 0.0, 0.0, 0.0),
            )
            for prefix, y, own in (
                ("robot1_", 0.0, {}),
                ("robot2_", 1.0, {"client_port": "59153", "mxa_client_port": "1338"}),
            )
        ),
    ),
    "LBR, lbr_dual_arm": Dual(
        "lbr_dual_arm_description/urdf/lbr_dual_arm.xacro",
        {},
        tuple(
            Arm(
                IIWA7,
                {
                    "robot_name": name,
                    "system_config_path": f"$(find {LBR_DUAL})/ros2_control/{name}_{CONFIG}",
                },
                "",
                "base_link",
                f"{name}_base_joint",
                names=f"{name}_",
            )
            for name in ("lbr_one", "lbr_two")
        ),
    ),
}


class Compared(NamedTuple):
    """How many elements of the vendor's are in ours, of how many; what differs in the others, as
    ``element: theirs -> ours``. ``refused`` says why the vendor's cannot be expanded."""

    same: int
    many: int
    others: tuple[str, ...] = ()
    refused: str = ""


def expanded(path: Path, arguments: Mapping[str, str], environment: Mapping[str, str]) -> bytes:
    """Return a description as xacro makes it; raises RuntimeError with its first line."""
    words = [f"{name}:={value}" for name, value in arguments.items()]
    program = "import sys, xacro; sys.exit(xacro.main())"
    made = subprocess.run(
        [sys.executable, "-c", program, str(path), *words],
        capture_output=True,
        env={**os.environ, **environment},
        check=False,
    )
    if made.returncode:
        raise RuntimeError(made.stderr.decode().strip().splitlines()[0])
    return made.stdout


def compared(dual: Dual, packages: Mapping[str, Path], environment: Mapping[str, str]) -> Compared:
    """Return the vendor's two arms and ours, element by element below the root."""
    try:
        whole = expanded(_at(dual.description, packages), dual.arguments, environment)
    except RuntimeError as error:
        return Compared(0, 0, refused=str(error))
    theirs = etree.fromstring(whole)
    parts = [Part(_rest(theirs, dual), name="cell")]
    for it in dual.arms:
        text = expanded(_at(it.description, packages), it.arguments, environment)
        parts.append(Part(text, it.at, _pose(theirs, it), it.prefix, it.names.strip("_")))
    made = etree.fromstring(join(parts).data)
    for it in (*theirs.iter("origin"), *made.iter("origin")):
        it.attrib.update(_plain(it))
    one, other = (Counter(map(plain, root.iterchildren("*"))) for root in (theirs, made))
    left, right = list(_left(theirs, one - other)), list(_left(made, other - one))
    told: dict[str, None] = {}
    for tag in ("joint", "link", "ros2_control", "material", "gazebo"):
        its = ([it for it in found if it.tag == tag] for found in (left, right))
        told |= dict.fromkeys(_told(*its))
    return Compared((one & other).total(), one.total(), tuple(told))


def _at(path: str, packages: Mapping[str, Path]) -> Path:
    package, _, rest = path.partition("/")
    return packages[package] / rest


def _rest(theirs: etree._Element, dual: Dual) -> bytes:
    """Return what the vendor's has that is of no arm."""
    root = etree.fromstring(etree.tostring(theirs))
    own = tuple(it.names or it.prefix for it in dual.arms)
    mounts = {it.mount for it in dual.arms} - {""}
    stands = {it.at for it in dual.arms}
    for it in list(root.iterchildren("*")):
        name = it.get("name") or it.get("reference") or ""
        child = it.find("child")
        link = name if child is None else child.get("link", "")
        held = link.startswith(own) and link not in stands
        plugin = it.tag == "gazebo" and not it.get("reference")
        if held or name in mounts or it.tag == "ros2_control" or plugin:
            root.remove(it)
    return etree.tostring(root)


def _pose(theirs: etree._Element, arm: Arm) -> Sequence[float]:
    """Where the vendor's mount has an arm."""
    mount = next((it for it in theirs.iterchildren("joint") if it.get("name") == arm.mount), None)
    origin = None if mount is None else mount.find("origin")
    if origin is None:
        return arm.pose
    return [float(it) for key in ("xyz", "rpy") for it in origin.get(key, "0 0 0").split()]


def _left(root: etree._Element, left: Counter[object]) -> Iterator[etree._Element]:
    for it in root.iterchildren("*"):
        if left[plain(it)]:
            left[plain(it)] -= 1
            yield it


def _told(theirs: Sequence[etree._Element], ours: Sequence[etree._Element]) -> Iterator[str]:
    """Yield what differs, element by element in their order."""
    if len(theirs) != len(ours):
        yield f"<{(*theirs, *ours)[0].tag}>: {len(theirs)} -> {len(ours)}"
    for one, other in zip(theirs, ours, strict=False):
        inside = _sorted(one), _sorted(other)
        if len(inside[0]) != len(inside[1]):
            yield f"{one.tag} {one.get('name')}: {len(inside[0])} elements -> {len(inside[1])}"
            continue
        for first, second in zip(*inside, strict=True):
            old, new = ({**_plain(it), "text": (it.text or "").strip()} for it in (first, second))
            yield from (
                f"{first.tag} {key}: {old[key]} -> {new.get(key)}"
                for key in old
                if old[key] != new.get(key)
            )


def _plain(element: etree._Element) -> dict[str, str]:
    """Its attributes, numbers as they are meant."""
    found = {str(key): str(value) for key, value in element.attrib.items()}
    for key in found.keys() & {"xyz", "rpy"}:
        found[key] = " ".join(str(float(it)) for it in found[key].split())
    return found


def _sorted(element: etree._Element) -> list[etree._Element]:
    """Return the element and what is in it; of a joint in the order of names, for it has none."""
    inside = list(element.iterdescendants("*"))
    return [element, *(sorted(inside, key=lambda it: it.tag) if element.tag == "joint" else inside)]


def every() -> Iterator[tuple[str, Compared]]:
    """Each dual whose packages are below MULTIBOT_SOURCES."""
    folder = sources_folder()
    packages = packages_below(folder) if folder else {}
    with tempfile.TemporaryDirectory() as prefix:
        environment = install(packages, Path(prefix), {"ur_client_library": ()})
        for name, dual in DUALS.items():
            needed = {dual.description, *(it.description for it in dual.arms)}
            if all(it.partition("/")[0] in packages for it in needed):
                yield name, compared(dual, packages, environment)


if __name__ == "__main__":
    for name, it in every():
        print(f"{name}: {it.same} of {it.many} {it.refused}")
        print("".join(f"  {other}\n" for other in it.others), end="")
