# SPDX-License-Identifier: Apache-2.0
"""Bridge, static transforms, spawning and teleoperation of a fleet."""

from __future__ import annotations

import shlex
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from beside import findings_of
from fleet_folder import planned_fleet
from paths import CORPUS

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.base.rosnames import check_full_name, check_topic_name
from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs import spawn, teleop
from multibot_rewrite.fleet.outputs.bridge_outputs import fill_bridge, merge_bridges
from multibot_rewrite.fleet.robots import start_poses
from multibot_rewrite.planning.bridged_topics import BridgedTopic, bridged_topics
from multibot_rewrite.planning.start import shell_line
from multibot_rewrite.related_files.bridge import BridgeFile, rewrite_bridge
from multibot_rewrite.related_files.context import make_context
from multibot_rewrite.related_files.yaml_text import read_yaml

LAYOUTS = ("L1", "L2", "L3", "L4")
TYPES = "  ros_type_name: a/msg/B\n  gz_type_name: gz.msgs.B\n"


def context(layout: str, *links: str) -> Any:
    declared = defaultdict(dict, {"link": dict.fromkeys(links), "joint": {"hip": None}})
    side = "postfix" if layout == "L4" else "prefix"
    return make_context(declared, make_naming(layout, side), (), distro=NEWEST_LTS)


def bridged(text: str, layout: str = "L2", *links: str) -> BridgeFile:
    return rewrite_bridge(read_yaml(text.encode(), "bridge.yaml"), context(layout, *links))


def own(text: str, layout: str = "L2", *links: str) -> list[dict[str, Any]]:
    made = bridged(text, layout, *links)
    return yaml.safe_load(fill_bridge(made.own.template, "ns", "word", "rover1")) or []


def one(names: str, layout: str = "L2", *links: str) -> tuple[str, str]:
    """Return the ROS and gz name that an entry has for a robot."""
    rows = "".join(f"  {line}\n" for line in names.split("; "))
    found = own(f"-{rows[1:]}{TYPES}", layout, *links)[0]
    both = found.get("topic_name", "")
    ros, gz = (found.get(f"{side}_topic_name", "") or both for side in ("ros", "gz"))
    assert not (both and ("ros_topic_name" in found or "gz_topic_name" in found)), found
    return ros or gz, gz or ros


@pytest.mark.parametrize(
    ("names", "layout", "ros", "gz"),
    [
        ("topic_name: scan", "L2", "/ns/scan", "/ns/scan"),
        ("topic_name: /scan", "L1", "/ns/scan", "/ns/scan"),
        ("topic_name: /scan", "L4", "/scan/ns", "/scan/ns"),
        ("ros_topic_name: a; gz_topic_name: /b", "L2", "/ns/a", "/ns/b"),
        ("ros_topic_name: a", "L2", "/ns/a", "/ns/a"),
        ("gz_topic_name: a", "L2", "/ns/a", "/ns/a"),
        (
            "topic_name: /model/rover/cmd_vel",
            "L2",
            "/ns/model/rover/cmd_vel",
            "/model/rover1/cmd_vel",
        ),
        ("gz_topic_name: /model/rover/pose", "L2", "/ns/model/rover/pose", "/model/rover1/pose"),
        ("ros_topic_name: /tf; gz_topic_name: /model/rover/tf", "L2", "/tf", "/model/rover1/tf"),
        ("ros_topic_name: tf; gz_topic_name: /model/rover/tf", "L2", "/tf", "/model/rover1/tf"),
        ("ros_topic_name: tf; gz_topic_name: /model/rover/tf", "L1", "/ns/tf", "/model/rover1/tf"),
        ("ros_topic_name: tf; gz_topic_name: /model/rover/tf", "L4", "/tf/ns", "/model/rover1/tf"),
        (
            "ros_topic_name: imu; gz_topic_name: /world/w/model/rover/link/base/sensor/s/imu",
            "L2",
            "/ns/imu",
            "/world/w/model/rover1/link/word/base/sensor/s/imu",
        ),
        (
            "ros_topic_name: cmd; gz_topic_name: /model/rover/joint/hip/0/cmd_pos",
            "L2",
            "/ns/cmd",
            "/model/rover1/joint/word_hip/0/cmd_pos",
        ),
        ("topic_name: <robot_namespace>/scan", "L2", "/ns/scan", "/ns/scan"),
        ("ros_topic_name: a; gz_topic_name: /model/<name>/b", "L2", "/ns/a", "/model/rover1/b"),
    ],
)
def test_names_of_an_entry(names: str, layout: str, ros: str, gz: str) -> None:
    assert one(names, layout, "base") == (ros, gz)


def test_a_file_with_words_of_ignition_comes_out_with_those_of_gz() -> None:
    """ros_gz branch humble, bridge_config.cpp (parseEntry): a key of gz wins over its other."""
    text = (
        f"- ros_topic_name: a\n  'ign_topic_name': /model/x/a\n{TYPES}  direction: 'IGN_TO_ROS'\n"
        f"- topic_name: /clock\n{TYPES}  ign_type_name: old\n  direction: ROS_TO_IGN\n"
    ).replace("  gz_type", "  ign_type", 1)
    for distro, count in (("humble", 1), ("jazzy", 0)):
        made = rewrite_bridge(read_yaml(text.encode(), ""), context("L2")._replace(distro=distro))
        filled = fill_bridge(made.own.template, "ns", "word", "r1")
        (*rows,) = (yaml.safe_load(it) or [] for it in (filled, made.shared))
        assert [*map(len, rows)] == [count, count]
        if count:
            types = {"ros_type_name": "a/msg/B", "gz_type_name": "gz.msgs.B"}
            names = {"ros_topic_name": "/ns/a", "gz_topic_name": "/model/r1/a"}
            assert rows[0] == [{**names, **types, "direction": "GZ_TO_ROS"}]
            old = {"ign_type_name": "old", "direction": "ROS_TO_GZ"}
            assert rows[1] == [{"topic_name": "/clock", **types, **old}]


@pytest.mark.parametrize(
    ("entry", "code"),
    [
        (f"- topic_name: a\n  ros_topic_name: b\n{TYPES}", "MB855"),
        (f"- topic_name: a\n  gz_topic_name: b\n{TYPES}", "MB855"),
        ("- topic_name: a\n  ros_type_name: b\n", "MB855"),
        ("- ros_type_name: b\n  gz_type_name: c\n", "MB855"),
        (f"- topic_name: a\n  direction: IN\n{TYPES}", "MB855"),
        ("- just text\n", "MB855"),
        (f"- topic_name: a\n  gz_ros_topic_name: b\n{TYPES}", "MB858"),
        (f"- ros_topic_name: a/$(var b)\n{TYPES}", "MB105"),
        (f"- gz_topic_name: /model/x/joint/hip/0/cmd_pos\n{TYPES}", "MB312"),
        (f"- topic_name: /model/x/a\n{TYPES}- topic_name: /model/door/b\n{TYPES}", "MB889"),
        (f"- topic_name: a\n  lazy: base\n{TYPES}", "MB901"),
        (f"- ros_topic_name: a\n  gz_topic_name: /model/x/link/bas/a\n{TYPES}", "MB853"),
    ],
)
def test_mistakes_in_an_entry_are_reported(entry: str, code: str) -> None:
    assert [it.code for it in findings_of(bridged(entry, "L2", "base").own)] == [code]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "is empty"),
        ("a: b\n", "not a list of topics"),
        ("[{topic_name: a}]\n", "in brackets"),
        (f"- &a\n  topic_name: b\n{TYPES}", "anchor"),
    ],
)
def test_a_file_that_is_no_bridge(text: str, why: str) -> None:
    with pytest.raises(InputError, match=why):
        bridged(text)


def test_a_model_that_no_gz_topic_can_hold() -> None:
    made = bridged(f"- topic_name: /model/a/b\n{TYPES}").own.template
    with pytest.raises(InputError, match="'my rover'"):
        fill_bridge(made, "ns", "word", "my rover")


def test_one_file_of_all_robots_and_of_what_descriptions_say() -> None:
    text = "- topic_name: scan  # lidar\n" + TYPES
    made = bridged(text)
    texts = [(name, fill_bridge(made.own.template, name, name, name)) for name in ("r1", "r2")]
    clock = f"---\n  - topic_name: /clock\n{TYPES.replace('  r', '    r').replace('  g', '    g')}"
    generated = [
        BridgedTopic("", "/clock", "/clock", "c", "c", "GZ_TO_ROS"),
        BridgedTopic("r1", "/r1/scan", "r1/scan", "s", "s", "GZ_TO_ROS"),
        BridgedTopic("r1", "/r1/imu", "r1/imu", "i", "i", "GZ_TO_ROS"),
    ]
    text, findings = merge_bridges([*texts, ("shared", clock), ("again", clock)], generated)
    names = [it.get("topic_name") or it["gz_topic_name"] for it in yaml.safe_load(text)]
    assert names == ["/r1/scan", "/r2/scan", "/clock", "/r1/imu"] and not findings
    assert text.count("# lidar") == 2


LISTENS = """<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/>
<plugin filename="gz-sim-triggered-publisher-system" name="gz::sim::systems::TriggeredPublisher">
<input type="a" topic="/model/{}/{}"/><output type="b" topic="/tripped"/></plugin></gazebo>"""


@pytest.mark.parametrize(("model", "is_own"), [("rover", True), ("other", False)])
@pytest.mark.parametrize("layout", [*LAYOUTS, "L5"])
def test_a_robot_is_spawned_by_the_name_in_its_topics(
    fleet: Any, layout: str, model: str, is_own: bool
) -> None:
    """DiffDrive.cc makes /model/NAME/odometry of the name that the model is spawned with. The second
    robot has another one in the fleet file."""
    plan = fleet(layout, body=LISTENS.format(model, "odometry"))
    made, findings = spawn.spawns(plan)
    name = plan.robots[0].member.inventory.model if is_own else "r1"
    assert [it.model for it in made] == [name, "second"]
    bridged, _ = bridged_topics(plan.fleet.inventories, plan.fleet.naming, plan.fleet.models)
    own = f"/model/{name}/odometry"
    assert own in {it.gz for it in bridged}
    assert (own in plan.robots[0].description.decode()) == is_own
    assert [it.code for it in findings if it.code == "MF707"] == ["MF707"] * is_own


OLD = '<gazebo><plugin name="p" filename="lib{}.so">{}</plugin></gazebo>'


@pytest.mark.parametrize(
    ("name", "inside", "told"),
    [
        ("gazebo_ros_control", "", True),
        ("gazebo_ros2_control", "", False),
        # gazebo_ros_pkgs has it for both: a fleet's is that of ROS 2, whatever its parameters are.
        ("gazebo_ros_diff_drive", "<commandTopic>cmd_vel</commandTopic>", False),
        ("gazebo_ros_diff_drive", "<ros><remapping>cmd_vel:=go</remapping></ros>", False),
    ],
)
def test_a_plugin_of_ros_1_is_told(fleet: Any, name: str, inside: str, told: bool) -> None:
    _, findings = spawn.spawns(fleet("L1", body=OLD.format(name, inside)))
    said = [it.message for it in findings if it.code == "MF713"]
    assert [f"lib{name}.so" in it for it in said] == ([True, True] if told else [])


def test_two_gz_topics_on_one_ros_topic_are_reported() -> None:
    text = "".join(f"- ros_topic_name: /s\n  gz_topic_name: /{it}\n{TYPES}" for it in "ab")
    assert [it.code for it in merge_bridges([("f", text)], [])[1]] == ["MF506"]


@pytest.fixture(scope="module")
def bridges() -> list[Path]:
    files = sorted((CORPUS / "ros_gz_bridge").glob("**/*.yaml"))
    if not files:
        pytest.skip(f"no corpus of bridge files: looked for {CORPUS / 'ros_gz_bridge'}/**/*.yaml")
    assert len(files) >= 30
    return files


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_bridge_corpus(bridges: list[Path], layout: str) -> None:
    refused: Counter[str] = Counter()
    for path in bridges:
        document = read_yaml(path.read_bytes(), path.name)
        try:
            made = rewrite_bridge(
                document, context(layout, "base_link", "imu_link", "wheel_left_link")
            )
        except InputError as error:
            refused[str(error)] += 1
            continue
        text = fill_bridge(made.own.template, "zorba", "zorba", "zorba")
        problems = list(entry_problems(document.text, text, made.shared))
        assert not problems, f"{path}: {problems}"
    assert not refused


def entry_problems(source: str, text: str, shared: str) -> Iterator[str]:
    """Yield what is wrong with a robot's file: but for names its entries and lines are the source's."""
    before = yaml.safe_load(source)
    after = [*(yaml.safe_load(text) or []), *(yaml.safe_load(shared) or [])]
    if len(before) != len(after):
        yield f"{len(before)} entries became {len(after)}"
    kept = {"topic_name", "ros_topic_name", "gz_topic_name", "frame_id"}
    plain = Counter(str({k: v for k, v in it.items() if k not in kept}) for it in before)
    if plain != Counter(str({k: v for k, v in it.items() if k not in kept}) for it in after):
        yield "something else than a name changed"
    lines = set(source.splitlines())
    yield from (
        f"line {line!r}" for line in text.splitlines() if line not in lines and "zorba" not in line
    )
    for entry in yaml.safe_load(text) or []:
        both = entry.get("topic_name", "")
        ros = both or entry.get("ros_topic_name", "") or entry.get("gz_topic_name", "")
        if not set("<{$") & set(ros) and (check_topic_name(ros) or check_full_name(ros)):
            yield f"{ros} is no full name"


ROVER = """\
<robot name="rover">
  <link name="base">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="lidar"/>
  <joint name="mount" type="fixed"><parent link="base"/><child link="lidar"/></joint>
  {}
</robot>
"""
DRIVE = (
    '<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">'
    "<frame_id>odom</frame_id></plugin></gazebo>"
)


@pytest.fixture
def fleet(here: Path) -> Any:

    def make(
        layout: str, node_set: str = "robot_state", body: str = "", more: str = ""
    ) -> FleetPlan:
        (here / "rover.urdf").write_text(ROVER.format(body))
        side = "postfix" if layout == "L4" else "prefix"
        (here / "fleet.yaml").write_text(
            f"layout: {layout}\naffix: {side}\nnode_sets: {node_set}\n{more}"
            "robots:\n"
            "  - {name: r1, description: rover.urdf,"
            " pose: {x: 1.0, y: -0.5, z: 0.25, roll: 0.1, pitch: 0.2, yaw: 1.57}}\n"
            "  - {name: r2, description: rover.urdf, namespace: two, model: second}\n"
        )
        return planned_fleet("fleet.yaml")

    return make


@pytest.mark.parametrize(
    ("layout", "body", "child", "rules"),
    [
        ("L1", "", "base", ["__ns:=/r1", "__node:=start_pose", "/tf_static:=tf_static"]),
        ("L2", "", "r1/base", ["__ns:=/r1", "__node:=start_pose"]),
        ("L2", DRIVE, "r1/odom", ["__ns:=/r1", "__node:=start_pose"]),
        ("L3", DRIVE, "r1/odom", ["__ns:=/r1", "__node:=start_pose", "/tf_static:=tf_static"]),
        ("L4", DRIVE, "odom/r1", ["__node:=start_pose_r1", "/tf_static:=/tf_static/r1"]),
    ],
)
def test_a_pose_is_a_static_transform(
    fleet: Any, layout: str, body: str, child: str, rules: list[str]
) -> None:
    found = start_poses.start_poses(fleet(layout, body=body))
    assert len(found.transforms) == 1 and not found.findings
    words = shlex.split(shell_line(found.transforms[0].start))
    assert words[:4] == ["ros2", "run", "tf2_ros", "static_transform_publisher"]
    assert words[4:16] == shlex.split("--x 1.0 --y -0.5 --z 0.25 --roll 0.1 --pitch 0.2 --yaw 1.57")
    assert words[16:20] == ["--frame-id", "map", "--child-frame-id", child]
    assert words[20:] == ["--ros-args", *(text for rule in rules for text in ("-r", rule))]


def test_the_map_frame_of_each_robot_is_below_the_world(fleet: Any) -> None:
    more = "shared_frames: [world]\n"
    slam = start_poses.start_poses(
        fleet("L2", "[robot_state, slam_toolbox]", DRIVE, more)
    ).transforms
    assert [(it.parent, it.child, it.pose.x) for it in slam] == [("world", "r1/map", 1.0)]
    amcl = start_poses.start_poses(fleet("L2", "[robot_state, amcl]", DRIVE, more))
    assert [(it.child, it.pose) for it in amcl.transforms] == [("r1/map", start_poses.ORIGIN)]
    assert [it.node for it in amcl.initial] == ["amcl"]


def test_a_description_that_already_starts_with_the_world(fleet: Any) -> None:
    body = (
        '<link name="world"/><joint name="fix" type="fixed">'
        '<parent link="world"/><child link="base"/></joint>'
    )
    found = start_poses.start_poses(fleet("L2", body=body))
    assert not found.transforms and [it.code for it in found.findings] == ["MF709"]
    assert "fixes 'r1/base' to 'world'" in found.findings[0].message


def classic(*namespaces: str) -> str:
    """Plugins that no plugin definitions has, so that nothing is inserted in them."""
    plugins = (
        f'<plugin name="p{at}" filename="libgazebo_ros_acme.so">{namespace}</plugin>'
        for at, namespace in enumerate(namespaces)
    )
    return f"<gazebo>{''.join(plugins)}</gazebo>"


SPACE = "<ros><namespace>/here</namespace></ros>"


@pytest.mark.parametrize(
    ("namespaces", "layout", "given", "codes"),
    [
        (("", ""), "L2", ["-robot_namespace", "/r1"], []),
        ((SPACE, SPACE), "L2", [], []),
        ((SPACE, ""), "L2", [], ["MF706", "MF706"]),
        (("", ""), "L4", [], []),
        # Names have a postfix there, and no plugin gets a namespace.
        ((SPACE, ""), "L4", [], []),
    ],
)
def test_a_namespace_of_the_description_is_not_overwritten(
    fleet: Any, namespaces: tuple[str, ...], layout: str, given: list[str], codes: list[str]
) -> None:
    made, findings = spawn.spawns(fleet(layout, body=classic(*namespaces)))
    assert spawn.spawner(made[0], True).words[16:] == given
    assert [it.code for it in findings] == codes


def test_what_is_in_a_comment_is_for_no_simulator(fleet: Any) -> None:
    bodies = classic(SPACE), f"<!-- {classic(SPACE)} -->"
    assert [spawn.simulators(fleet("L2", body=it)) for it in bodies] == [["classic"], ["gz"]]


@pytest.mark.parametrize(
    ("hardware", "simulators"),
    [
        ("mock_components/GenericSystem", ["classic"]),
        ("acme_driver/Arm", ["classic"]),
        ("gz_ros2_control/GazeboSimSystem", ["classic", "gz"]),
    ],
)
def test_hardware_of_no_simulator_is_in_that_of_the_others(
    fleet: Any, tmp_path: Path, hardware: str, simulators: list[str]
) -> None:
    plugin = f"<hardware><plugin>{hardware}</plugin></hardware>"
    body = f'<ros2_control name="c" type="system">{plugin}</ros2_control>'
    (tmp_path / "arm.urdf").write_text(ROVER.format(body))
    fleet("L2", body=classic(SPACE))
    text = (tmp_path / "fleet.yaml").read_text()
    row = "robots:\n  - {name: a, description: arm.urdf, simulator: gazebo}\n"
    (tmp_path / "fleet.yaml").write_text(text.replace("robots:\n", row))
    assert spawn.simulators(planned_fleet("fleet.yaml")) == simulators


def test_no_namespace_where_nothing_needs_one(fleet: Any) -> None:
    for layout in LAYOUTS:
        made, _ = spawn.spawns(fleet(layout))
        assert "-robot_namespace" not in shell_line(spawn.spawner(made[0], classic=True))


def test_a_bridge_to_the_simulator_reads_commands(fleet: Any) -> None:
    drive = (
        '<gazebo><plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">'
        "<topic>drive</topic></plugin></gazebo>"
    )
    assert [it.topic for it in teleop.teleops(fleet("L2", body=drive))] == [
        "/r1/drive",
        "/two/drive",
    ]
    rows = f"- {{}}topic_name: go\n{TYPES}  direction: {{}}\n".replace("a/msg/B", teleop.PLAIN)
    # One name is that of both sides (ros_gz_bridge bridge_config.cpp).
    to_gz = ((side, "ROS_TO_GZ", ["/r1/go"]) for side in ("", "ros_", "gz_"))
    for side, direction, heard in (*to_gz, ("", "GZ_TO_ROS", [])):
        Path("bridge.yaml").write_text(rows.format(side, direction))
        plan = fleet("L2", more="related_files: {bridge: bridge.yaml}\n")
        assert [it.topic for it in teleop.teleops(plan)][:1] == heard


@pytest.mark.parametrize(
    ("controller", "stamped", "heard"),
    [
        # ros2_controllers 2.54.0: diff_drive_controller.cpp 347 and 371, its default is true ...
        ("diff_drive_controller", "false", "cmd_vel_unstamped"),
        ("diff_drive_controller", "true", "cmd_vel"),
        ("mecanum_drive_controller", "false", "reference_unstamped"),
        # ... and that of steering_controllers_library is false (its .cpp 120 and 126).
        ("ackermann_steering_controller", "true", "reference"),
        ("ackermann_steering_controller", "", "reference_unstamped"),
    ],
)
def test_a_controller_of_humble(fleet: Any, controller: str, stamped: str, heard: str) -> None:
    more = f"    use_stamped_vel: {stamped}\n" if stamped else ""
    Path("own.yaml").write_text(f"{controller}:\n  ros__parameters:\n    publish_rate: 5.0\n{more}")
    plan = fleet("L2", controller, more="distro: humble\nrelated_files: {params: own.yaml}\n")
    it = teleop.teleops(plan)[0]
    assert (it.topic, it.stamped) == (f"/r1/{controller}/{heard}", "unstamped" not in heard)


@pytest.mark.more
def test_a_listener_that_takes_no_stamp_decides(fleet: Any) -> None:
    Path("own.yaml").write_text(
        "nodes:\n"
        "  base: {package: acme, subscribes: {cmd_vel: geometry_msgs/msg/Twist}}\n"
        "  log: {package: acme, subscribes: {cmd_vel: geometry_msgs/msg/TwistStamped}}\n"
        "node_sets:\n  own: {about: both, nodes: [base, log]}\n  half: {about: one, nodes: [log]}\n"
    )
    both, half = (
        teleop.teleops(fleet("L2", node_set, more="nodes: own.yaml\n"))[0]
        for node_set in ("own", "half")
    )
    assert (both.stamped, half.stamped) == (False, True)


POSE = Pose(1.0, -2.0, 0.5, 0.1, 0.2, 1.5)
FLAGS = ["-x", "1.0", "-y", "-2.0", "-z", "0.5", "-R", "0.1", "-P", "0.2", "-Y", "1.5"]
SPAWNED = spawn.Spawn("r1", "rover1", "/r1/robot_description", POSE, "r1")


@pytest.mark.parametrize(
    ("it", "source"),
    [
        (SPAWNED, ["-topic", "/r1/robot_description"]),
        (SPAWNED._replace(file="r.sdf"), ["-file", "r.sdf"]),
        (SPAWNED._replace(file="r.sdf", text="<sdf/>"), ["-string", "<sdf/>"]),
    ],
)
def test_what_follows_a_spawner(it: spawn.Spawn, source: list[str]) -> None:
    """ros_gz_sim create.cpp (gflags), gazebo_ros spawn_entity.py."""
    gz = ["-name", "rover1", *source, *FLAGS, "-allow_renaming=false"]
    classic = ["-entity", "rover1", *source, *FLAGS, "-robot_namespace", "/r1"]
    made = {name: spawn.spawner(it, name == "classic") for name in ("gz", "classic")}
    assert made["gz"].words == gz and made["classic"].words == classic
    assert spawn.spawner(it._replace(namespace=""), True).words == classic[:-2]
    assert made["gz"][:2] == ("ros_gz_sim", "create")
    assert made["classic"][:2] == ("gazebo_ros", "spawn_entity.py")
