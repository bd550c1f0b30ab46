# SPDX-License-Identifier: Apache-2.0
"""What nodes of own packages do, by their source. The referee of Python is rclpy: the same programs are
started, and their graph is asked. C++ has expectations by hand, from rclcpp and tf2_ros."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from paths import FIXTURES, fixture_text

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.of_runs import ends_of, with_names
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.producers.evidence.filling import filled
from multibot_rewrite.producers.sources import expressions, programs
from multibot_rewrite.producers.sources.facts import NodeSource, node_of_program
from multibot_rewrite.producers.sources.records import parameter_in
from multibot_rewrite.system.records import NOWHERE, RUNS, End

OWN = FIXTURES / "own_nodes"
STARTED = Path(__file__).parents[1] / "support" / "started_node.py"
# Program: its file and function, and whether all that it opens is known.
PROGRAMS = {
    "plain": ("plain", "main", True),
    "by_parameters": ("by_parameters", "main", False),
    "own_nodes_parts": ("parts", "main", False),
    "inherited": ("inherited", "main", True),
    "decided": ("decided", "main", False),
    "functions": ("functions", "main", True),
    "loops": ("loops", "run", False),
    "several": ("several", "main", False),
    "traps": ("traps", "main", False),
}
SET = {
    "by_parameters": {"side": "rear", "scan_topic": "/lidar", "image": "raw"},
    "decided": {"debug": True, "status": False},
}
OF_ROS = ("/rosout", "/parameter_events", "parameter", "/get_type_description")
Opened = set[tuple[str, str, str]]


def read(program: str, folder: Path = OWN, release: str = "jazzy") -> NodeSource:
    found = node_of_program(str(folder), folder.name, program, {folder.name: str(folder)}, release)
    assert found is not None
    return found


def run_of(facts: NodeFacts, name: str, space: str, values: Mapping[str, object]) -> Run:
    given = {key: Given(it, NOWHERE) for key, it in values.items()}  # type: ignore[arg-type]
    run = Run("", name, space, name, (), facts, values=given)
    return with_names(run._replace(fact=filled(facts, run)))


def started(program: str, space: str, values: Mapping[str, object]) -> Opened:
    """Return what rclpy says that the program has opened, but for what every node has."""
    file, function, _ = PROGRAMS[program]
    words = [
        f"__ns:={space}",
        *(
            f"{key}:={str(it).lower() if isinstance(it, bool) else it}"
            for key, it in values.items()
        ),
    ]
    options = [
        word
        for key, it in zip(["-r", *["-p"] * len(values)], words, strict=True)
        for word in (key, it)
    ]
    made = subprocess.run(
        [
            sys.executable,
            STARTED,
            OWN / "own_nodes" / f"{file}.py",
            function,
            "--ros-args",
            *options,
        ],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"},
        timeout=120,
    )
    ends = json.loads(made.stdout)
    plain = (it for it in ends if not any(word in it[2] for word in OF_ROS))
    return {(role, name, type_) for _, role, name, type_ in plain}


def opened(ends: list[End], sure: bool) -> Opened:
    return {(it.role, it.name, it.type) for it in ends if (it.sure == RUNS) or not sure}


@pytest.mark.live
@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("told", [False, True])
def test_what_rclpy_opens(program: str, told: bool) -> None:
    pytest.importorskip("rclpy")
    if told and program not in SET:
        pytest.skip("nothing to set")
    space, values = ("/robot1", SET[program]) if told else ("/", {})
    facts = read(program).facts
    run = run_of(facts, facts.name, space, values)
    ends = list(ends_of(run))
    real = started(program, space, values)
    # No wrong claim, whatever is known.
    assert opened(ends, sure=True) <= real
    if PROGRAMS[program][2]:
        assert not facts.untold
        assert real <= opened(ends, sure=True)
    else:
        assert facts.untold or run.fact.endpoints


@pytest.mark.parametrize(("program", "told"), [("several", 1), ("plain", 0), ("decided", 0)])
def test_a_name_is_for_all_nodes_of_the_process(
    program: str, told: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    launch = tmp_path / "one.launch.xml"
    launch.write_text(f'<launch><node pkg="own_nodes" exec="{program}" name="x"/></launch>')
    main(["check-launch", str(launch), "--roots", str(OWN.parent)])
    assert capsys.readouterr().out.count("MG730 name= renames every node") == told


EXPECTED: dict[str, set[str]] = {
    "by_parameters": {
        *("/scan", "/front/image_raw", "/wheels/front/speed", "/wheels/front/torque"),
        *("/wheels/front/power", "/loud"),
    },
    "decided": {"/release", "/status"},
    "own_nodes_parts": {
        *("/wheel/left/speed", "/wheel/left/target", "/wheels/right/speed"),
        *("/wheels/right/target", "/battery", "/battery_2"),
    },
    "loops": {"/a", "/b", "/wheel_1", "/wheel_2", "/left/speed", "/right/speed"},
    "several": {"/one_out"},
    "traps": set(),
}


@pytest.mark.parametrize("program", EXPECTED)
def test_what_is_known_surely(program: str) -> None:
    facts = read(program).facts
    ends = ends_of(run_of(facts, facts.name, "/", {}))
    sure = {it.name for it in ends if it.sure == RUNS}
    assert sure - {"/one/own"} == EXPECTED[program]
    assert facts.untold


def test_a_node_is_named_by_its_code_and_has_its_place() -> None:
    facts = read("inherited").facts
    assert facts.name == "derived"
    first = next(it for it in facts.endpoints if it.name == "first")
    assert first.source == (f"{OWN / 'own_nodes' / 'inherited.py'}:20",)


HEADER = fixture_text("nodes_by_source_header.txt")
UNIT = fixture_text("nodes_by_source_unit.txt")
MAIN = """
#include "acme/driver.hpp"
int main(int argc, char ** argv) {
  rclcpp::init(argc, argv);
  auto node = std::make_shared<acme::Driver>(rclcpp::NodeOptions());
  rclcpp::spin(node);
}
"""
CMAKE = """
project(acme)
set(UNITS src/main.cpp)
add_library(driver SHARED src/driver.cpp)
add_executable(driver_node ${UNITS})
rclcpp_components_register_node(driver PLUGIN "acme::Driver" EXECUTABLE driver_alone)
install(PROGRAMS scripts/tool.py DESTINATION lib/${PROJECT_NAME} RENAME tool)
"""
STRING, TF = "std_msgs/msg/String", "tf2_msgs/msg/TFMessage"


@pytest.fixture
def acme(tmp_path: Path) -> Path:
    folder = tmp_path / "acme"
    for name, text in {
        "package.xml": "<package><name>acme</name></package>",
        "CMakeLists.txt": CMAKE,
        "include/acme/driver.hpp": HEADER,
        "src/driver.cpp": UNIT,
        "src/main.cpp": MAIN,
        "scripts/tool.py": "import rclpy\nrclpy.create_node('tool').create_client(1, 'x')\n",
    }.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


@pytest.mark.parametrize("program", ["driver_node", "driver_alone", "acme::Driver"])
def test_a_node_in_cpp(acme: Path, program: str) -> None:
    found = read(program, acme)
    facts = found.facts
    sure = {
        (it.role, it.name, it.type) for it in facts.endpoints if not it.when and "<" not in it.name
    }
    assert facts.name == "driver"
    assert sure == {
        ("publishes", "~/state", STRING),
        ("publishes", "scan", "sensor_msgs/msg/LaserScan"),
        ("subscribes", "wheels/left", "std_msgs/msg/Float64"),
        ("subscribes", "wheels/right", "std_msgs/msg/Float64"),
        ("publishes", "/battery", "sensor_msgs/msg/BatteryState"),
        ("serves", "~/reset", "std_srvs/srv/Trigger"),
        ("serves", "dock", "acme_msgs/action/Dock"),
        ("subscribes", "camera/image", "sensor_msgs/msg/Image"),
        ("subscribes", "/tf", TF),
        ("subscribes", "/tf_static", TF),
        ("publishes", "/tf", TF),
    }
    only = {it.name: it.when for it in facts.endpoints if it.when}
    assert only == {
        "debug": "debug = true",
        "lidar": "open: source",
        "lambda": "open: source",
        "built": "open: source",
        "behind": "open: source",
        "late": "open: source",
    }
    by_name = {it.name: it for it in facts.endpoints}
    assert by_name["scan"].parameter == "scan_topic"
    assert by_name["dock"].kind == "action"
    assert {it.name for it in facts.endpoints if it.helper} == {"/tf", "/tf_static"}
    assert {it.parameter: it.default for it in facts.frames} == {
        "frame_id": "laser",
        "'odom'": "odom",
    }
    assert [tuple(it[:2]) for it in facts.sends] == [("'odom'", "frame_id")]
    assert ("looked up", "map") in [it[:2] for it in found.frames]
    assert len([it for it in facts.untold if "made at run time" in it.text]) == 2


DELETED = """
class Part {
public:
  explicit Part(rclcpp::Node * node) { node->create_publisher<std_msgs::msg::String>("part", 1); }
};
struct Closer { void operator()(Part * part) const; };
class Own : public rclcpp::Node {
public:
  Own() : Node("own"), part_(this, Closer()) {}
private:
  std::unique_ptr<Part, Closer> part_;
};
int main(int argc, char ** argv) { rclcpp::spin(std::make_shared<Own>()); }
"""


def test_the_class_behind_a_pointer_is_not_that_which_deletes_it(acme: Path) -> None:
    """What a member is made with goes to the first argument of unique_ptr<T, Deleter>."""
    (acme / "src" / "main.cpp").write_text(DELETED)
    facts = read("driver_node", acme).facts
    assert [(it.role, it.name) for it in facts.endpoints] == [("publishes", "part")]
    assert not facts.untold


@pytest.mark.parametrize(
    ("release", "rules", "info"),
    [
        ("jazzy", (("front/image", "rear/image"),), "/front/camera_info"),
        ("jazzy", (("front/camera_info", "rear/camera_info"),), "/rear/camera_info"),
        ("kilted", (("front/image", "rear/image"),), "/rear/camera_info"),
        (
            "kilted",
            (("front/camera_info", "a"), ("front/image", "rear/image")),
            "/rear/camera_info",
        ),
        ("kilted", (("rear/camera_info", "a"), ("front/image", "rear/image")), "/a"),
    ],
)
@pytest.mark.parametrize("role", ["subscription", "publisher"])
def test_the_info_beside_an_image(
    release: str, rules: tuple[tuple[str, str], ...], info: str, role: str, acme: Path
) -> None:
    """image_common camera_subscriber.cpp, camera_publisher.cpp: beside the image as the code names it,
    since #326 (6.0.0, Kilted) as its rules do. rcl then applies the rules to that name."""
    rest = ', callback, "raw"' if role == "subscription" else ""
    made = f'image_transport::create_camera_{role}(this, "front/image"{rest});'
    (acme / "src" / "driver.cpp").write_text(UNIT.replace("  setUp();\n", f"  {made}\n"))
    facts = read("driver_node", acme, release).facts
    run = with_names(Run("", "driver", "/", "driver", rules, facts))
    infos = {name for it, name in run.names if it.type == "sensor_msgs/msg/CameraInfo"}
    assert infos == {info}


@pytest.mark.parametrize(
    ("guard", "condition"),
    [
        ("if (debug_) ", "debug = true"), ("if (!debug_) ", "debug unset or debug = false"),
        # What no parameter says may be so: it is sent.
        ("if (frame_.size() > 3) ", ""),
    ],
)  # fmt: skip
def test_a_transform_is_sent_where_its_parameter_says_so(
    guard: str, condition: str, acme: Path
) -> None:
    """Another node, as a filter, sends it where it is switched off."""
    unit, call = acme / "src/driver.cpp", "broadcaster_->sendTransform"
    unit.write_text(unit.read_text().replace(call, f"{guard}{call}"))
    assert [it.condition for it in read("driver_node", acme).facts.sends] == [condition]


def test_a_frame_with_a_parameter_in_it_is_not_that_parameter() -> None:
    """``self.space + "/base_link"``: no node has a parameter of that name."""
    texts = ("<@space>", "<@space>/base_link", "x/<@space>", "<@a><@b>")
    assert [*map(parameter_in, texts)] == ["space", "", "", ""]


def test_a_program_of_an_install_rule(acme: Path) -> None:
    facts = read("tool", acme).facts
    assert (facts.name, [it.name for it in facts.endpoints]) == ("tool", ["x"])


def test_a_namespace_of_the_code_is_not_that_of_the_launch(acme: Path) -> None:
    (acme / "scripts" / "tool.py").write_text(
        "import rclpy\nfrom std_msgs.msg import String\n"
        "node = rclpy.create_node('tool', namespace='inner')\n"
        "node.create_publisher(String, 'own', 1)\nnode.create_publisher(String, '/all', 1)\n"
    )
    facts = read("tool", acme).facts
    assert {it.name: it.when for it in facts.endpoints} == {"own": "open: source", "/all": ""}
    assert ["namespace" in it.text for it in facts.untold] == [True]


def test_a_name_is_that_of_the_parameter_where_it_is_declared(acme: Path) -> None:
    """rclpy's declare_parameter gives the parameter back, by its name and not by its default."""
    (acme / "scripts" / "tool.py").write_text(
        "import rclpy\nfrom std_msgs.msg import String\n"
        "node = rclpy.create_node('tool')\n"
        "topic = node.declare_parameter('scan_topic', 'scan').value\n"
        "node.create_publisher(String, topic, 1)\n"
    )
    (end,) = read("tool", acme).facts.endpoints
    assert (end.name, end.parameter) == ("scan", "scan_topic")


def test_a_part_that_no_call_is_seen_to_reach_is_not_known(acme: Path) -> None:
    (acme / "scripts" / "tool.py").write_text(
        "import rclpy\nfrom std_msgs.msg import String\n"
        "def added(node):\n    node.create_publisher(String, 'hidden', 1)\n"
        "node = rclpy.create_node('tool')\n{'add': added}['add'](node)\n"
    )
    facts = read("tool", acme).facts
    assert facts.endpoints == ()
    assert any("added" in it.text for it in facts.untold)


def test_a_program_whose_source_is_not_here(acme: Path) -> None:
    assert node_of_program(str(acme), "acme", "other", {}, "jazzy") is None


@pytest.mark.parametrize(
    ("text", "why"),
    [
        pytest.param(b"def main(:\n", "does not parse", id="a-syntax-error"),
        pytest.param(b"import rclpy\n\x00\n", "does not parse", id="a-null-character"),
        pytest.param(b"# \xff\nimport rclpy\n", "is not UTF-8", id="another-encoding"),
        pytest.param(b"x = 1\n" * 300_000, "has more than", id="too-long"),
        pytest.param(b"x = " + b"(" * 5000 + b")" * 5000, "does not parse", id="nested"),
        pytest.param(b"x = " + b"1 + " * 20_000 + b"1", "does not parse", id="a-long-sum"),
    ],
)
def test_what_cannot_be_read_is_named(acme: Path, text: bytes, why: str) -> None:
    (acme / "scripts" / "tool.py").write_bytes(text)
    untold = [it.text for it in read("tool", acme).facts.untold]
    # How deep Python itself goes differs.
    whys = (why, "nested too deeply")
    assert any("tool.py:" in it and any(one in it for one in whys) for it in untold), untold


def test_a_long_file_is_read_in_little_time(acme: Path) -> None:
    lines = "".join(f"        self.create_publisher(String, 't{at}', 1)\n" for at in range(10_000))
    text = (
        "import rclpy\nfrom rclpy.node import Node\nfrom std_msgs.msg import String\n"
        f"class N(Node):\n    def __init__(self):\n        super().__init__('n')\n{lines}"
        "def main():\n    N()\nmain()\n"
    )
    (acme / "scripts" / "tool.py").write_text(text)
    assert len(read("tool", acme).facts.endpoints) == 10_000


def test_a_long_function_in_cpp_is_read_in_little_time(acme: Path) -> None:
    lines = "".join(
        f'  create_publisher<std_msgs::msg::String>("t{at}", 1);\n  if (x) {{ y = {at}; }}\n'
        for at in range(5_000)
    )
    text = UNIT.replace("  setUp();\n", f"  setUp();\n{lines}")
    (acme / "src" / "driver.cpp").write_text(text)
    assert len(read("driver_node", acme).facts.endpoints) > 5_000


def test_nothing_is_imported_or_run(acme: Path, tmp_path: Path) -> None:
    trace = tmp_path / "trace"
    (acme / "scripts" / "tool.py").write_text(f"open({str(trace)!r}, 'w')\nimport antigravity\n")
    (acme / "setup.py").write_text(f"open({str(trace)!r}, 'w')\n")
    read("tool", acme)
    assert not trace.exists()
    assert "antigravity" not in sys.modules


@pytest.fixture
def without_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("tree_sitter", "tree_sitter_cpp"):
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setattr(expressions, "find_spec", lambda name: None)
    expressions._tools.cache_clear()
    programs._parsed_once.cache_clear()


@pytest.mark.usefixtures("without_reader")
def test_a_launched_node_in_cpp_without_the_extra(
    acme: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    launch = acme / "one.launch.xml"
    launch.write_text('<launch><node pkg="acme" exec="driver_node"/></launch>')
    main(["check-launch", str(launch)])
    said = capsys.readouterr().err
    assert "1 node not known" in said and "multibot_rewrite[sources]" in said


def test_a_service_of_the_simulator_is_no_robots(acme: Path) -> None:
    text = """import rclpy
from gazebo_msgs.srv import SpawnEntity
from std_srvs.srv import Trigger
node = rclpy.create_node('tool')
node.create_client(SpawnEntity, '/spawn_entity')
node.create_client(SpawnEntity, 'own')
node.create_client(Trigger, '/reset')
"""
    (acme / "scripts/tool.py").write_text(text)
    ends = read("tool.py", acme).facts.endpoints
    assert {it.name: bool(it.fixed and it.own) for it in ends if it.role == "calls"} == {
        "/spawn_entity": True,
        "own": False,
        "/reset": False,
    }
