# SPDX-License-Identifier: Apache-2.0
"""The left side of a plugin's remap rule names what it named before, whatever its form.

What is expected comes from rcl's own steps (rcl remap.c, expand_topic_name.c; ``rosnames``, which is
held against rcl in tests/base/rosnames): a node in a namespace asks for a name, the first rule applies.
"""

from __future__ import annotations

import re
from itertools import product

import pytest

from multibot_rewrite import rewrite, strip
from multibot_rewrite.base.rosnames import bind, parse_remap, resolve_bound

ROBOT = '<robot name="rover"><link name="base"/><gazebo>{}</gazebo></robot>'
LEFT = (
    "cmd_vel",
    "/cmd_vel",
    "/a/cmd_vel",
    "{node}:/cmd_vel",
    "rostopic:///cmd_vel",
    "other:/cmd_vel",
)
WAYS = [*product(["postfix", "both"], ["postfix", "prefix"])]
PLUGIN = (
    '<plugin name="{node}" filename="libgazebo_ros_{library}.so"><ros>{ros}</ros>{rest}</plugin>'
)


def plugin(library: str, ros: str, rest: str = "", node: str = "drive") -> str:
    return ROBOT.format(PLUGIN.format(library=library, ros=ros, rest=rest, node=node))


def rules(*texts: str) -> str:
    return "".join(f"<remapping>{it}</remapping>" for it in texts)


def rule_texts(text: str) -> list[str]:
    return re.findall(r"<(?:remapping|argument)>([^<]*)<", text)


def name_in_graph(text: str, name: str, kind: str = "topic") -> str:
    """Return what rcl makes of a name in the code of the one plugin of a description."""
    node = re.findall(r'<plugin name="([^"]*)"', text)[0]
    namespace = (re.findall(r"<namespace>([^<]*)<", text) or ["/"])[0]
    found = [it for it in map(parse_remap, rule_texts(text)) if it is not None]
    return resolve_bound(name, kind, bind(node, namespace, found))


@pytest.mark.sample(1)
@pytest.mark.parametrize("left", LEFT)
@pytest.mark.parametrize("namespace", ["", "a", "/a"])
@pytest.mark.parametrize("right", ["go", "/go"])
def test_a_rule_matches_in_the_robots_namespace_what_it_matched_before(
    left: str, namespace: str, right: str
) -> None:
    given = f"<namespace>{namespace}</namespace>" if namespace else ""
    source = plugin("force", given + rules(f"{left.format(node='drive')}:={right}"))
    source = source.replace("cmd_vel", "gazebo_ros_force")
    before = name_in_graph(source, "gazebo_ros_force")
    made = rewrite(source, "robot1", layout="tf-per-robot")
    assert name_in_graph(made.text, "gazebo_ros_force") == f"/robot1{before}"
    assert made.not_verified == ()
    assert strip(made.text, "robot1", layout="tf-per-robot") == source.encode()


@pytest.mark.parametrize(
    ("left", "name"),
    [("/drive/out", "~/out"), ("drive/out", "~/out"), ("~/out", "~/out")],
)
@pytest.mark.parametrize(("layout", "affix"), WAYS)
def test_a_rule_below_the_nodes_name_follows_it(
    left: str, name: str, layout: str, affix: str
) -> None:
    source = plugin("ray_sensor", rules(f"{left}:=scan"))
    made = rewrite(source, "robot1", layout=layout, affix=affix)
    wanted = {
        "both": "/robot1/scan",
        "postfix": {"postfix": "/scan/robot1"}.get(affix, "/robot1/scan"),
    }
    assert name_in_graph(made.text, name) == wanted[layout]


CAMERA = "<camera_name>{}</camera_name>"


@pytest.mark.sample(1)
@pytest.mark.parametrize("stem", ["camera", "front/camera", "/camera"])
@pytest.mark.parametrize("namespace", ["", "a"])
@pytest.mark.parametrize(("layout", "affix"), WAYS)
def test_a_rule_below_the_name_of_a_camera_follows_it(
    stem: str, namespace: str, layout: str, affix: str
) -> None:
    given = f"<namespace>{namespace}</namespace>" if namespace else ""
    full = stem if stem.startswith("/") else f"/{namespace}/{stem}".replace("//", "/")
    source = plugin("camera", given + rules(f"{full}/image_raw:=image"), CAMERA.format(stem))
    made = rewrite(source, "robot1", layout=layout, affix=affix)
    assert made.not_verified == ()
    (name,) = re.findall(r"<camera_name>([^<]*)<", made.text)
    assert "robot1" in name or (layout == "both" and not stem.startswith("/"))
    image = name_in_graph(made.text, f"{name}/image_raw")
    assert image.replace("robot1", "").strip("/").endswith("image")
    assert strip(made.text, "robot1", layout=layout, affix=affix) == source.encode()


def test_what_an_image_transport_adds_moves_with_its_image() -> None:
    source = plugin("camera", rules("/camera/image_raw/compressed:=jpg"), CAMERA.format("camera"))
    made = rewrite(source, "robot1", layout="both")
    assert "<remapping>/robot1/camera/image_raw/compressed:=jpg<" in made.text


def test_a_name_that_is_absolute_in_the_code_stays_on_the_left() -> None:
    source = plugin("diff_drive", rules("/tf:=my_tf", "/clock:=time"))
    made = rewrite(source, "robot1", layout="both")
    assert rule_texts(made.text) == ["/tf:=my_tf", "/clock:=time"]


def test_a_relative_rule_for_an_absolute_name_gets_one_that_still_matches() -> None:
    """In the root namespace tf and /tf are one name; in a robot's they are two."""
    source = plugin("planar_move", rules("tf:=my_tf"))
    assert name_in_graph(source, "/tf") == "/my_tf"
    made = rewrite(source, "robot1", layout="tf-per-robot")
    assert name_in_graph(made.text, "/tf") == "/robot1/my_tf"
    assert made.not_verified == ()
    assert strip(made.text, "robot1", layout="tf-per-robot") == source.encode()


def test_a_rule_for_another_node_keeps_its_left_side() -> None:
    made = rewrite(plugin("force", rules("other:/gazebo_ros_force:=push")), "robot1", layout="both")
    assert rule_texts(made.text) == ["other:/gazebo_ros_force:=push"]


@pytest.mark.parametrize(
    ("given", "hint"),
    [
        (("/gazebo_ros_force:=push",), "write /push"),
        ((), "write the rule gazebo_ros_force:=/gazebo_ros_force"),
    ],
)
def test_a_relative_name_below_a_namespace_is_not_shared(given: list[str], hint: str) -> None:
    """It is said, and what the hint says shares it."""
    name = "push" if given else "gazebo_ros_force"
    shared = {"layout": "tf-per-robot", "shared_topics": [f"/{name}"]}
    made = rewrite(plugin("force", rules(*given)), "robot1", **shared)
    assert [(it.code, it.hint) for it in made.findings if it.code == "MB430"] == [("MB430", hint)]
    mended = rules(f"gazebo_ros_force:=/{name}")
    healthy = rewrite(plugin("force", mended), "robot1", **shared)
    assert "MB430" not in {it.code for it in healthy.findings}
    assert name_in_graph(healthy.text, "gazebo_ros_force") == f"/{name}"


def test_an_argument_that_is_a_parameter_is_no_rule() -> None:
    flags = ("--ros-args", "-p", "use_sim_time:=true", "-r", "gazebo_ros_force:=push")
    source = plugin("force", "".join(f"<argument>{it}</argument>" for it in flags))
    made = rewrite(source, "robot1", layout="postfix")
    assert rule_texts(made.text) == [*flags[:4], "gazebo_ros_force:=push/robot1"]


def test_an_argument_in_the_old_form_is_a_rule() -> None:
    """rcl arguments.c takes a:=b outside of --ros-args, and says that this form is deprecated."""
    source = plugin("force", "<argument>gazebo_ros_force:=push</argument>")
    made = rewrite(source, "robot1", layout="postfix")
    assert rule_texts(made.text) == ["gazebo_ros_force:=push/robot1"]
    assert made.not_verified == ()


@pytest.mark.parametrize(
    ("distro", "inside", "rule", "added"),
    [
        ("humble", "", "/base/cmd_vel:=/cmd_vel", ["base/cmd_vel:=cmd_vel"]),
        ("humble", "<namespace>a</namespace>", "/a/base/odom:=/a/odom", ["base/odom:=odom"]),
        ("humble", "<namespace>a</namespace>", "/a/base/odom:=/odom", []),
        ("humble", "", "/base/cmd_vel:=cmd_vel", []),
        ("humble", "", "/tf:=/base/tf", []),
        ("jazzy", "", "/base/cmd_vel:=/cmd_vel", []),
    ],
)
def test_a_rule_of_a_whole_process_is_the_same_for_all_robots(
    distro: str, inside: str, rule: str, added: list[str]
) -> None:
    """Of two robots in one Gazebo the first one's arguments are used on Humble, where rclcpp::init is
    for the context (gz_ros2_control_plugin.cpp); since Jazzy each manager has its own."""
    control = 'filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin"'
    source = ROBOT.format(f"<plugin {control}><ros>{inside}{rules(rule)}</ros></plugin>")
    for robot in ("robot1", "robot2"):
        made = rewrite(source, robot, layout="frames-per-robot", distro=distro)
        assert rule_texts(made.text)[:-1] == added
        told = {it.code for it in made.findings}
        assert ("MB426" in told) == (distro == "humble" and not added and ":=/" in rule)
        assert strip(made.text, robot, layout="frames-per-robot", distro=distro) == source.encode()
