# SPDX-License-Identifier: Apache-2.0
"""What a node set adds fits what the user's files say: commands, frames, transforms and sensors."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from paths import FIXTURES, ROOT
from plans import ends_of, own

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.robots.fitting.node_topics import CommandEnd, entry_of
from multibot_rewrite.planning.plan import read_plan

ROVER = ROOT / "examples" / "launch_tutorial" / "rover.urdf"
PLAIN, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
ROBOTS = "robots: [{name: robot1, pose: {y: 0.0}}, {name: robot2, pose: {y: 3.0}}]"


def built(folder: Path, text: str, robot: Path = ROVER) -> Path:
    """Return the folder that is built of a fleet file of these lines, without an error."""
    fleet, out = folder / "fleet.yaml", folder / "out"
    fleet.write_text(f"layout: tf-per-robot\ndescription: {robot}\n{text}\n{ROBOTS}\n")
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    return out


def rows(out: Path) -> dict[str, str]:
    """Return the type of each topic of the first robot's bridge."""
    bridge = yaml.safe_load((out / "robot1" / "bridge.yaml").read_text())
    return {it["ros_topic_name"]: it["ros_type_name"] for it in bridge}


def given(out: Path, parameter: str) -> dict[str, str]:
    """Return the value that the launch file itself gives a parameter, by the node's name."""
    found, name = {}, ""
    for line in (out / "fleet.launch.py").read_text().splitlines():
        if line.strip().startswith("name='"):
            name = line.split("'")[1]
        if f"'{parameter}': " in line:
            found[name] = line.split(f"'{parameter}': ")[1].split("}")[0].split(",")[0]
    return found


def planned(out: Path, node: str, role: str, topic: str) -> list[str]:
    """Return the types of an end in the plan."""
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    found = [it for it in ends_of(plan, node) if (it.role, it.name) == (role, topic)]
    return [type_ for it in found for type_ in (it.type, *it.also)]


@pytest.mark.parametrize(
    ("release", "type_"), [("jazzy", PLAIN), ("kilted", STAMPED), ("lyrical", STAMPED)]
)
def test_the_bridge_takes_what_nav2_sends(release: str, type_: str, tmp_path: Path) -> None:
    """nav2_util twist_publisher.hpp: stamped by default since Kilted. ros_gz_bridge mappings.py has
    both types for gz.msgs.Twist."""
    out = built(tmp_path, f"distro: {release}\nnode_sets: nav2")
    assert rows(out)["/robot1/cmd_vel"] == type_
    assert not given(out, "enable_stamped_cmd_vel")
    if type_ == STAMPED:
        assert planned(out, "/robot1/collision_monitor", "publishes", "/robot1/cmd_vel") == [type_]
    stamped = "stamped:=true" in (out / "fleet.launch.py").read_text()
    assert stamped == (type_ == STAMPED)


def test_two_node_sets_of_other_defaults_agree(tmp_path: Path) -> None:
    """Commands of Nav2 are stamped on Lyrical, those of twist_mux are not."""
    out = built(tmp_path, "distro: lyrical\nnode_sets: [nav2, teleop]")
    assert rows(out)["/robot1/cmd_vel"] == PLAIN
    assert set(given(out, "enable_stamped_cmd_vel").values()) == {"False"}


@pytest.mark.parametrize("release", ["humble", "lyrical"])
def test_a_filter_leaves_the_odometry_to_the_drive(release: str, tmp_path: Path) -> None:
    """Without a file both would send odom -> base_link (ros_filter.cpp: publish_tf)."""
    out = built(tmp_path, f"distro: {release}\nnode_sets: robot_localization")
    assert given(out, "publish_tf") == {"ekf_filter_node": "False"}


def test_odometry_without_a_topic_comes_where_it_is_read(tmp_path: Path) -> None:
    """The drive of the SDF has no <odom_topic>; Nav2 reads odom."""
    out = built(tmp_path, "distro: jazzy\nnode_sets: nav2", FIXTURES / "robots" / "rover.sdf")
    assert rows(out)["/robot1/odom"] == "nav_msgs/msg/Odometry"
    alone = built(
        tmp_path, "distro: jazzy\nnode_sets: robot_state", FIXTURES / "robots" / "rover.sdf"
    )
    assert rows(alone)["/robot1/odometry"] == "nav_msgs/msg/Odometry"


def test_cartographer_gets_its_options(tmp_path: Path) -> None:
    """node_main.cc ends without both flags."""
    (tmp_path / "carto.lua").write_text('options = {map_frame = "map"}\nreturn options\n')
    more = "simulator: none\nrelated_files: {lua: carto.lua}"
    out = built(tmp_path, f"distro: jazzy\nnode_sets: cartographer\n{more}")
    text = (out / "fleet.launch.py").read_text()
    assert "'-configuration_directory', file(" in text
    assert "'-configuration_basename', 'carto.lua'" in text
    assert (out / "robot1" / "carto.lua").is_file()


@pytest.mark.parametrize(
    ("options", "sent"),
    [
        ("", {"map": "odom"}),
        ("provide_odom_frame = false, published_frame = 'odom'", {"map": "odom"}),
        (
            "provide_odom_frame = true, published_frame = 'base_link'",
            {"map": "odom", "odom": "base_link"},
        ),
    ],
)
def test_cartographer_sends_what_its_options_say(
    options: str, sent: dict[str, str], tmp_path: Path
) -> None:
    """node.cc PublishLocalTrajectoryData. A robot without a file gets one (trajectory_options.cc: no
    option has a default) that leaves odom to the drive and reads what is there."""
    (tmp_path / "own.lua").write_text(f"options = {{{options}}}\nreturn options\n")
    given = "\nsimulator: none\nrelated_files: {lua: own.lua}" if options else ""
    out = built(tmp_path, f"distro: jazzy\nnode_sets: cartographer{given}")
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    (node,) = (it for it in own(plan, "robot1") if it.endswith("cartographer_node"))
    assert {it.parent: it.child for it in plan.edges if node in it.publishers} == sent
    if not options:
        text = (out / "robot1" / "cartographer.lua").read_text()
        assert "use_odometry = true" in text and "num_laser_scans = 1" in text
        assert 'tracking_frame = "base_link"' in text


def sent_on(out: Path, topic: str) -> list[str]:
    """Who sends on a topic as the written plan has it, by the last word of its name."""
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    sent = [it for it in plan.ends if (it.role, it.kind, it.name) == ("publishes", "topic", topic)]
    return sorted(it.node.rpartition("/")[2] for it in sent if it.node in own(plan, "robot1"))


@pytest.mark.parametrize("release", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize("is_filed", [False, True])
def test_nav2_sends_to_an_input_of_twist_mux(
    release: str, is_filed: bool, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """A drive obeys one sender: what Nav2 would send beside the mux is its first free input."""
    last = "velocity_smoother" if release == "humble" else "collision_monitor"
    text = f"distro: {release}\nsimulator: gazebo\nnode_sets: [nav2, teleop]"
    if is_filed:
        section = f"{last}: {{ros__parameters: {{cmd_vel_out_topic: cmd_vel}}}}\n"
        (tmp_path / "p.yaml").write_text(section)
        text += "\nrelated_files: {params: p.yaml}"
    out = built(tmp_path, text)
    assert "MG312" not in capfd.readouterr().err
    assert sent_on(out, "/robot1/cmd_vel") == ["twist_mux"]
    assert last in sent_on(out, "/robot1/nav_vel")


def muxed(folder: Path, *inputs: str) -> str:
    """Return the key of a fleet file for a user's twist_mux with these inputs, each ``id: topic``."""
    lines = [
        f"      {it.replace(': ', ': {topic: ')}, timeout: 0.5, priority: 1}}" for it in inputs
    ]
    head = "twist_mux:\n  ros__parameters:\n    use_stamped: false\n"
    head += "    locks: {stop: {topic: stop, timeout: 0.0, priority: 255}}\n"
    head += "    topics:\n" if inputs else ""
    (folder / "mux.yaml").write_text(head + "\n".join(lines) + "\n")
    return "simulator: gazebo\nrelated_files: {params: mux.yaml}"


def test_a_mux_without_an_input_for_a_planner_gets_the_node_sets(tmp_path: Path) -> None:
    """Nav2 and the mux are both added: beside each other the drive would obey two. twist_mux.cpp lists
    the parameters below ``topics``, whichever file or argument has them."""
    text = f"distro: jazzy\nnode_sets: [nav2, teleop]\n{muxed(tmp_path, 'joy: joy_vel')}"
    out = built(tmp_path, text)
    assert sent_on(out, "/robot1/cmd_vel") == ["twist_mux"]
    assert "collision_monitor" in sent_on(out, "/robot1/nav_vel")
    assert planned(out, "/robot1/twist_mux", "subscribes", "/robot1/nav_vel")
    launch = (out / "fleet.launch.py").read_text()
    assert "'topics.navigation.topic': 'nav_vel'" in launch.replace('"', "'")
    assert "'topics.joystick.topic'" not in launch.replace('"', "'")


@pytest.mark.parametrize("layout", ["tf-per-robot", "postfix"])
@pytest.mark.parametrize(
    ("inputs", "stick", "keys"),
    [
        (("navigation: cmd_vel", "joystick: cmd_vel_joy"), "cmd_vel_joy", "key_vel"),
        (("nav: cmd_vel_nav", "pad: joy_cmd"), "joy_cmd", "key_vel"),
        (("joystick: manual", "keyboard: typed"), "manual", "typed"),
        (("keys: a", "tracker: b"), "joy_vel", "a"),
        ((), "joy_vel", "key_vel"),
    ],
)
def test_a_joystick_sends_to_an_input_of_the_users_mux(
    inputs: tuple[str, ...], stick: str, keys: str, layout: str, tmp_path: Path
) -> None:
    """An input that is called as what the drive obeys would be heard by the mux that sends it."""
    own = f"distro: jazzy\nnode_sets: teleop\n{muxed(tmp_path, *inputs)}"
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    fleet.write_text(f"layout: {layout}\ndescription: {ROVER}\n{own}\n{ROBOTS}\n")
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    nodes = {it.name for it in plan.nodes if it.robot == "robot1"}
    ends: dict[tuple[str, str], list[str]] = {}
    for it in (one for one in plan.ends if one.node in nodes):
        key = it.node.strip("/").replace("robot1", "").strip("/_"), it.role
        ends.setdefault(key, []).append(it.name.replace("robot1", "").strip("/"))
    assert stick in ends["teleop_twist_joy_node", "publishes"]
    assert keys in ends["teleop_twist_keyboard", "publishes"]
    assert {stick, keys} <= {*ends["twist_mux", "subscribes"]}
    assert "cmd_vel" in ends["twist_mux", "publishes"]
    assert "cmd_vel" not in ends["twist_mux", "subscribes"]


@pytest.mark.parametrize("topic", ["cmd_vel", "cmd_vel_nav", "cmd_vel_smoothed"])
def test_nav2_reaches_a_mux_whose_input_is_called_as_a_topic_of_nav2(
    topic: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """The mux is to hear the last of Nav2's nodes, and not what its smoother or monitor reads."""
    inputs = f"navigation: {topic}", "joystick: cmd_vel_joy"
    out = built(tmp_path, f"distro: jazzy\nnode_sets: [nav2, teleop]\n{muxed(tmp_path, *inputs)}")
    assert not {"MG312", "MG315", "MG329"} & {*capfd.readouterr().err.split()}
    assert sent_on(out, "/robot1/cmd_vel") == ["twist_mux"]
    assert "collision_monitor" in sent_on(out, f"/robot1/{topic}_in")


def keyboard(out: Path) -> tuple[str, bool]:
    """Return the topic to which the keyboard of the first robot sends, and whether with a stamp."""
    lines = (out / "commands.md").read_text().splitlines()
    words = next(it for it in lines if "teleop_twist_keyboard" in it).split()
    (topic,) = (it.partition(":=")[2] for it in words if it.startswith("cmd_vel:="))
    return topic, "stamped:=true" in words


@pytest.mark.parametrize("release", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize(
    ("node_sets", "topic"),
    [
        ("teleop", "key_vel"),
        ("nav2, teleop", "key_vel"),
        ("nav2", "cmd_vel_nav"),
        ("navigation, teleop_twist_keyboard", "cmd_vel_nav"),
        ("teleop_direct", "cmd_vel"),
    ],
)
def test_a_keyboard_does_not_go_past_what_limits_or_chooses(
    node_sets: str, topic: str, release: str, tmp_path: Path
) -> None:
    """In all releases velocity_smoother reads cmd_vel_nav (nav2_bringup navigation_launch.py); what the
    plan has for a keyboard is what its command does."""
    out = built(tmp_path, f"distro: {release}\nsimulator: gazebo\nnode_sets: [{node_sets}]")
    found, stamped = keyboard(out)
    assert found == f"/robot1/{topic}"
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    heard = {it.type for it in plan.ends if (it.role, it.name) == ("subscribes", found)}
    assert heard <= {STAMPED if stamped else PLAIN}
    if "/robot1/teleop_twist_keyboard" in {it.name for it in plan.nodes}:
        assert planned(out, "/robot1/teleop_twist_keyboard", "publishes", found)


ROW = """\
- ros_topic_name: {}
  gz_topic_name: {}
  ros_type_name: geometry_msgs/msg/Twist
  gz_type_name: gz.msgs.Twist
  direction: ROS_TO_GZ
"""
BRIDGED = "distro: jazzy\nsimulator: gazebo\nrelated_files: {bridge: bridge.yaml}\nnode_sets: "


@pytest.mark.parametrize(
    ("node_sets", "rows_", "below", "sender", "topic", "keys"),
    [
        ("teleop", ("cmd_vel",), "sensors", "twist_mux", "sensors/cmd_vel", "key_vel"),
        ("teleop", ("drive/cmd",), "", "twist_mux", "drive/cmd", "key_vel"),
        ("teleop", ("/drive/cmd",), "sensors", "twist_mux", "drive/cmd", "key_vel"),
        ("teleop", ('"<namespace>/cmd"',), "sensors", "twist_mux", "cmd", "key_vel"),
        ("teleop", (), "sensors", "twist_mux", "cmd_vel", "key_vel"),
        ("nav2", ("cmd_vel",), "sensors", "collision_monitor", "sensors/cmd_vel", "cmd_vel_nav"),
        ("teleop_direct", ("cmd_vel",), "s", "teleop_twist_joy_node", "s/cmd_vel", "s/cmd_vel"),
    ],
)
def test_what_is_added_sends_where_the_robots_own_bridge_takes_commands(
    node_sets: str, rows_: tuple[str, ...], below: str, sender: str, topic: str, keys: str,
    tmp_path: Path,
) -> None:  # fmt: skip
    """ros_gz_bridge expands relative names in its own namespace. A row for something else (``pan``)
    does not lead the drive away; the other robot, without the key, has its bridge as it is."""
    every = [*((it, "cmd_vel") for it in rows_), ("pan", "pan")]
    (tmp_path / "bridge.yaml").write_text("".join(ROW.format(*it) for it in every))
    key = f", bridge_namespace: {below}" if below else ""
    robots = f"[{{name: robot1{key}}}, {{name: robot2}}]"
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    fleet.write_text(
        f"layout: both\ndescription: {ROVER}\n{BRIDGED}{node_sets}\nrobots: {robots}\n"
    )
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    assert planned(out, f"/robot1/{sender}", "publishes", f"/robot1/{topic}")
    assert rows(out)[f"/robot1/{topic}"] == PLAIN
    assert keyboard(out)[0] == f"/robot1/{keys}"
    other = rows_[0].strip('/"').replace("<namespace>/", "") if rows_ else "cmd_vel"
    assert planned(out, f"/robot2/{sender}", "publishes", f"/robot2/{other}")


@pytest.mark.parametrize(
    ("rows_", "topic", "direction"),
    [
        # The rows are of a thruster, of another robot, and of this one.
        ((("pan", "pan"),), "cmd_vel", "ROS_TO_GZ"),
        ((("drive", "/model/rover/cmd_vel"), ("o", "/model/o/cmd_vel")), "drive", "ROS_TO_GZ"),
        ((("up", "/model/rover/x"), ("o", "/model/o/cmd_vel")), "cmd_vel", "ROS_TO_GZ"),
        ((("pan", "pan"), ("drive", "/model/rover/cmd_vel")), "drive", "BIDIRECTIONAL"),
    ],
)
def test_a_row_takes_the_commands_if_it_is_of_the_drive(
    rows_: tuple[tuple[str, str], ...], topic: str, direction: str, tmp_path: Path
) -> None:
    """The drive has no topic: gz-sim calls it /model/NAME/cmd_vel (DiffDrive.cc)."""
    text = "".join(ROW.format(*it) for it in rows_).replace("ROS_TO_GZ", direction)
    (tmp_path / "bridge.yaml").write_text(text)
    rover = ROVER.read_text().replace("<topic>cmd_vel</topic>", "")
    (tmp_path / "rover.urdf").write_text(rover)
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    robots = "robots: [{name: robot1}, {name: robot2}]\n"
    fleet.write_text(f"layout: both\ndescription: rover.urdf\n{BRIDGED}teleop\n{robots}")
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    assert planned(out, "/robot1/twist_mux", "publishes", f"/robot1/{topic}")
    assert rows(out)[f"/robot1/{topic}"] == PLAIN


@pytest.mark.parametrize(
    ("inputs", "topic"),
    [
        ({"stick": "joy", "other": "keys"}, "other"),
        ({"nav": "a", "joy_vel": "b"}, "joy_vel"),
        ({"plans": "a", "free": "b"}, "free"),
        ({"smoothed": "a"}, "raw"),
    ],
)
def test_the_input_for_a_person(inputs: dict[str, str], topic: str) -> None:
    """By its topic or id, else the one to which nobody sends, else the way of who does."""
    sent = [
        CommandEnd("planner", "publishes", "plans", PLAIN),
        CommandEnd("nav", "publishes", "nav", PLAIN),
    ]
    smoother = [
        CommandEnd("smoother", "publishes", "smoothed", PLAIN),
        CommandEnd("smoother", "subscribes", "raw", PLAIN),
    ]
    obeyed = [
        CommandEnd("choice", "subscribes", it, PLAIN, f"topics.{id_}.topic")
        for it, id_ in inputs.items()
    ]
    mux = [CommandEnd("choice", "publishes", "cmd_vel", PLAIN), *obeyed]
    assert entry_of("cmd_vel", [*sent, *smoother, *mux]) == topic


def test_what_behaviors_pass_on_when_asked_is_no_way_to_the_drive() -> None:
    """nav2_behaviors assisted_teleop.cpp obeys cmd_vel_teleop while its action runs."""
    ends = [
        CommandEnd("drive", "subscribes", "cmd_vel", PLAIN),
        CommandEnd("behavior_server", "publishes", "cmd_vel", PLAIN),
        CommandEnd("behavior_server", "subscribes", "x", PLAIN, "cmd_vel_teleop"),
    ]
    assert entry_of("cmd_vel", ends) == "cmd_vel"
    ring = [CommandEnd("a", role, it, PLAIN) for role in ("publishes", "subscribes") for it in "xy"]
    assert entry_of("x", ring) in "xy"


TRANSFORMS = (
    "- {{ros_topic_name: {}, gz_topic_name: {}, direction: {},\n"
    "   ros_type_name: tf2_msgs/msg/TFMessage, gz_type_name: gz.msgs.Pose_V}}\n"
)


@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot", "postfix"])
@pytest.mark.parametrize(
    ("rows_", "places"),
    [
        ([("odom_tf", "tf", "GZ_TO_ROS")], True),
        ([("/truth", "/tf", "GZ_TO_ROS")], True),
        ([("tf", "tf", "GZ_TO_ROS")], False),
        ([("odom_tf", "tf", "GZ_TO_ROS"), ("tf", "tf", "GZ_TO_ROS")], False),
        # The transform of the drive has a row that the build adds.
        ([("truth", "/world/w/pose", "GZ_TO_ROS")], False),
    ],
)
def test_a_filter_places_the_robot_where_the_bridge_has_no_tf(
    rows_: list[tuple[str, str, str]],
    places: bool,
    layout: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """One of the two sends odom to base_link on tf: never both, never none."""
    (tmp_path / "bridge.yaml").write_text("".join(TRANSFORMS.format(*it) for it in rows_))
    text = "distro: jazzy\nsimulator: gazebo\nnode_sets: robot_localization\n"
    text += "related_files: {bridge: bridge.yaml}"
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    fleet.write_text(f"layout: {layout}\ndescription: {ROVER}\n{text}\n{ROBOTS}\n")
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    told = capsys.readouterr().err
    assert "MG408" not in told
    assert "MG406" not in told
    assert [*given(out, "publish_tf").values()] == ([] if places else ["False"])
