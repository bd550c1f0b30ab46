# SPDX-License-Identifier: Apache-2.0
"""Every node set x release x layout x simulator, with a description and no further file.

python tests/support/node_set_cells.py [WORD ...]     what is wrong; only cells with these words
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Sequence
from itertools import combinations, product
from pathlib import Path
from typing import NamedTuple

import yaml
from fleet_folder import planned_fleet

from multibot_rewrite import knowledge
from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.findings.finding import ERROR, NOTE, Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES, has_release
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.fleet.file.robot_choice import Choice
from multibot_rewrite.fleet.outputs.output_file import OutputFile

ROOT = Path(__file__).parents[2]
NODE_SETS = tuple(yaml.safe_load(own_text(knowledge.__file__, "node_sets.yaml"))["node_sets"])
LAYOUTS = ("postfix", "tf-per-robot", "both", "frames-per-robot", "frame-prefix")
SIMULATORS = ("gazebo", "none")
# A drive of gz-sim; one of Gazebo Classic, whose root is base_footprint; an SDF whose drive has its
# default topics; wheels under ros2_control in gz-sim; an arm with real hardware and an SRDF.
ROBOTS = {
    "gz": "examples/launch_tutorial/rover.urdf",
    "classic": "fixtures/robots/rover.urdf",
    "sdf": "fixtures/robots/rover.sdf",
    "controlled": "fixtures/robots/rover_gz.urdf",
    "arm": "examples/two_arms_moveit/arm.urdf",
}
SRDF = ROOT / "examples/two_arms_moveit/arm.srdf"
# Node sets of controllers whose manager something else makes.
OF_MANAGERS = ("controllers", "gz_ros2_control", "gazebo_ros2_control")
OF_ARMS = ("moveit", "rviz_moveit", "ros2_control", "robot_state", "static_tf", *OF_MANAGERS)
NOTHING = "no node"
# Node sets of which each says alone where the robot is on the map: two contradict each other.
ON_MAP = {
    **dict.fromkeys(("localization", "nav2", "nav2_composed"), "amcl"),
    **dict.fromkeys(("nav2_slam", "nav2_slam_composed", "slam_toolbox"), "slam_toolbox"),
    **{it: it for it in ("cartographer", "rtabmap", "robot_localization_gps")},
}
# Two node sets -> the codes that their user is told, since the node sets contradict each other.
CONTRADICTING = {
    # One joystick has the drive's own topic and that of the mux.
    frozenset({"teleop", "teleop_direct"}): {"MG102"}
}
# What the user's own description is warned about, whatever runs beside it.
OF_DESCRIPTIONS = {
    "gz": set(),
    "classic": {"MB902", "MB439"},
    "sdf": {"MF712", "MB439"},
    "controlled": {"MB425", "MB426", "MB439", "MR105"},
    "arm": set(),
}


# A description and a node set -> the codes of warnings about what the description lacks.
LACKING = {
    # Its one sensor is a colour camera: no scanner, no depth.
    ("sdf", "rtabmap"): {"MF861"},
    **{("sdf", it): set() for it in ("slam_toolbox", "nav2_slam", "nav2_slam_composed")},
}
# What waits for a camera that the description has not.
WITHOUT_CAMERA = {("gz", "image_proc"): {"MF861"}}


class Cell(NamedTuple):
    """Two robots of a description with one node set."""

    robot: str
    node_set: str
    release: str
    layout: str
    simulator: str

    @property
    def fleet(self) -> str:
        """The text of its fleet file. A real robot has no start pose: something may know its place."""
        srdf = f"srdf: {SRDF}\n" if self.robot == "arm" else ""
        apart = [f", pose: {{y: {y}}}" if self.simulator == "gazebo" else "" for y in (0.0, 3.0)]
        robots = ", ".join(f"{{name: robot{at + 1}{it}}}" for at, it in enumerate(apart))
        return (
            f"distro: {self.release}\nlayout: {self.layout}\nsimulator: {self.simulator}\n"
            f"node_sets: [{self.node_set}]\ndescription: {ROOT / ROBOTS[self.robot]}\n{srdf}"
            f"robots: [{robots}]\n"
        )


def refused(cell: Cell) -> set[str]:
    """Return the codes of the errors of a cell, by what its input lacks or contradicts."""
    hardware = cell.robot in ("controlled", "arm")
    wrong = set()
    if cell.node_set == "moveit" and cell.robot != "arm":
        wrong.add("MF857")  # no SRDF
    if cell.node_set == "ros2_control" and not hardware:
        wrong.add("MF857")  # no <ros2_control>
    controlled = cell.node_set in ("ros2_control", *OF_MANAGERS)
    if cell.robot == "controlled" and cell.simulator == "none" and controlled:
        wrong.add("MF843")  # the hardware of a simulator on a real robot
    if cell.node_set in OF_MANAGERS and cell.robot != "controlled":
        wrong.add("MG723")  # nothing starts a controller manager
    if cell.node_set == "no_robot_state_publisher" and cell.simulator == "none":
        wrong.add(NOTHING)  # its only word is that a node is left out: no node is left
    # move_group reads the links as the URDF has them, and this layout renames them at run time only.
    if cell.layout == "frame-prefix" and (cell.node_set == "moveit" or cell.robot == "arm"):
        wrong.add("MF837")
    return wrong


def shares_rules(release: str, layout: str) -> bool:
    """Do controllers in a simulator get the rules of its first robot, where each needs its own? On
    Humble the plugins hand theirs to rclcpp::init, which counts once a process
    (ign_ros2_control_plugin.cpp, gazebo_ros2_control_plugin.cpp), so that two robots publish on one
    /joint_states/NAME."""
    return release == "humble" and layout == "postfix"


def pairs() -> Iterator[tuple[str, str]]:
    """Yield every two node sets of which one does not leave out what the other one is."""
    for one, other in combinations(NODE_SETS, 2):
        if {one, other} != {"robot_state", "no_robot_state_publisher"}:
            yield one, other


def pair_faults(one: str, other: str, release: str, folder: Path) -> list[str]:
    """Return what is wrong with two node sets of one robot between ends that the build adds."""
    cell = Cell("gz", f"{one}, {other}", release, "tf-per-robot", "gazebo")
    known = CONTRADICTING.get(frozenset({one, other}), set())
    places = {ON_MAP.get(one), ON_MAP.get(other)}
    if None not in places and len(places) == 2:
        known = {"MG323", "MG408"}
    for node_set in (one, other):
        known = known | refused(cell._replace(node_set=node_set))
        known = known | WITHOUT_CAMERA.get((cell.robot, node_set), set())
    return [str(it) for it in findings(cell, folder) if it.code not in known]


def lives(cell: Cell) -> bool:
    """Is there such a robot? Gazebo Classic ends with Humble, and an arm does not drive."""
    return {"classic": has_release("humble", cell.release), "arm": cell.node_set in OF_ARMS}.get(
        cell.robot, True
    )


def cells(robot: str) -> Iterator[Cell]:
    every = product((robot,), NODE_SETS, RELEASES, LAYOUTS, SIMULATORS)
    return (it for it in (Cell(*words) for words in every) if lives(it))


def is_driven(cell: Cell) -> bool:
    """Is it built and judged by the drive test?"""
    return (
        cell.robot in ("gz", "classic", "sdf") and cell.simulator == "gazebo" and not refused(cell)
    )


def findings(cell: Cell, folder: Path) -> tuple[Finding, ...]:
    """Return what the build of a cell says that is no note."""
    file = folder / "fleet.yaml"
    file.write_text(cell.fleet)
    return of_file(file)


def of_file(file: Path) -> tuple[Finding, ...]:
    """Return what the build of a fleet file says that is no note."""
    return built(file, file.parent / "out")[0]


def built(file: Path, out: Path) -> tuple[tuple[Finding, ...], tuple[OutputFile, ...]]:
    """Return what the build of a fleet file into a folder says that is no note, and the files that it
    would write."""
    plan = planned_fleet(file, choice=Choice())
    try:
        made = make_outputs(plan, str(out))
    except UsageError as error:
        return (Finding(NOTHING, ERROR, str(error)),), ()
    back = read_back(plan, made, str(out))
    told = (it for it in made.findings if it._replace(level=ERROR) not in back)
    every = dict.fromkeys((*told, *back, *plan.fleet.table.problems))
    return tuple(it for it in every if it.level != NOTE), made.files


def faults(cell: Cell, folder: Path) -> list[str]:
    """Return what is wrong with a cell: an error that its input does not have, one that is
    missing, and warnings between what only the build adds."""
    return wrong_in(cell, findings(cell, folder))


def wrong_in(cell: Cell, found: Sequence[Finding]) -> list[str]:
    """Return the same, of what its build has ``found``."""
    errors = {it.code for it in found if it.level == ERROR}
    wanted = refused(cell)
    # What follows from hardware of another world may be said of its spawners as well.
    known = wanted | {"MG723"} if "MF843" in wanted else wanted
    wrong = [str(it) for it in found if it.level == ERROR and it.code not in known]
    wrong += [f"no {code}" for code in sorted(wanted - errors)]
    if not wanted:
        own = OF_DESCRIPTIONS[cell.robot] | LACKING.get(cell[:2], set())
        own = own | WITHOUT_CAMERA.get(cell[:2], set())
        wrong += [str(it) for it in found if it.level != ERROR and it.code not in own]
    return wrong


def main(words: list[str]) -> int:
    count = bad = 0
    with tempfile.TemporaryDirectory() as folder:
        for cell in (it for robot in ROBOTS for it in cells(robot) if {*words} <= {*it}):
            count += 1
            wrong = faults(cell, Path(folder))
            bad += bool(wrong)
            if wrong:
                print(" ".join(cell), "|", "; ".join(wrong)[:300], flush=True)
    print(f"{count} cells, {bad} wrong")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
