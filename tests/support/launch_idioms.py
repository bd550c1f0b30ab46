# SPDX-License-Identifier: Apache-2.0
"""What launch authors write, each as a launch file of its own: docs/contributing/launch-idioms.md.

    python tests/support/launch_idioms.py            try each in the launch that is here, print the page
    python tests/support/launch_idioms.py --write    write the page

Needs launch and launch_ros; nav2_common, simple_launch and moveit_configs_utils for those beside ours.
"""

from __future__ import annotations

import re
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from launched_programs import launched
from paths import FIXTURES, ROOT, fixture_text

PAGE = ROOT / "docs" / "contributing" / "launch-idioms.md"
SOURCES = FIXTURES / "launch_idioms"
ROVER, ARM = FIXTURES / "robots" / "rover.urdf", FIXTURES / "robots" / "two_finger_arm.urdf"
# The programs that a launch file may start here, by name.
PROGRAMS = {
    **{"spawner": "controller_manager", "driver": "my_driver", "amcl": "nav2_amcl"},
    **{"component_container": "rclcpp_components", "move_group": "moveit_ros_move_group"},
}
# Those of a MoveIt package for one arm.
ARM_FILES = (
    "arm.urdf",
    "arm.srdf",
    "joint_limits.yaml",
    "kinematics.yaml",
    "moveit_controllers.yaml",
    "pilz_cartesian_limits.yaml",
)
WORKS = "works"
_ABORTED = re.compile(r"Caught exception in launch.*?: (?:Caught multiple .*\n - )?(.+)")
_ABOUT = re.compile(r"(?:#|<!--) (.+?)(?: -->)?\n")


class Idiom(NamedTuple):
    """A launch file: what it is about, what it needs besides launch_ros, the programs that it has to
    start, with their number, and what became of it before."""

    file: Path
    about: str
    needs: str
    starts: dict[str, int]
    before: str


def idioms() -> list[Idiom]:
    """Those of ``fixtures/launch_idioms``: four lines at the top of each file say the rest."""
    files = (it for it in sorted(SOURCES.iterdir()) if ".launch." in it.name)
    return [_idiom(it) for it in files]


def _idiom(file: Path) -> Idiom:
    about, *words = _ABOUT.findall(file.read_text())[:4]
    told = dict(it.split(": ", 1) for it in words if ": " in it)
    pairs = (it.split(" ") for it in told["starts"].split(", "))
    starts = {name: int(count) for count, name in pairs}
    return Idiom(file, about, told.get("needs", ""), starts, told["before"])


def is_missing(idiom: Idiom) -> bool:
    """Is a package missing that it shows beside ours?"""
    return bool(idiom.needs) and find_spec(idiom.needs) is None


def tried(idiom: Idiom, folder: Path) -> str:
    """Return what becomes of it in the real launch: that it works, or what launch says."""
    for it in SOURCES.iterdir():
        (folder / it.name).write_bytes(it.read_bytes())
    (folder / "rover.urdf").write_text(ROVER.read_text())
    (folder / "arm.urdf").write_text(ARM.read_text())
    arm = {f"arm_moveit/config/{it}": (folder / it).read_text() for it in ARM_FILES}
    try:
        told, said = launched(folder / idiom.file.name, folder, programs=PROGRAMS, more=arm)
    except AssertionError as error:
        told, said = [], str(error)
    wrong = _ABORTED.search(said)
    if wrong:
        return f"aborts: {wrong[1].replace(str(folder), '')}"
    names = [Path(it["words"][0]).name for it in told]
    counts = {name: names.count(name) for name in idiom.starts}
    return WORKS if counts == idiom.starts else f"starts {counts}"


HEAD = fixture_text("launch_idioms_head.txt")


def page(outcomes: dict[str, str]) -> str:
    """Return the page, with what became of each by file name."""
    every = idioms()
    rows = [
        f"| [{it.about}](../../fixtures/launch_idioms/{it.file.name}) | {it.before} | "
        f"{outcomes[it.file.name]} |"
        for it in every
    ]
    return f"{HEAD}{chr(10).join(rows)}\n"


def main() -> int:
    """Try all, print or write the page."""
    outcomes = {}
    for it in idioms():
        if is_missing(it):
            sys.exit(f"{it.file.name} needs {it.needs}, which is not here")
        with tempfile.TemporaryDirectory() as folder:
            outcomes[it.file.name] = tried(it, Path(folder))
        print(it.file.name, outcomes[it.file.name], file=sys.stderr)
    text = page(outcomes)
    if "--write" in sys.argv:
        PAGE.write_text(text)
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
