# SPDX-License-Identifier: Apache-2.0
"""Every key of a file of nodes leads to its field of the record, and what is wrong is refused."""

from __future__ import annotations

import re

import pytest
from paths import fixture_text

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.knowledge import declared
from multibot_rewrite.knowledge.declared import (
    Base,
    Declared,
    _base_of,
    canonical,
)
from multibot_rewrite.knowledge.node_library import (
    NodeLibrary,
    extend,
)
from multibot_rewrite.knowledge.node_sets import in_release
from multibot_rewrite.knowledge.parameters import (
    _anywhere,
    _node_in_release,
    guess,
    load_known_nodes,
)
from multibot_rewrite.knowledge.programs import (
    NAV2,
    Program,
    container_of,
    known_program,
    program_of,
)
from multibot_rewrite.knowledge.records import (
    Claim,
    Endpoint,
    FrameParameter,
    NodeFacts,
    NodeParameters,
    Param,
    SentTransform,
)
from multibot_rewrite.knowledge.worlds import DEFAULTS, SENT_BY, SENT_BY_ANY, SYSTEMS

EMPTY = NodeLibrary({}, {}, {})
FILE = fixture_text("entries_file.yaml")
PLAIN = "  plain: {publishes: {out: a/msg/B}}\n  box: {package: rclcpp_components}\n"
LIBRARY = extend(EMPTY, FILE.replace("node_sets:\n", f"{PLAIN}node_sets:\n"), "f.yaml")
TF = Endpoint("topic", "subscribes", "/tf", "tf2_msgs/msg/TFMessage")


def test_the_whole_record_of_a_node() -> None:
    assert LIBRARY.nodes["costmap/driver"] == NodeFacts(
        "costmap/driver",
        "acme",
        (
            Endpoint("topic", "publishes", "scan", "sensor_msgs/msg/LaserScan"),
            Endpoint(
                "topic",
                "publishes",
                "<name>/out",
                "a/msg/B",
                transport=True,
                parameter="topic",
                fixed="the name is made at run time from parameter topic",
                note="said",
                also=("a/msg/C",),
                when="unsent: x",
                helper=True,
                remapped="out",
                condition="publish",
                above="humble",
                releases="jazzy",
                source=("acme/driver@1.0 a.cpp", "acme/driver@main b.cpp"),
                types=(("stamped = true", "a/msg/C"),),
            ),
            Endpoint(
                "topic",
                "subscribes",
                "map",
                "nav_msgs/msg/OccupancyGrid",
                helper=True,
                by="_private_*",
            ),
            Endpoint("service", "serves", "reset", "std_srvs/srv/Empty"),
            Endpoint("action", "serves", "go", "acme_msgs/action/Go"),
            Endpoint("action", "calls", "go", "a/action/Old", releases="<=humble"),
            Endpoint("action", "calls", "go", "a/action/New", releases="jazzy+"),
            TF,
        ),
        shared=True,
        note="a note",
        host="server",
        when="simulated",
        frames=(
            FrameParameter("map_frame", "map", "jazzy", ("acme/driver@1.0 d.cpp",)),
            FrameParameter("odom", "odom"),
            FrameParameter("base", "base_link", "jazzy", ("acme/driver@1.0 c.cpp",)),
        ),
        fixed=("/x",),
        sends=(
            SentTransform("odom", "base"),
            SentTransform("map_frame", "odom", "publish_tf"),
        ),
        ids=(("sensor", "sensors"),),
        claims=(
            Claim("command", "<joints>/velocity", "open_loop", "jazzy+"),
            Claim("state", "<joints>/position"),
            Claim("state", "imu/x"),
        ),
        releases="jazzy+",
        source=("acme/driver@1.0 src/driver.cpp:7",),
        programs=("drive", "other/run"),
        plugin="gz",
        apart=True,
        component="acme::Driver",
        prefix_switch="prefixed",
        unmanaged="<=humble",
    )


def test_the_whole_record_of_its_parameters() -> None:
    assert LIBRARY.parameters == {
        "driver": NodeParameters(
            "driver",
            "acme",
            (
                Param(
                    "map_frame",
                    "frame",
                    "map",
                    releases="jazzy",
                    source=("acme/driver@1.0 d.cpp",),
                ),
                Param("topic", "topic", absolute="<=jazzy"),
                Param("other", "topic", absolute="rolling"),
                Param("third", "topic", absolute="<=jazzy"),
                Param(
                    "names",
                    "joint",
                    note="n",
                    deprecated="kilted+",
                    own=True,
                    instead=("x",),
                ),
            ),
            ("rover",),
            ("acme/Driver",),
            ("wheels",),
            "jazzy+",
            ("acme/driver@1.0 src/driver.cpp:7",),
            "humble",
            {"acme/Old": "jazzy+"},
            ("acme_lib",),
        )
    }
    assert LIBRARY.guesses == {"frame": ("frame_id",), "link": ("*_link",)}
    assert LIBRARY.sent == {"earth"}
    assert LIBRARY.parts == {"listener": (TF,)}


def test_a_library_of_a_release_has_what_that_release_has() -> None:
    node = in_release(LIBRARY, "humble").nodes.get("costmap/driver")
    assert node is None
    jazzy = in_release(LIBRARY, "jazzy").nodes["costmap/driver"]
    assert [it.kind for it in jazzy.claims] == ["command", "state", "state"]
    anywhere = extend(
        EMPTY, "nodes: {a: {claims: [{command: x, releases: jazzy+}, {state: y}]}}", "f"
    )
    assert [it.kind for it in in_release(anywhere, "humble").nodes["a"].claims] == ["state"]


def test_a_second_file_changes_a_node_and_adds_to_its_parameters() -> None:
    more = """\
nodes:
  costmap/driver:
    package: acme
    publishes: {new: a/msg/B}
    params: {topic: service, extra: link}
  driver: {aliases: [second]}
"""
    found = extend(LIBRARY, more, "m.yaml")
    node, own = found.nodes["costmap/driver"], found.parameters["driver"]
    assert [it.name for it in node.endpoints] == ["new"]
    # It is started as before.
    assert (node.programs, node.component) == (("drive", "other/run"), "acme::Driver")
    assert [(it.path, it.kind) for it in own.forms] == [
        ("map_frame", "frame"),
        ("other", "topic"),
        ("third", "topic"),
        ("names", "joint"),
        ("topic", "service"),
        ("extra", "link"),
    ]
    assert own.aliases == ("rover", "second")
    assert (own.types, own.known_by, own.strips) == (("acme/Driver",), ("wheels",), "humble")
    # Known by its parameters alone.
    assert "driver" not in found.nodes
    other = extend(LIBRARY, "nodes: {costmap/driver: {package: b}}", "m").nodes["costmap/driver"]
    assert (other.programs, other.component) == ((), "")
    said = more.replace("package: acme\n", "package: acme\n    programs: [own]\n", 1)
    assert extend(LIBRARY, said, "m.yaml").nodes["costmap/driver"].programs == ("own",)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("nodes: {a: {releases: jazy}}", "release 'jazy' is not known; did you mean 'jazzy'"),
        ("nodes: {a: {releases: jazzy jazzy}}", "'jazzy jazzy' names no releases; write jazzy,"),
        ("nodes: {a: {releases: <=jazzy+}}", "releases '<=jazzy+' names no releases; write jazzy,"),
        ("nodes: {a: {releases: jazzy 1.3}}", "releases 'jazzy 1.3' names no releases"),
        ("nodes: {a: {source: here}}", "source 'here' names no place; write OWNER/NAME@TAG PATH"),
        ("nodes: {a: {source: a/b@c}}", "source 'a/b@c' names no place"),
        ("nodes: {a: {source: 'a/b@c d:x'}}", "source 'a/b@c d:x' names no place"),
        ("nodes: {a: {when: 'a b'}}", "'a b' is no condition; write PARAMETER = VALUE"),
        ("nodes: {a: {frames: {f: []}}}", "frame f is an empty list; write what it is"),
        ("nodes: {a: {frames: {f: [x, y]}}}", "frame f is there twice in "),
        ("nodes: {a: {frames: {f: {releases: jazzy}}}}", "frame f has no default; add default:"),
        ("nodes: {a: {frames: {f: {x: 1}}}}", "key 'x' is not known"),
        ("nodes: {a: {sends: {f: g}}}", "frame 'f' is not known"),
        ("nodes: {a: {frames: {f: x}, sends: {f: g}}}", "frame 'g' is not known"),
        ("nodes: {a: {frames: {f: x}, sends: {f: {if: x}}}}", "sends f has no child; write {ch"),
        ("nodes: {a: {frames: {f: x}, sends: {f: {child: g}}}}", "frame 'g' is not known"),
        ("nodes: {a: {claims: [{}]}}", "a claim is of one kind; write {command: ...} or {state"),
        ("nodes: {a: {claims: [{command: a, state: b}]}}", "a claim is of one kind"),
        ("nodes: {a: {claims: [{commands: a}]}}", "key 'commands' is not known"),
        ("nodes: {a/b c: {}}", "node name 'a/b c': "),
        ("nodes: {a: {calls: {b: [{type: x/srv/B}, {type: x/srv/C}]}}}", "calls 'b' is there twi"),
        ("nodes: {a: {publishes: {b: {type: x/msg/B, also: [B]}}}}", "'B' is not a ROS type"),
        (
            "nodes: {a: {publishes: {b: {type: x/msg/B, types: {c: x/msg/D}}}}}",
            "'x/msg/D' is neither the type nor in also (x/msg/B)",
        ),
        ("nodes: {a: {serves: {b: {remapped: c d}}}}", "name 'c d': "),
        ("nodes: {a: {publishes: {b: x/action/Go}}}", "x/action/Go is the type of an action"),
        ("nodes: {a: {params: {x: fame}}}", "kind 'fame' is not known; did you mean 'frame'"),
        ("nodes: {a: {params: {x: {}}}}", "parameter 'x' has no kind; add kind: with one of fra"),
        ("nodes: {a: {params: {x: {kind: fame}}}}", "kind 'fame' is not known"),
        ("nodes: {a: {params: {x..y: frame}}}", "parameter 'x..y' has an empty segment"),
        ("nodes: {a: {params: {<jont>.y: frame}}}", "segment 'jont' is not known"),
        ("nodes: {a: {params: {x: [frame, link]}}}", "parameter 'x' is there twice in"),
        ("guesses: {fame: [x]}", "kind 'fame' is not known"),
        ("node_sets: {a: {node: [x]}}", "key 'node' is not known"),
        ("parts: {a: {publish: {}}}", "key 'publish' is not known"),
        (
            "nodes: {b: {}}\nnode_sets: {a: {nodes: [{node: b, parameters: {x: []}}]}}",
            "x is no word",
        ),
    ],
)
def test_what_is_wrong_in_an_entry(text: str, message: str) -> None:
    with pytest.raises(UsageError) as raised:
        extend(EMPTY, text, "f.yaml")
    assert str(raised.value).startswith("f.yaml:")
    assert message in str(raised.value)


def test_parameters_of_nodes_by_name_type_and_path(tmp_path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(
        "nodes:\n  acme_x:\n    aliases: [acme_y]\n    types: [acme/X]\n    releases: jazzy+\n"
        "    params:\n      map.frame_id: {kind: frame, default: map}\n      odom<index>: topic\n"
        "      <joint>.p: interface\n      old: [{kind: frame, default: a, releases: <=humble},"
        " {kind: frame, default: b, releases: jazzy+}]\n"
    )
    known = load_known_nodes(str(file), "jazzy")
    node = known.nodes[known.names["acme_y"]]
    assert (node.name, known.names["acme_x"], known.types["acme/X"]) == ("acme_x",) * 3
    tree = node.tree
    assert [it.path for it in tree.exact["map"].exact["frame_id"].params] == ["map.frame_id"]
    assert [it.path for it in tree.numbered["odom"].params] == ["odom<index>"]
    assert [it.path for it in tree.wild["joint"].exact["p"].params] == ["<joint>.p"]
    assert [(it.path, it.default) for it in node.defaults] == [
        ("map.frame_id", "map"),
        ("old", "b"),
    ]
    # What the release lacks is what it was in another.
    humble = load_known_nodes(str(file), "humble").nodes["acme_x"]
    assert humble.params["old"].default == "a"
    assert humble.defaults == ()
    assert guess(known, "any.thing.frame_id") == "frame"
    assert guess(known, "any.frame_id.thing") == ""


def test_programs_of_nodes() -> None:
    """nav2_bringup launch files; rclcpp_components of lyrical has one executable with flags."""
    assert container_of("jazzy") == Program("rclcpp_components", "component_container_isolated")
    assert container_of("lyrical") == Program(
        "rclcpp_components",
        "component_container",
        "",
        ("--isolated", "--executor-type", "single-threaded"),
    )
    box = NodeFacts("nav2_container", "rclcpp_components", (), known="component_container")
    assert program_of(box, "jazzy") == container_of("jazzy")
    node = NodeFacts("driver", "acme", (), programs=("drive", "run"), component="acme::D")
    assert program_of(node, "jazzy") == Program("acme", "drive", "acme::D")
    assert program_of(NodeFacts("driver", "acme", ()), "jazzy") == Program("acme", "driver")
    assert program_of(NodeFacts("driver", "", ()), "jazzy") is None
    assert program_of(NodeFacts("Component", "acme", ()), "jazzy") is None
    assert known_program("amcl", "jazzy").executable == "amcl"
    started = (
        "map_server amcl controller_server smoother_server planner_server route_server"
        " behavior_server bt_navigator waypoint_follower velocity_smoother collision_monitor"
        " docking_server following_server costmap_filter_info_server map_saver slam_toolbox"
    )
    # The manager last, so that what it manages is there.
    assert (*started.split(), "lifecycle_manager") == NAV2


def test_a_world_needs_a_system_for_each_sensor() -> None:
    """gz-sim8 src/systems."""
    drawn = (
        "camera depth_camera depth rgbd_camera rgbd gpu_lidar gpu_ray lidar ray thermal_camera thermal"
        " wide_angle_camera segmentation_camera segmentation boundingbox_camera boundingbox"
    )
    assert dict(SYSTEMS) == {
        **dict.fromkeys(drawn.split(), ("sensors", "Sensors")),
        "imu": ("imu", "Imu"),
        "magnetometer": ("magnetometer", "Magnetometer"),
        "altimeter": ("altimeter", "Altimeter"),
        "air_pressure": ("air-pressure", "AirPressure"),
        "air_speed": ("air-speed", "AirSpeed"),
        "force_torque": ("forcetorque", "ForceTorque"),
        "logical_camera": ("logical-camera", "LogicalCamera"),
        **dict.fromkeys(("navsat", "gps"), ("navsat", "NavSat")),
    }
    assert DEFAULTS == ("physics", "user-commands", "scene-broadcaster")
    assert dict(SENT_BY_ANY) == {"clock": "Clock", "stats": "WorldStatistics"}
    poses, scene = ("pose/info", "dynamic_pose/info"), {"scene/info": "Scene"}
    sent = {**dict.fromkeys(poses, "Pose_V"), **scene, "scene/deletion": "UInt32_V"}
    assert dict(SENT_BY) == {"scene-broadcaster": {**sent, "state": "SerializedStepMap"}}


def test_a_row_of_what_a_package_declares() -> None:
    """Package, repository, tag and folder; path, type and place; how and since when, and its checks."""
    section = "\n".join((
        "nav2_x] ros/nav2 1.0 nav2_x src", "rate double a.cpp:3", "",
        "<id>.on any b.cpp:4 releases=jazzy,kilted yaml 1.1 ! bounds([0, 1]) gt([0])",
        "low int c.cpp:5 read",
    ))  # fmt: skip
    assert [*declared._parameters_of("")] == []
    first, second, third = declared._parameters_of(section)
    assert first == Declared(
        "rate", "double", "", "", "declared", "ros/nav2@1.0 nav2_x/src/a.cpp:3"
    )
    assert second == Declared(
        "<id>.on",
        "",
        "bounds([0, 1]) gt([0])",
        "jazzy,kilted",
        "yaml",
        "ros/nav2@1.1 nav2_x/src/b.cpp:4",
    )
    assert third == Declared("low", "int", "", "", "read", "ros/nav2@1.0 nav2_x/src/c.cpp:5")


@pytest.mark.parametrize(
    ("path", "name", "words"),
    [
        ("rate", "rate", {}), ("rate", "rates", None), ("<a>.x", "b.x", {"<a>": "b"}),
        ("<a>.x", ".x", None), ("<a>.x", "b.y", None), ("a.<b>", "a.c.d", {"<b>": "c.d"}),
        ("a.<b>.c", "a.c", None), ("<a>.x.<b>", "c.x.d", {"<a>": "c", "<b>": "d"}),
        ("<a>.x.<b>", "c.y.d", None), ("<id>_config", "odom0_config", {"<id>": "odom0"}),
        ("<id>_config", "odom0", None),
    ],
)  # fmt: skip
def test_a_path_stands_for_names(path: str, name: str, words: dict[str, str] | None) -> None:
    has = Declared(path, "", "", "", "", "").has_name(name)
    assert has is (words is not None)
    assert declared.stands_for(path, name) == (words or {})


def test_the_classes_of_a_base_with_their_releases_and_older_names() -> None:
    """A name that a migration guide of Nav2 has is of an older release of ROS 2."""
    section = "\n".join((
        "nav2_core::A]", "a::B ros/a x.xml", "a::C releases=jazzy,kilted ros/a x.xml", "",
        "a/D -> a::B docs.nav2.org migration/Humble.html", "A -> a::B ros/a x.xml",
    ))  # fmt: skip
    assert _base_of(section) == Base(
        {"a::B": "", "a::C": "jazzy,kilted"}, {"a/D": "a::B", "A": "a::B"}, frozenset({"a/D"})
    )
    assert canonical(" a/b::C\n") == "a::b::C"


def test_a_node_that_activates_itself_has_its_life_cycle_in_those_releases() -> None:
    text = "parts: {lifecycle: {serves: {~/change_state: lifecycle_msgs/srv/ChangeState}}}\n"
    text += "nodes: {a: {package: p, unmanaged: <=humble}, b: {package: p}}\n"
    nodes = extend(EMPTY, text, "f.yaml").nodes
    change = Endpoint("service", "serves", "~/change_state", "lifecycle_msgs/srv/ChangeState")
    assert nodes["a"].endpoints == (change._replace(releases="<=humble"),)
    assert nodes["b"].endpoints == ()


@pytest.mark.parametrize(
    ("params", "taken"),
    [
        # The name says it, or several nodes mean the same by it.
        (("a.tool_frame: frame",), ["a.tool_frame"]),
        (("a.tool: frame",), []),
        (("a.tool: frame", "a.tool: frame"), ["a.tool"]),
        (("a.tool: frame", "a.tool: joint"), []),
        (("tool_frame: topic",), []),
        # A joint or a link is one wherever a parameter is called so.
        (("elbow: joint",), ["elbow"]),
        (("hand: link",), ["hand"]),
        # What is [position] in one controller may be [elbow/position] in another.
        (("state_interfaces: keep", "state_interfaces: keep"), []),
        (("rates: keep", "rates: keep"), ["rates"]),
        # What each node has for itself, and words in brackets.
        (("port: port", "port: port"), []),
        (("<x>.tool_frame: frame",), []),
        (("*.tool_frame: frame",), []),
    ],
)
def test_what_parameters_of_known_nodes_say_of_others(
    params: tuple[str, ...], taken: list[str]
) -> None:
    pairs = (it.split(": ") for it in params)
    nodes = [_node_in_release(NodeParameters("a", "p", (Param(*it),)), "jazzy") for it in pairs]
    guessing = re.compile(r"(?P<interface>\w*interfaces)|(?P<frame>\w*frame)")
    assert [it.path for it in _anywhere(nodes, guessing)] == taken


# What starts a node: the executables are those of each package's CMakeLists.txt or setup.py.


@pytest.mark.parametrize(
    ("node", "package", "executable"),
    [
        ("ukf_filter_node", "robot_localization", "ukf_node"),
        ("urg_node", "urg_node", "urg_node_driver"),
        ("joy_linux", "joy_linux", "joy_linux_node"),
        ("turtlebot3_node", "turtlebot3_node", "turtlebot3_ros"),
        ("docking_server", "opennav_docking", "opennav_docking"),
        ("robot_state_publisher", "robot_state_publisher", "robot_state_publisher"),
    ],
)
def test_a_node_is_started_by_the_executable_of_its_package(
    node: str, package: str, executable: str
) -> None:
    assert known_program(node, "jazzy")[:2] == (package, executable)
