# SPDX-License-Identifier: Apache-2.0
"""Two arms of vendors, from their own files, against what the vendors' own prefix arguments make.

The recipes are in docs/contributing/arms.md. With MULTIBOT_SOURCES=FOLDER, which holds the checkouts
that ``tests/support/vendors/arms.yaml`` names; skipped without. The judge is xacro with the vendor's
arguments, or the vendor's xacro for two arms; what differs from it is listed here, and why.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml
from fleet_folder import built_fleet
from lxml import etree
from vendor_arm_pages import text_of
from vendor_sources import VARIABLE, installed_sources

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.launch import missing as without_launch

pytestmark = pytest.mark.slow

UR = "Universal_Robots_ROS2_Driver"
FR3 = "franka_ros2/franka_fr3_moveit_config"
XARM = "xarm_ros2/xarm_moveit_config"
GEN3 = "ros2_kortex/kortex_moveit_config/kinova_gen3_7dof_robotiq_2f_85_moveit_config/config"
# What an element's attribute is in the vendor's output -> in ours, for the robot left.
Differences = frozenset[tuple[str, str, str, str]]


class Arm(NamedTuple):
    """``prefix`` is the vendor's own argument; ``others`` are differences from its output, ``bare``
    those of names that are of no matter and that only the vendor's prefix reaches."""

    description: str
    srdf: str
    arguments: Mapping[str, str]
    prefix: Mapping[str, str]
    params: tuple[str, ...]
    moveit: tuple[str, ...]
    rviz: str
    others: Differences
    bare: str = ""
    findings: frozenset[str] = frozenset()


def _of(folder: str, *names: str) -> tuple[str, ...]:
    return tuple(f"{folder}/{name}" for name in names)


ARMS = {
    "ur5e": Arm(
        f"{UR}/ur_robot_driver/urdf/ur.urdf.xacro",
        f"{UR}/ur_moveit_config/srdf/ur.srdf.xacro",
        {"ur_type": "ur5e", "name": "ur"},
        {"tf_prefix": "{robot}_"},
        _of(f"{UR}/ur_robot_driver/config", "ur_controllers.yaml", "ur5e_update_rate.yaml"),
        _of(
            f"{UR}/ur_moveit_config/config",
            *("kinematics.yaml", "joint_limits.yaml", "moveit_controllers.yaml", "ur_servo.yaml"),
            *("ompl_planning.yaml", "pilz_cartesian_limits.yaml"),
        ),
        f"{UR}/ur_moveit_config/config/moveit.rviz",
        # Two components of one name cannot be loaded by one controller manager.
        frozenset({("robot", "name", "ur", "left_ur"), ("ros2_control", "name", "ur", "left_ur")}),
        # The description has no effort interfaces: forward_effort_controller cannot be loaded.
        findings=frozenset({"MB229"}),
    ),
    "fr3": Arm(
        "franka_ros2/franka_bringup/urdf/franka_arm.urdf.xacro",
        "franka_description/robots/fr3/fr3.srdf.xacro",
        {"robot_type": "fr3"},
        {"arm_prefix": "{robot}"},
        _of(f"{FR3}/config", "fr3_ros_controllers.yaml"),
        _of(f"{FR3}/config", "kinematics.yaml", "fr3_joint_limits.yaml", "fr3_controllers.yaml"),
        f"{FR3}/rviz/moveit.rviz",
        # The vendor's prefix leaves one link that both arms would have.
        frozenset(
            {
                ("robot", "name", "fr3", "left_fr3"),
                ("link", "name", "base", "left_base"),
                ("parent", "link", "base", "left_base"),
            }
        ),
        # arm_prefix of the hardware is not read.
        "visual collision param",
        frozenset({"MF201"}),
    ),
    "xarm6": Arm(
        "xarm_ros2/xarm_description/urdf/xarm_device.urdf.xacro",
        f"{XARM}/srdf/xarm.srdf.xacro",
        {"dof": "6"},
        {"prefix": "{robot}_"},
        _of("xarm_ros2/xarm_controller/config", "xarm6_controllers.yaml"),
        _of(f"{XARM}/config/xarm6", "kinematics.yaml", "joint_limits.yaml", "controllers.yaml"),
        f"{XARM}/rviz/moveit.rviz",
        frozenset({("robot", "name", "UF_ROBOT", "left_UF_ROBOT")}),
        "material",
        # The config shows no description that was sent before rviz2 started.
        frozenset({"MB873"}),
    ),
    "gen3": Arm(
        "ros2_kortex/kortex_description/robots/gen3.xacro",
        f"{GEN3}/gen3.srdf",
        {
            "dof": "7",
            "gripper": "robotiq_2f_85",
            "gripper_joint_name": "robotiq_85_left_knuckle_joint",
        },
        # The hardware takes the joint as it is, without the prefix.
        {"prefix": "{robot}_", "gripper_joint_name": "{robot}_robotiq_85_left_knuckle_joint"},
        _of(GEN3, "ros2_controllers.yaml"),
        _of(GEN3, "kinematics.yaml", "joint_limits.yaml", "moveit_controllers.yaml"),
        f"{GEN3}/moveit.rviz",
        frozenset(
            {
                ("robot", "name", "gen3", "left_gen3"),
                (
                    *("ros2_control", "name", "RobotiqGripperHardwareInterface"),
                    "left_RobotiqGripperHardwareInterface",
                ),
            }
        ),
        # Both arms have the address and the port that are the defaults of the xacro.
        findings=frozenset({"MB412"}),
    ),
}
LAYOUTS = ("frames-per-robot", "both", "tf-per-robot", "postfix")
ROBOTS = ("left", "right", "middle")


sources = pytest.fixture(scope="module")(installed_sources)


# The vendor's own argument in the fleet file, filled, or left: then names are the layout's alone.
OWN, FILLED, BARE = "own argument", "filled", "bare"
FILLING = "MF840"
Build = Callable[..., tuple[dict[str, bytes], list[Finding]]]


@pytest.fixture
def build(sources: Path, tmp_path: Path) -> Build:
    def built(
        arm: Arm, way: str, layout: str = "frames-per-robot", count: int = 2, groups: str = "keep"
    ) -> tuple[dict[str, bytes], list[Finding]]:
        paths = (arm.description, arm.srdf, *arm.params, *arm.moveit, arm.rviz)
        missing = [it for it in paths if not (sources / it).exists()]
        if missing:
            pytest.skip(f"{VARIABLE} lacks {', '.join(missing)}")
        fleet = {
            "distro": "jazzy",
            "layout": layout,
            "affix": "prefix",
            "separators": {"link": "_"},
            "groups": groups,
            "description": str(sources / arm.description),
            "srdf": str(sources / arm.srdf),
            "arguments": {**arm.arguments, **(arm.prefix if way == OWN else {})},
            "fill_arguments": way == FILLED,
            "node_sets": ["ros2_control", "moveit"],
            "simulator": "none",
            "related_files": {
                "params": [str(sources / it) for it in arm.params],
                "moveit": [str(sources / it) for it in arm.moveit],
                "rviz": str(sources / arm.rviz),
            },
            "robots": [{"name": it} for it in ROBOTS[:count]],
        }
        (tmp_path / "fleet.yaml").write_text(yaml.safe_dump(fleet))
        made = built_fleet(tmp_path / "fleet.yaml")
        return {it.path: it.data for it in made.files}, list(made.findings)

    return built


def vendors(arm: Arm, sources: Path, robot: str, path: str) -> etree._Element:
    """Return what the vendor's xacro makes with its own prefix argument."""
    prefix = {name: text.format(robot=robot) for name, text in arm.prefix.items()}
    arguments = {**arm.arguments, **prefix} if path.endswith(".xacro") else {}
    return etree.fromstring(read_whole(str(sources / path), arguments, False).data)


def ours(files: Mapping[str, bytes], robot: str, path: str) -> etree._Element:
    name = Path(path).name.removesuffix(".xacro")
    return etree.fromstring(files[f"{robot}/{name if '.' in name else f'{name}.urdf'}"])


def differences(one: etree._Element, other: etree._Element) -> Iterator[tuple[str, str, str, str]]:
    """Yield what differs, element by element; a text is the attribute ``text``."""
    elements = [[it for it in root.iter() if isinstance(it.tag, str)] for root in (one, other)]
    assert len(elements[0]) == len(elements[1])
    for before, after in zip(*elements, strict=True):
        assert before.tag == after.tag
        values = [{**it.attrib, "text": (it.text or "").strip()} for it in (before, after)]
        for name in dict.fromkeys(key for it in values for key in it):
            old, new = (it.get(name, "") for it in values)
            if old != new:
                yield before.tag, name, old, new


def _is_own(name: str, way: str) -> bool:
    """Are names the vendor's argument's? That of gen3 misses a joint that another argument names."""
    return way == OWN or (way == FILLED and name != "gen3")


@pytest.mark.parametrize("way", [OWN, FILLED, BARE])
@pytest.mark.parametrize("name", ARMS)
def test_the_description_is_that_of_the_vendors_prefix(
    name: str, way: str, build: Build, sources: Path
) -> None:
    arm = ARMS[name]
    files, findings = build(arm, way)
    vendor = vendors(arm, sources, "left", arm.description)
    found = set(differences(vendor, ours(files, "left", arm.description)))
    of_no_matter = (
        set() if _is_own(name, way) else {it for it in found if it[0] in arm.bare.split()}
    )
    assert found - of_no_matter == arm.others
    assert all(old == f"left_{new}" for _, _, old, new in of_no_matter)
    assert {it.code for it in findings} <= arm.findings | {FILLING}
    assert (FILLING in {it.code for it in findings}) == (way == FILLED)
    assert not [it for it in findings if it.level == "error"]


@pytest.mark.parametrize("way", [OWN, FILLED, BARE])
@pytest.mark.parametrize("name", ARMS)
def test_moveits_files_and_parameters_fit_the_vendors_description(
    name: str, way: str, build: Build, sources: Path
) -> None:
    arm = ARMS[name]
    files, _ = build(arm, way)
    vendor = vendors(arm, sources, "left", arm.description)
    joints = {it.get("name") for it in vendor.iterfind("joint")}
    links = {it.get("name") for it in vendor.iterfind("link")} | {"left_base"}
    srdf = ours(files, "left", arm.srdf)
    named = {it.get("name") for it in srdf.iterfind("*/joint")} - {
        it.get("name") for it in srdf.iterfind("virtual_joint")
    }
    assert named
    assert named <= joints
    ends = ("link1", "link2", "base_link", "tip_link", "parent_link", "child_link")
    told = {text for it in srdf.iter() for end, text in it.attrib.items() if end in ends}
    assert told
    assert told <= links
    for path in (*arm.params, *arm.moveit):
        data = yaml.safe_load(files[f"left/{Path(path).name}"])
        assert _joints(data) <= joints, path


def _joints(data: Any) -> set[str]:
    """Everything in a file that is called as joints are, keys and values."""
    words = re.findall(
        r"[\w/]*joint_?\d\b|[\w/]*(?:pan|lift|elbow|wrist_\d|knuckle)_joint", str(data)
    )
    return set(words)


def test_the_controllers_of_ur_are_those_that_its_launch_file_fills(
    build: Build, sources: Path
) -> None:
    """ParameterFile(allow_substs=True) of ur_control.launch.py, for tf_prefix:=left_."""
    arm = ARMS["ur5e"]
    vendor = yaml.safe_load(
        (sources / arm.params[0]).read_text().replace("$(var tf_prefix)", "left_")
    )
    for way in (OWN, FILLED, BARE):
        made = yaml.safe_load(build(arm, way)[0]["left/ur_controllers.yaml"])
        # Its frame is named in no file: the default would be one frame of both arms.
        added = made["/left/joint_state_broadcaster"]
        assert added == {"ros__parameters": {"frame_id": "left_base_link"}}
        kept = {it: made[it] for it in made if it != "/left/joint_state_broadcaster"}
        assert kept == {f"/left/{node}": values for node, values in vendor.items()}


def test_both_srdfs_of_xarm_are_its_own_for_two_arms(build: Build, sources: Path) -> None:
    arm = ARMS["xarm6"]
    path = f"{XARM}/srdf/dual_xarm.srdf.xacro"
    arguments = {"prefix_1": "left_", "prefix_2": "right_", "dof_1": "6", "dof_2": "6"}
    vendor = etree.fromstring(read_whole(str(sources / path), arguments, False).data)
    files, _ = build(arm, OWN)
    made = [it for robot in ROBOTS[:2] for it in ours(files, robot, arm.srdf)]
    assert _texts(made) == _texts(vendor)


def test_both_descriptions_of_xarm_are_its_own_for_two_arms(build: Build, sources: Path) -> None:
    arm = ARMS["xarm6"]
    path = "xarm_ros2/xarm_description/urdf/dual_xarm_device.urdf.xacro"
    arguments = {"prefix_1": "left_", "prefix_2": "right_", "dof_1": "6", "dof_2": "6"}
    vendor = etree.fromstring(read_whole(str(sources / path), arguments, False).data)
    files, _ = build(arm, OWN)
    made = [it for robot in ROBOTS[:2] for it in ours(files, robot, arm.description)]
    # The second arm is 1 m beside the first one: here it is a pose.
    mount = vendor.find("joint[@name='right_world_joint']/origin")
    assert mount.get("xyz") == "0 1 0"
    mount.set("xyz", "0 0 0")
    for tag in ("link", "joint"):
        both = [_texts(it for it in of if it.tag == tag) for of in (made, vendor)]
        # The vendor's world is one link; ours is in each robot's text.
        assert set(both[0]) == set(both[1])
    # The vendor's hardware is called alike twice: the second one is not loaded.
    names = [it.get("name") for it in made if it.tag == "ros2_control"]
    assert len(names) == len(set(names)) == 2


VENDORS_CELL = """\
import json
from uf_ros_lib.moveit_configs_builder import DualMoveItConfigsBuilder

words = dict(dof="6", robot_type="xarm", prefix_1="left_", prefix_2="right_")
made = DualMoveItConfigsBuilder(controllers_name="controllers", **words)
print(json.dumps(made.to_moveit_configs().to_dict()))
"""


def test_a_cell_of_xarms_is_the_vendors_own_for_two_arms(sources: Path, tmp_path: Path) -> None:
    """Its DualMoveItConfigsBuilder makes the parameters of its one move_group."""
    lacking = without_launch()
    if lacking:
        pytest.skip(lacking)
    fleet = yaml.safe_load(_fleet_of("xarm").replace("src/", f"{sources}/"))
    fleet |= {"cell": {}, "layout": "frames-per-robot", "shared_frames": ["world"]}
    fleet["arguments"] |= {"prefix": "{robot}_"}
    for robot in fleet["robots"]:
        del robot["pose"]
    fleet["robots"][1]["arguments"] |= {"attach_xyz": "0 1 0"}
    (tmp_path / "fleet.yaml").write_text(yaml.safe_dump(fleet))
    made = built_fleet(tmp_path / "fleet.yaml")
    assert {it.code for it in made.findings} <= {"MB873"}
    (file,) = (it.data for it in made.files if it.path == "cell/moveit_parameters.yaml")
    ours = yaml.safe_load(file)["/**"]["ros__parameters"]
    vendor = _of_the_vendors_builder(sources)
    for key in ("robot_description_kinematics", "robot_description_planning"):
        assert ours[key] == vendor[key]
    simple = "moveit_simple_controller_manager"
    # Here each arm has a controller manager, in its namespace.
    spelled = re.sub(r"(left|right)_(xarm6_traj_controller)", r"\1/\2", json.dumps(vendor[simple]))
    assert ours[simple] == json.loads(spelled)
    for key in ("robot_description", "robot_description_semantic"):
        one, other = (etree.fromstring(it[key].encode()) for it in (ours, vendor))
        for it in (*one.findall("ros2_control"), *other.findall("ros2_control")):
            # The vendor's two have one name, and no address is given above.
            it.attrib.pop("name")
            for address in it.findall("hardware/param[@name='robot_ip']"):
                address.text = ""
        assert set(_texts(one)) == set(_texts(other))


def _of_the_vendors_builder(sources: Path) -> Any:
    folders = ("xarm_ros2/uf_ros_lib", "launch_param_builder", "moveit2/moveit_configs_utils")
    paths = [*(str(sources / it) for it in folders), os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    command = [sys.executable, "-c", VENDORS_CELL]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize("page", ["ur", "franka", "xarm", "kinova"])
def test_a_cell_of_a_pages_arms_is_one_robot_for_referees(
    page: str, sources: Path, tmp_path: Path
) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    fleet = yaml.safe_load(_fleet_of(page).replace("src/", f"{sources}/"))
    fleet |= {"cell": {}, "layout": "frames-per-robot"}
    (tmp_path / "fleet.yaml").write_text(yaml.safe_dump(fleet))
    made = built_fleet(tmp_path / "fleet.yaml")
    assert not [it for it in made.findings if it.level == "error"]
    files = {it.path: it.data for it in made.files}
    cell = pinocchio.buildModelFromXML(files["cell/cell.urdf"].decode())
    texts = [ours(files, it, fleet["description"]) for it in ("left", "right")]
    arms = [pinocchio.buildModelFromXML(etree.tostring(it).decode()) for it in texts]
    # universe is the root of each.
    assert set(cell.names) == {name for it in arms for name in it.names}
    assert cell.nq == sum(it.nq for it in arms)
    srdf = etree.fromstring(files["cell/cell.srdf"])
    links = {it.get("name") for it in etree.fromstring(files["cell/cell.urdf"]).iter("link")}
    pairs = srdf.findall("disable_collisions")
    assert {it.get(end) for it in pairs for end in ("link1", "link2")} <= links
    each = [
        ours(files, it, fleet["srdf"]).findall("disable_collisions") for it in ("left", "right")
    ]
    assert len(pairs) == sum(map(len, each)) > 0


def _fleet_of(page: str) -> str:
    text = text_of(page)
    return re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)[0]


def _texts(elements: Any) -> list[str]:
    """Elements as text without white space between tags, sorted."""
    parts = (it for it in elements if isinstance(it.tag, str))
    return sorted(re.sub(r">\s+<", "><", etree.tostring(it).decode()).strip() for it in parts)


@pytest.mark.parametrize(("layout", "count"), [("both", 2), ("postfix", 3), ("tf-per-robot", 3)])
@pytest.mark.parametrize("name", ARMS)
def test_another_layout_and_three_robots_have_no_false_findings(
    name: str, layout: str, count: int, build: Build
) -> None:
    arm = ARMS[name]
    files, findings = build(arm, FILLED, layout, count, groups="rename")
    assert not [it for it in findings if it.level == "error"]
    # One RViz reads one tf topic, and topics of controllers are named in MoveIt's file.
    usual = {"MF203", "MR101", FILLING} | ({"MF202"} if layout == "postfix" else set())
    assert {it.code for it in findings} <= arm.findings | usual
    for robot in ROBOTS[:count]:
        groups = {it.get("name") for it in ours(files, robot, arm.srdf).iterfind("group")}
        config = yaml.safe_load(files[f"{robot}/{Path(arm.rviz).name}"])
        shown = config["Visualization Manager"]["Displays"]
        for it in shown:
            if it["Class"] == "moveit_rviz_plugin/MotionPlanning" and layout != "postfix":
                topic = it["Planned Path"]["Trajectory Topic"]
                assert topic in (f"/{robot}/display_planned_path", "display_planned_path")
        solvers = yaml.safe_load(files[f"{robot}/kinematics.yaml"])
        assert set(solvers) <= groups


@pytest.mark.parametrize("page", ["ur", "franka", "xarm", "kinova"])
def test_the_fleet_of_a_page_is_built(page: str, sources: Path, tmp_path: Path) -> None:
    text = text_of(page)
    fleet = _fleet_of(page)
    path = tmp_path / "fleet.yaml"
    path.write_text(re.sub(r"\bsrc/", f"{sources}/", fleet))
    made = built_fleet(path)
    # What is left is on the page; MF203 says that each arm has its own RViz.
    assert {it.code for it in made.findings} - {"MF203", FILLING} <= set(
        re.findall(r"M[BF]\d{3}", text)
    )
    assert not [it for it in made.findings if it.level == "error"]
    commands = next(it.data.decode() for it in made.files if it.path == "commands.md")
    assert commands.count("static_transform_publisher") == 2
    assert commands.count("rviz2 -d") == 2
