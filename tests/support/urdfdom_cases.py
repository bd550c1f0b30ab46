# SPDX-License-Identifier: Apache-2.0
"""Small descriptions for each version of URDF, with what is at stake; check_urdf judges them."""

from __future__ import annotations

import os
import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

CMEEL = find_spec("cmeel")
# The program of the wheel itself: the command of that name starts a Python for it.
PREFIX = Path(CMEEL.origin or "").parents[1] / "cmeel.prefix" if CMEEL else Path("nowhere")
CHECK = shutil.which("check_urdf", path=str(PREFIX / "bin")) or shutil.which("check_urdf")
ENVIRONMENT = {**os.environ, "LD_LIBRARY_PATH": str(PREFIX / "lib")} if CMEEL else None
VERSIONS = ("1.0", "1.1", "1.2")
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"{}/>'
INERTIA = '<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'


class Said(NamedTuple):
    """What urdfdom makes of a file: does it read it, and has it anything to say of it?"""

    reads: bool
    complains: bool


def check_urdf(text: str, folder: Path) -> Said:
    """Return the judgement of urdfdom's own program."""
    assert CHECK, "check_urdf of urdfdom 6 is there: pip install cmeel-urdfdom"
    file = folder / "case.urdf"
    file.write_text(text)
    run = subprocess.run(
        [CHECK, file], capture_output=True, text=True, timeout=60, check=False, env=ENVIRONMENT
    )
    complains = run.returncode != 0 or "Error:" in run.stderr or "Warning:" in run.stderr
    return Said(run.returncode == 0, complains)


def robot(version: str, body: str) -> str:
    return f'<robot name="r" version="{version}">\n{body}\n</robot>'


def joint(inside: str, type_: str = "revolute") -> str:
    ends = '<parent link="a"/><child link="b"/>'
    return f'<link name="a"/><link name="b"/><joint name="j" type="{type_}">{ends}{inside}</joint>'


def visual(shape: str, origin: str = "") -> str:
    return f'<link name="a"><visual>{origin}<geometry>{shape}</geometry></visual></link>'


def turned(rotation: str) -> str:
    return joint(f'<origin xyz="0 0 1" {rotation}/>{LIMIT.format("")}')


def limit(**given: str) -> str:
    return f"<limit {' '.join(f'{key}={value!r}' for key, value in given.items())}/>"


BOUNDS = {"lower": "-1", "upper": "1"}
POWER = {"effort": "1", "velocity": "1"}
# Every one is judged in every version.
JOINTS = {
    "all limits": joint(limit(**BOUNDS, **POWER)),
    "no limit": joint(""),
    "no lower": joint(limit(upper="1", **POWER)),
    "no upper, prismatic": joint(limit(lower="1", **POWER), "prismatic"),
    "no effort": joint(limit(**BOUNDS, velocity="1")),
    "no velocity": joint(limit(**BOUNDS, effort="1")),
    "empty limit of a wheel": joint("<limit/>", "continuous"),
    "empty limit of a fixed joint": joint("<limit/>", "fixed"),
    "a wheel without a limit": joint("", "continuous"),
    "half the bounds of a wheel": joint(limit(upper="-1", **POWER), "continuous"),
    "effort below 0": joint(limit(**BOUNDS, effort="-1", velocity="1")),
    "velocity below 0 of a wheel": joint(limit(effort="1", velocity="-.5"), "continuous"),
    "effort 0": joint(limit(**BOUNDS, effort="0", velocity="1")),
    "effort minus 0": joint(limit(**BOUNDS, effort="-0", velocity="1")),
    "effort without an end": joint(limit(**BOUNDS, effort="inf", velocity="1")),
    "upper below lower": joint(limit(lower="1", upper="-1", **POWER)),
    "upper below lower, fixed": joint(limit(lower="1", upper="-1", **POWER), "fixed"),
    "upper below lower, a wheel": joint(limit(lower="1", upper="-1", **POWER), "continuous"),
    "upper is lower": joint(limit(lower="1", upper="1", **POWER)),
    "acceleration": joint(LIMIT.format(' acceleration="2"')),
    "deceleration alone": joint(LIMIT.format(' deceleration="3"')),
    "jerk": joint(LIMIT.format(' jerk="5"')),
    "jerk below 0": joint(LIMIT.format(' jerk="-5"')),
    "acceleration below 0": joint(LIMIT.format(' acceleration="-2"')),
    "deceleration below 0": joint(LIMIT.format(' deceleration="-1"')),
    "jerk 0": joint(LIMIT.format(' jerk="0"')),
    "a word for jerk": joint(LIMIT.format(' jerk="high"')),
    "jerk empty": joint(LIMIT.format(' jerk=""')),
    "jerk with a space": joint(LIMIT.format(' jerk="1 "')),
    "jerk not finite": joint(LIMIT.format(' jerk="nan"')),
    "a quaternion": turned('quat_xyzw="0 0 0 1"'),
    "a quaternion of length 2": turned('quat_xyzw="0 0 0 2"'),
    "rpy and a quaternion": turned('rpy="0 0 0" quat_xyzw="0 0 0 1"'),
    "three numbers": turned('quat_xyzw="0 0 1"'),
    "five numbers": turned('quat_xyzw="0 0 0 1 0"'),
    "words": turned('quat_xyzw="a b c d"'),
    "nothing": turned('quat_xyzw=""'),
    "not finite": turned('quat_xyzw="nan 0 0 1"'),
    "commas": turned('quat_xyzw="0,0,0,1"'),
    "a tab": turned('quat_xyzw="0\t0 0 1"'),
    "many spaces": turned('quat_xyzw="  0  0 0 1  "'),
    "an inertial that is turned": f'<link name="a"><inertial><origin quat_xyzw="0 0 0 1"/>{INERTIA}'
    "</inertial></link>",
}
LINKS = {
    "capsule": visual('<capsule radius="1" length="2"/>'),
    "capsule without a length": visual('<capsule radius="1"/>'),
    "capsule of length 0": visual('<capsule radius="1" length="0"/>'),
    "capsule below 0": visual('<capsule radius="-1" length="1"/>'),
    "capsule of words": visual('<capsule radius="x" length="1"/>'),
    "box of 0": visual('<box size="0 1 1"/>'),
    "box below 0": visual('<box size="1 1 -1"/>'),
    "box": visual('<box size="1 1e-3 .5"/>'),
    "sphere of 0": visual('<sphere radius="0.0"/>'),
    "sphere below 0": visual('<sphere radius="-1"/>'),
    "sphere of nan": visual('<sphere radius="nan"/>'),
    "cylinder of 0": visual('<cylinder radius="1" length="0"/>'),
    "cylinder below 0": visual('<cylinder radius="-1" length="1"/>'),
    "cylinder": visual('<cylinder radius="0.01" length="1"/>'),
    "mesh of scale 0": visual('<mesh filename="file:///a.stl" scale="0 0 0"/>'),
    "mirrored mesh": visual('<mesh filename="file:///a.stl" scale="-1 1 1"/>'),
    "turned visual": visual('<box size="1 1 1"/>', '<origin quat_xyzw="0 0 0 1"/>'),
    "twice turned visual": visual(
        '<box size="1 1 1"/>', '<origin rpy="0 0 0" quat_xyzw="0 0 0 1"/>'
    ),
    "twice turned inertial": f'<link name="a"><inertial><origin rpy="0 0 0" quat_xyzw="0 0 0 1"/>'
    f"{INERTIA}</inertial></link>",
}
DECLARED = (
    *VERSIONS,
    "1",
    "",
    "1.3",
    "2.0",
    "0.9",
    "01.2",
    "1.02",
    " 1.2",
    "1.2 ",
    "1. 2",
    "1.+2",
    "+1.1",
    "1.-0",
    "1.-1",
    "-1.0",
    "1.",
    ".1",
    "1.1.",
    "1.2.0",
    "1..2",
    "1.0~pre6",
    "one.two",
)
