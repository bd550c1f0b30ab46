# SPDX-License-Identifier: Apache-2.0
"""``multibot_rewrite.launch`` in launch, or in a stand-in for it where there is none.

What needs the real one (processes, the YAML frontend, the example package) is skipped without it.
"""

from __future__ import annotations

import gc
import importlib
import io
import json
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import launch_signatures
import launch_stand_in
import pytest
import yaml
from launched_programs import EXAMPLE, launched
from paths import FIXTURES, ROOT

from multibot_rewrite import Finding, InputError, UsageError, launch, load_fleet
from multibot_rewrite.launch import context as launch_context, later
from multibot_rewrite.producers.launch.stand_in import contents, standing_in

REAL = not launch.missing()
NO_LAUNCH = f"not tried in the real launch, which is not here: {launch.missing()}"
in_launch = pytest.mark.skipif(not REAL, reason=NO_LAUNCH)
FLEET = """\
layout: frames-per-robot
affix: prefix
node_sets: [nav2, robot_state]
robots:
  - {name: robot1, description: rover.urdf, pose: {x: 1.0, y: 0.5, yaw: 1.5}}
  - {name: robot2, description: rover.urdf, model: second}
related_files:
  params: params.yaml
  rviz: one.rviz
"""
PARAMS = 'amcl:\n  ros__parameters: {base_frame_id: "base_footprint", flag: "n", many: 1e-9}\n'
RVIZ = EXAMPLE / "config" / "rover.rviz"


class _Untyped:
    """Stands for the ParameterValue of a value whose type is not said."""

    value_type = None

    def __init__(self, text: str, parser: Any) -> None:
        self.value = parser.parse_substitution(text)


class Started:
    """Stands for classes of launch_ros: keeps what it is given, and whether it ran."""

    def __init__(self, *, condition: Any = None, **options: Any) -> None:
        self.condition, self.options, self.ran = condition, options, False

    @staticmethod
    def parse(entity: Any, parser: Any) -> tuple[Any, dict[str, Any]]:
        options = importlib.import_module("launch").Action.parse(entity, parser)[1]
        words = {"pkg": "package", "exec": "executable", "name": "name", "namespace": "namespace"}
        for attribute, option in words.items():
            text = entity.get_attr(attribute, optional=True)
            if text is not None:
                options[option] = parser.parse_substitution(text)
        return Started, options

    @staticmethod
    def parse_nested_parameters(params: list[Any], parser: Any) -> list[dict[str, Any]]:
        """Each element is one parameter; its value is what ParameterValue would keep."""
        return [{it.get_attr("name"): _Untyped(it.get_attr("value"), parser)} for it in params]

    def visit(self, context: Any) -> Any:
        wanted = self.condition is None or self.condition.evaluate(context)
        return self.execute(context) if wanted else None

    def execute(self, context: Any) -> Any:
        self.ran = True


class Set(Started):
    """Stands for SetParameter."""

    def __init__(self, name: str, value: object) -> None:
        super().__init__()
        self.name, self.value = name, value


SIGNATURES = json.loads((FIXTURES / "launch_signatures.json").read_text())


def refusing(name: str) -> Any:
    """Return a class that refuses the options that the one of launch_ros refuses."""

    def made(self: Started, **options: Any) -> None:
        unknown = sorted(set(options) - {*SIGNATURES[name]})
        if unknown:
            raise TypeError(f"{name} got an unexpected keyword argument {unknown[0]!r}")
        Started.__init__(self, **options)

    return type(name, (Started,), {"__init__": made})


def stand_ins(monkeypatch: pytest.MonkeyPatch) -> None:
    """Classes that start nothing in place of those of launch_ros."""
    actions, descriptions = ModuleType("launch_ros.actions"), ModuleType("launch_ros.descriptions")
    names = ("Node", "LifecycleNode", "ComposableNodeContainer", "LoadComposableNodes")
    vars(actions).update({name: refusing(name) for name in names}, SetParameter=Set)
    vars(descriptions)["ComposableNode"] = refusing("ComposableNode")
    for module in (actions, descriptions):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    if not REAL:
        launch_stand_in.install(monkeypatch)
        monkeypatch.delitem(sys.modules, "multibot_rewrite.launch.frontend", raising=False)


@pytest.fixture
def frontend(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Yield what XML can say, in launch or in the stand-in."""
    stand_ins(monkeypatch)
    made_once = (launch_context.substitution_class, later._action_class, later._component_class)
    for it in made_once:
        it.cache_clear()
    yield importlib.import_module("multibot_rewrite.launch.frontend")
    for it in made_once:
        it.cache_clear()


@pytest.fixture
def context(frontend: Any) -> Any:
    return importlib.import_module("launch").LaunchContext()


@pytest.fixture
def fleet(tmp_path: Path) -> str:
    """Return the path of a fleet file."""
    (tmp_path / "rover.urdf").write_bytes((FIXTURES / "robots" / "rover.urdf").read_bytes())
    (tmp_path / "params.yaml").write_text(PARAMS)
    (tmp_path / "one.rviz").write_bytes(RVIZ.read_bytes())
    (tmp_path / "fleet.yaml").write_text(FLEET)
    return str(tmp_path / "fleet.yaml")


def run(context: Any, action: Any) -> list[Started]:
    """Return what an action starts, and what those start that it makes."""
    made = [it for one in action.visit(context) or () for it in run(context, one)]
    own = isinstance(action, Started) and not isinstance(action, Set) and action.ran
    return [action, *made] if own else made


def read(text: str) -> list[Any]:
    """Return the actions of an XML launch file."""
    whole = f"<launch>{text}</launch>"
    if not REAL:
        parser: Any = launch_stand_in.Parser()
        children = launch_stand_in.Entity(ET.fromstring(whole)).children
        return [parser.parse_action(it) for it in children]
    from launch.frontend import Parser

    entity, parser = Parser.load(io.StringIO(whole))
    return list(parser.parse_description(entity).entities)


def of(name: str) -> Any:
    """Return a launch configuration, known when the launch file runs."""
    return importlib.import_module("launch.substitutions").LaunchConfiguration(name)


def shut_down(context: Any) -> None:
    handlers = list(context._event_handlers) if REAL else context.handlers
    event = importlib.import_module("launch.events").Shutdown() if REAL else None
    for handler in handlers:
        handler.handle(event, context)


def performed(context: Any, options: dict[str, Any]) -> dict[str, Any]:
    return {key: launch.perform(context, value) for key, value in options.items()}


@pytest.mark.slow
def test_importing_it_imports_no_launch() -> None:
    code = "import sys, multibot_rewrite.launch.frontend as f; print(*sys.modules)"
    code = code.replace("import sys,", "import sys; sys.modules['launch'] = None; import")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "launch_ros" not in done.stdout.split()
    code = "import sys, multibot_rewrite.launch; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"launch", "launch_ros"} & set(done.stdout.split())


WORDS = [
    ("name", "", "robot2"),
    ("namespace", "", "/robot2"),
    ("model", "", "second"),
    ("pose", "x", "0.0"),
    ("frame", "base_link", "robot2/base_link"),
    ("frame", "map", "map"),
    ("link", "lidar_link", "robot2/lidar_link"),
    ("joint", "lidar_joint", "robot2_lidar_joint"),
    ("topic", "/scan", "/robot2/scan"),
    ("node", "amcl", "/robot2/amcl"),
    ("srdf", "", ""),
]


@pytest.mark.parametrize(("word", "name", "wanted"), WORDS)
def test_words(word: str, name: str, wanted: str, fleet: str, context: Any) -> None:
    context.launch_configurations.update({"which": "robot2", "where": fleet})
    value = launch.value(word, name, robot=of("which"), fleet=of("where"))
    assert launch.perform(context, value) == wanted


def test_every_word_is_tried() -> None:
    assert {word for word, _, _ in WORDS} == set(launch.WORDS) - {"description"}


@pytest.mark.more
def test_a_description(fleet: str, context: Any) -> None:
    value = launch.description("robot1", fleet)
    assert launch.perform(context, value) == load_fleet(fleet).robot("robot1").description


@pytest.mark.more
def test_a_robot_in_its_group(fleet: str, context: Any) -> None:
    context.launch_configurations.update({"where": fleet})
    told = []

    def make(robot: Any) -> list[Any]:
        told.append(robot.name)
        return [Started(name=launch.value("name")), Started(name=launch.value("frame", "odom"))]

    action = launch.each_robot(of("where"), make)
    found = []
    for group in action.visit(context):
        for it in group.visit(context):
            if isinstance(it, Started):
                found.append(launch.perform(context, it.options["name"]))
            else:
                it.visit(context)
    assert told == ["robot1", "robot2"]
    assert found == ["robot1", "robot1/odom", "robot2", "robot2/odom"]
    assert set(context.launch_configurations) == {"where"}


@pytest.mark.more
@pytest.mark.parametrize(
    ("robots", "wanted"),
    [
        ("robot2, ", ["robot2"]),
        ("robot2,robot1", ["robot2", "robot1"]),
        (["robot2"], ["robot2"]),
        ([], ["robot1", "robot2"]),
        ("", ["robot1", "robot2"]),
        (None, ["robot2", "robot1"]),
    ],
)
def test_only_some_robots(robots: Any, wanted: list[str], fleet: str, context: Any) -> None:
    context.launch_configurations.update({"robots": "robot2"})
    chosen = [of("robots"), ",robot1"] if robots is None else robots
    made = launch.each_robot(fleet, lambda it: [Started(name=it.name)], robots=chosen)
    assert [it.options["name"] for it in run(context, made)] == wanted


@pytest.mark.more
@pytest.mark.parametrize("files", ["params.yaml,more.yaml", ["params.yaml", "more.yaml"]])
def test_several_files(files: Any, fleet: str, context: Any) -> None:
    (Path(fleet).with_name("more.yaml")).write_text(PARAMS)
    Path(fleet).write_text(FLEET.replace("params: params.yaml", "params: [params.yaml, more.yaml]"))
    (made,) = run(context, launch.node("amcl", files=files, robot="robot2", fleet=fleet))
    assert [Path(it).name for it in made.options["parameters"]] == ["params.yaml", "more.yaml"]


class Handler:
    """An event handler that tells whose it is."""

    def handle(self, event: Any, context: Any) -> str:
        return f"{event} of {launch.robot_of(context).name}"

    def matches(self, event: Any) -> bool:
        return False


def later_on(context: Any, handler: Any, event: str) -> Any:
    """Return what a handler says when its event comes, as a launch asks it (launch_service.py)."""
    context._push_locals()
    try:
        return handler.handle(event, context)
    finally:
        context._pop_locals()


def test_what_an_event_starts_is_of_the_robot_that_waits_for_it(fleet: str, context: Any) -> None:
    opaque = importlib.import_module("launch.actions").OpaqueFunction
    handlers: list[Any] = []
    kept: list[Any] = []

    def register(around: Any) -> None:
        handlers.append(Handler())
        around.register_event_handler(handlers[-1])
        kept.append(dict(around.get_locals_as_dict()))

    run(context, launch.each_robot(fleet, lambda robot: opaque(function=register)))
    run(context, opaque(function=register))
    first, second, outside = handlers
    for _ in range(2):
        assert later_on(context, first, "exit") == "exit of robot1"
        assert later_on(context, second, "exit") == "exit of robot2"
        with pytest.raises(UsageError, match="no robot is given"):
            later_on(context, outside, "exit")
    # A timer keeps these itself (timer_action.py).
    for known, name in zip(kept, ("robot1", "robot2"), strict=False):
        context._push_locals()
        context.extend_locals(known)
        assert launch.perform(context, launch.value("name")) == name
        context._pop_locals()
    assert launch.perform(context, launch.value("name", robot="robot2", fleet=fleet)) == "robot2"


def test_the_handler_of_all_timers_is_no_robots(fleet: str, context: Any) -> None:
    """launch registers one for all timers, with the first that starts."""
    opaque = importlib.import_module("launch.actions").OpaqueFunction

    class EventHandler(Handler):
        def matches(self, event: Any) -> bool:
            return type(event).__name__ == "TimerEvent"

    handler = EventHandler()
    one = opaque(function=lambda around: around.register_event_handler(handler))
    run(context, launch.each_robot(fleet, lambda robot: one, robots="robot1"))
    with pytest.raises(UsageError, match="is given; set"):
        later_on(context, handler, "time")


def test_the_robots_of_a_launch_argument_travel_too(fleet: str, context: Any) -> None:
    """Also where the argument is gone by then."""
    opaque = importlib.import_module("launch.actions").OpaqueFunction
    handler = Handler()
    one = opaque(function=lambda around: around.register_event_handler(handler))
    context._push_launch_configurations()
    run(context, launch.each_robot(fleet, lambda robot: one, robots="third={x: 1.0}"))
    context._pop_launch_configurations()
    assert later_on(context, handler, "exit") == "exit of third"


def test_a_group_in_a_group_ends_with_the_robot_around_it(fleet: str, context: Any) -> None:
    named = launch.value("name")
    inner = launch.each_robot(fleet, lambda robot: Started(name=named), robots="robot2")
    found: list[str] = []
    tell = importlib.import_module("launch.actions").OpaqueFunction(
        function=lambda around: found.append(launch.perform(around, named))
    )
    run(context, launch.each_robot(fleet, lambda robot: [inner, None, tell], robots="robot1"))
    assert found == ["robot1"]
    with pytest.raises(UsageError, match="no robot"):
        launch.robot_of(context, launch.RobotRef(fleet=fleet))


def test_the_program_of_a_node_is_that_of_its_node_set(fleet: str, context: Any) -> None:
    where = {"robot": "robot1", "fleet": Path(fleet)}

    def program(action: Any) -> tuple[Any, Any]:
        (made,) = run(context, action)
        return made.options.get("package"), made.options["executable"]

    assert program(launch.node("amcl", **where)) == ("nav2_amcl", "amcl")
    assert program(launch.lifecycle_node("map_server", **where)) == (
        "nav2_map_server",
        "map_server",
    )
    # What is said counts.
    assert program(launch.node("amcl", executable="/x", **where)) == (None, "/x")
    assert program(launch.node("amcl", package="my_amcl", **where)) == ("my_amcl", "amcl")
    with pytest.raises(UsageError, match="did you mean 'amcl'"):
        run(context, launch.node("amlc", **where))


def test_the_class_of_a_component_is_that_of_its_node_set(fleet: str, context: Any) -> None:
    Path(fleet).write_text(
        "distro: lyrical\n" + FLEET.replace("[nav2, robot_state]", "nav2_composed")
    )
    where = {"robot": "robot1", "fleet": fleet}
    (made,) = run(context, launch.node("amcl", **where))
    (node,) = made.options["composable_node_descriptions"]
    known = {"package": "nav2_amcl", "plugin": "nav2_amcl::AmclNode"}
    assert known.items() <= node.options.items()
    (box,) = run(context, launch.container("nav2_container", arguments=["-x"], **where))
    assert (box.options["package"], box.options["executable"]) == (
        "rclcpp_components", "component_container",
    )  # fmt: skip
    assert box.options["arguments"] == ["--isolated", "--executor-type", "single-threaded", "-x"]


def test_a_program_that_no_node_set_has_is_asked_for(fleet: str, context: Any) -> None:
    Path(fleet).with_name("nodes.yaml").write_text(
        "node_sets:\n  own: {about: one node, nodes: [driver]}\n"
        "nodes:\n  driver: {publishes: {scan: sensor_msgs/msg/LaserScan}}\n"
    )
    Path(fleet).write_text(f"nodes: nodes.yaml\n{FLEET.replace('[nav2, ', '[own, nav2, ')}")
    with pytest.raises(
        UsageError, match="no node set says what runs driver; write package= and exec"
    ):
        run(context, launch.node("driver", robot="robot1", fleet=fleet))


@pytest.mark.parametrize(
    ("word", "name", "near"),
    [
        ("frame", "lasr_link", ""),
        ("frame", "lidar_lnk", "lidar_link"),
        ("frame", "robot1/base_link", "base_link"),
        ("link", "lidar_lnk", "lidar_link"),
        ("link", "odom", ""),
        ("joint", "lidar_jint", "lidar_joint"),
        ("joint", "lidar_link", "lidar_joint"),
    ],
)
def test_a_name_that_is_not_there(
    word: str, name: str, near: str, fleet: str, context: Any
) -> None:
    with pytest.raises(UsageError) as caught:
        launch.perform(context, launch.value(word, name, "robot1", fleet))
    assert f"{word} {name!r} is not known" in str(caught.value)
    assert f"did you mean {near!r}?" in str(caught.value) or not near


def test_a_frame_that_only_nodes_send_is_there(fleet: str, context: Any) -> None:
    robot = load_fleet(fleet).robot("robot1")
    sent = ("odom", "map", "earth")
    assert [robot.frame(it) for it in sent] == ["robot1/odom", "map", "earth"]


@pytest.mark.more
def test_robots_that_the_file_does_not_have(fleet: str, context: Any) -> None:
    found = []
    robots = "robot2={x: 4.0, y: 1}; third={x: 6.0}"
    run(context, launch.each_robot(fleet, lambda it: found.append(it) or [], robots=robots))
    assert [(it.name, it.pose.x) for it in found] == [("robot2", 4.0), ("third", 6.0)]


@pytest.mark.parametrize("count", ["three", "-1", "2.5"])
def test_a_number_of_robots_that_is_none(count: str, fleet: str, context: Any) -> None:
    context.launch_configurations["multibot_count"] = count
    with pytest.raises(UsageError, match="write multibot_count:=20"):
        launch.fleet_of(context, fleet)


@pytest.mark.more
def test_a_condition(fleet: str, context: Any) -> None:
    never = importlib.import_module("launch.conditions").IfCondition("false")
    always = importlib.import_module("launch.conditions").IfCondition("true")
    for condition, count in ((never, 0), (always, 2)):
        made = launch.each_robot(fleet, lambda it: [Started(name=it.name)], condition=condition)
        assert len(run(context, made)) == count
        where = {"robot": "robot1", "fleet": fleet, "condition": condition}
        for one in (launch.node("amcl", **where), launch.spawn("gz", **where)):
            assert len(run(context, one)) == bool(count)


@pytest.mark.more
def test_a_node(fleet: str, context: Any) -> None:
    mine, later = ("scan", "front"), {"use_sim_time": True}
    action = launch.node(
        "amcl", files="params.yaml", robot="robot1", fleet=fleet, package="nav2_amcl",
        executable="amcl", remappings=[mine], parameters=[later],
    )  # fmt: skip
    (made,) = run(context, action)
    robot = load_fleet(fleet).robot("robot1")
    assert made.options["namespace"] == "/robot1"
    assert (made.options["name"], made.options["package"]) == ("amcl", "nav2_amcl")
    assert made.options["remappings"] == [mine, *robot.table.for_node("amcl")]
    params, start, last = made.options["parameters"]
    assert [Path(it).name for it in (params, start)] == ["params.yaml", "amcl.multibot.yaml"]
    assert last == later
    assert Path(params).read_text() == robot.text("params.yaml")
    own = yaml.safe_load(Path(start).read_text())["/robot1/amcl"]["ros__parameters"]
    assert own == robot.start_parameters("amcl")


def test_a_controller_is_started_by_its_spawner(fleet: str, context: Any) -> None:
    text = FLEET.replace("[nav2, robot_state]", "ros2_control")
    Path(fleet).write_text(f"distro: lyrical\n{text.replace('frames-per-robot', 'tf-per-robot')}")
    action = launch.node(
        "diff_drive_controller",
        robot="robot1",
        fleet=fleet,
        arguments=["--inactive"],
        output="both",
    )
    (made,) = run(context, action)
    assert made.options == {
        "package": "controller_manager",
        "executable": "spawner",
        "namespace": "/robot1",
        "output": "both",
        "arguments": [
            "diff_drive_controller", "--controller-ros-args", "-r /tf:=tf", "--inactive"
        ],
    }  # fmt: skip


def test_a_component_is_loaded_into_its_container(fleet: str, context: Any) -> None:
    Path(fleet).write_text(FLEET.replace("[nav2, robot_state]", "nav2_composed"))
    options = {"package": "nav2_amcl", "plugin": "nav2_amcl::AmclNode"}
    (made,) = run(context, launch.node("amcl", robot="robot1", fleet=fleet, **options))
    assert made.options["target_container"] == "/robot1/nav2_container"
    (node,) = made.options["composable_node_descriptions"]
    assert options.items() <= node.options.items()
    assert (node.options["name"], node.options["namespace"]) == ("amcl", "/robot1")
    with pytest.raises(UsageError, match="component of /robot1/nav2_container: write plugin="):
        run(context, launch.node("amcl", robot="robot1", fleet=fleet, executable="amcl"))
    (box,) = run(context, launch.node("nav2_container", robot="robot1", fleet=fleet))
    assert "composable_node_descriptions" not in box.options


@pytest.mark.more
def test_a_node_with_the_description(fleet: str, context: Any) -> None:
    where = {"robot": "robot2", "fleet": fleet}
    (made,) = run(context, launch.node("robot_state_publisher", describe=True, **where))
    (path,) = made.options["parameters"]
    held = yaml.safe_load(Path(path).read_text())["/robot2/robot_state_publisher"]
    wanted = load_fleet(fleet).robot("robot2").description
    assert held == {"ros__parameters": {"robot_description": wanted}}
    (bare,) = run(context, launch.node("bt_navigator", **where))
    assert bare.options["parameters"] == []


@pytest.mark.more
@pytest.mark.parametrize("odd", ["\x7f", "\x85", "\u2028", "\ufeff", "\U0001f916", 'a "b" \\n'])
def test_a_description_reads_back_whatever_is_in_it(odd: str, fleet: str, context: Any) -> None:
    path = Path(fleet).with_name("rover.urdf")
    text = path.read_text().replace('<robot name="rover">', f'<robot name="rover"><!-- {odd} -->')
    path.write_text(text)
    action = launch.node("robot_state_publisher", describe=True, robot="robot1", fleet=fleet)
    (made,) = run(context, action)
    data = yaml.safe_load(Path(made.options["parameters"][0]).read_bytes())
    assert odd in data["/robot1/robot_state_publisher"]["ros__parameters"]["robot_description"]


def test_a_spawner_and_a_place(fleet: str, context: Any) -> None:
    # Nothing that localises the robot: it gets a place by a static transform.
    Path(fleet).write_text(FLEET.replace("[nav2, robot_state]", "robot_state"))
    Path(fleet).with_name("params.yaml").write_text("own:\n  ros__parameters: {rate: 5}\n")
    robot = load_fleet(fleet).robot("robot1")
    (gz,) = run(context, launch.spawn("gz", "robot1", fleet))
    (classic,) = run(context, launch.spawn("classic", "robot1", fleet))
    (place,) = run(context, launch.place("robot1", fleet))
    assert gz.options["arguments"] == robot.spawn_arguments
    assert classic.options["arguments"] == robot.classic_arguments
    assert place.options["arguments"] == robot.transform_arguments
    # As the packages install them.
    assert [(it.options["package"], it.options["executable"]) for it in (gz, classic, place)] == [
        ("ros_gz_sim", "create"),
        ("gazebo_ros", "spawn_entity.py"),
        ("tf2_ros", "static_transform_publisher"),
    ]
    assert run(context, launch.place("robot2", fleet)) == []


@pytest.mark.more
def test_files_go_with_the_launch(fleet: str, context: Any) -> None:
    own = launch.perform(context, launch.params_file("params.yaml", "robot1", fleet))
    shared = launch.perform(context, launch.rviz_config("one.rviz", fleet=fleet))
    loaded = load_fleet(fleet)
    assert Path(own).read_text() == loaded.text("robot1/params.yaml")
    assert Path(shared).read_text() == loaded.text("one.rviz")
    folder = Path(own).parents[1]
    assert folder == Path(shared).parents[1]
    shut_down(context)
    assert not folder.exists()


@pytest.mark.more
def test_files_go_with_a_launch_that_is_never_shut_down(fleet: str, context: Any) -> None:
    own = importlib.import_module("launch").LaunchContext()
    path = Path(launch.perform(own, launch.params_file("params.yaml", "robot1", fleet)))
    assert path.exists()
    with pytest.warns(ResourceWarning, match="multibot_launch_"):
        del own
        gc.collect()
    assert not path.parents[1].exists()


@pytest.mark.more
def test_a_launch_loads_a_fleet_once(
    fleet: str, context: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    loads = []

    def counted(path: str, trust: bool = False, **more: Any) -> Any:
        loads.append(path)
        return load_fleet(path, trust=trust)

    monkeypatch.setattr(launch_context, "load_fleet", counted)
    first = launch.fleet_of(context, fleet)
    assert launch.fleet_of(context, fleet) is first
    run(context, launch.each_robot(fleet, lambda it: [launch.node("amcl", files="params.yaml")]))
    assert loads == [fleet]
    other = importlib.import_module("launch").LaunchContext()
    assert launch.fleet_of(other, fleet) is not first


@pytest.mark.parametrize(
    ("configured", "trusted"), [({}, False), ({"multibot_trust": "true"}, True),
    ({"multibot_trust": "false"}, False), ({"multibot_trust": "True"}, True)],
)  # fmt: skip
def test_a_launch_trusts_xacro_files_where_it_is_told(
    configured: dict[str, str],
    trusted: bool,
    fleet: str,
    context: Any,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = []

    def counted(path: str, trust: bool = False, **more: Any) -> Any:
        asked.append(trust)
        return load_fleet(path)

    monkeypatch.setattr(launch_context, "load_fleet", counted)
    context.launch_configurations.update(configured)
    launch.fleet_of(context, fleet)
    assert asked == [trusted]


@pytest.mark.more
def test_warnings_are_logged_once(
    fleet: str, context: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []

    class Log:
        def warning(self, text: str) -> None:
            told.append(text)

        info = warning

    log = importlib.import_module("launch.logging")
    monkeypatch.setattr(log, "get_logger", lambda name: Log())
    for robot in ("robot1", "robot2"):
        launch.perform(context, launch.params_file("params.yaml", robot, fleet))
    made = load_fleet(fleet).made
    assert told == [str(it) for it in made.findings]
    assert told


def test_a_note_is_no_warning(context: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    log = type(
        "Log", (), {it: lambda _, text, it=it: told.append(it) for it in ("info", "warning")}
    )
    monkeypatch.setattr(importlib.import_module("launch.logging"), "get_logger", lambda name: log())
    levels = ("note", "warning", "error")
    launch_context._log_findings(context, [Finding("MB100", it, "said") for it in levels])
    assert told == ["info", "warning", "warning"]


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("make", "part"),
    [
        (lambda fleet: launch.value("name"), "no robot is given"),
        (lambda fleet: launch.value("name", robot="robot1"), "no fleet is given"),
        (lambda fleet: launch.value("nam", robot="robot1", fleet=fleet), "did you mean 'name'"),
        (lambda fleet: launch.value("pose", "w", "robot1", fleet), "'w'"),
        (lambda fleet: launch.description("robt1", fleet), "did you mean 'robot1'"),
        (lambda fleet: launch.params_file("parms.yaml", "robot1", fleet), "did you mean"),
        (lambda fleet: launch.params_file("parms.yaml", fleet=fleet), "did you mean"),
    ],
)
def test_what_is_wrong_is_reported(
    make: Callable[[str], Any], part: str, fleet: str, context: Any
) -> None:
    with pytest.raises(UsageError) as caught:
        launch.perform(context, make(fleet))
    assert part in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_fleet_that_is_not_there(context: Any) -> None:
    with pytest.raises(InputError, match="nowhere"):
        launch.fleet_of(context, "nowhere.yaml")
    with pytest.raises(UsageError, match="did you mean 'gz'"):
        run(context, launch.spawn("gzz", "robot1", "nowhere.yaml"))


@pytest.mark.more
def test_xml_for_every_robot(fleet: str, context: Any) -> None:
    context.launch_configurations.update({"where": fleet, "which": ""})
    (action,) = read(
        '<multibot_robots fleet="$(var where)" robots="$(var which)">'
        '<multibot_node node="amcl" pkg="nav2_amcl" exec="$(multibot name)" files="params.yaml"/>'
        '<multibot_spawn simulator="gz"/><multibot_place/>'
        "</multibot_robots>"
    )
    executables = []
    for group in action.visit(context):
        for it in group.visit(context):
            for made in run(context, it):
                found = made.options["executable"]
                executables.append(launch.perform(context, found))
    assert executables == ["robot1", "create", "robot2", "create"]


@pytest.mark.more
def test_xml_for_one_robot(fleet: str, context: Any) -> None:
    where = f'robot="robot2" fleet="{fleet}"'
    node, spawn, off = read(
        f'<multibot_node node="robot_state_publisher" describe="true" exec="x" {where}/>'
        f'<multibot_spawn simulator="classic" {where}/>'
        f'<multibot_node node="amcl" exec="x" if="false" {where}/>'
    )
    (made,) = run(context, node)
    assert made.options["name"] == "robot_state_publisher"
    assert len(made.options["parameters"]) == 1
    (made,) = run(context, spawn)
    assert made.options["arguments"][:2] == ["-entity", "second"]
    assert run(context, off) == []


@pytest.mark.sample(1)
@pytest.mark.parametrize(("word", "name", "wanted"), WORDS)
def test_xml_words(word: str, name: str, wanted: str, fleet: str, context: Any) -> None:
    context.launch_configurations.update({"where": fleet, "which": "robot2"})
    words = f"{word} {name}".strip()
    text = f"a $(multibot {words} robot:=$(var which) fleet:=$(var where)) b"
    (action,) = read(f'<multibot_spawn simulator="{text}"/>')
    with pytest.raises(UsageError) as caught:
        run(context, action)
    assert f"'a {wanted} b'" in str(caught.value)


def test_a_path_in_a_word_may_have_what_parts_its_name(
    fleet: str, context: Any, tmp_path: Path
) -> None:
    named = tmp_path / "a:=b.yaml"
    named.write_text(Path(fleet).read_text())
    (action,) = read(f'<multibot_spawn simulator="$(multibot name robot:=robot2 fleet:={named})"/>')
    with pytest.raises(UsageError, match="'robot2'"):
        run(context, action)


@pytest.mark.parametrize(
    ("text", "part"),
    [
        *(
            (
                f'<{it} node="amcl" exec="x" {word}="y"/>',
                f"^{it}: {word} comes from the fleet file; remove {word}=$",
            )
            for it in ("multibot_node", "multibot_lifecycle_node", "multibot_container")
            for word in ("name", "namespace")
        ),
        ('<multibot_node exec="x"/>', "node"),
        ("<multibot_robots/>", "fleet=FILE"),
        ("<multibot_spawn/>", "simulator"),
        ('<multibot_place robt="x"/>', "robt"),
        ('<multibot_robots fleet="x" robot="y"/>', "robot"),
    ],
)
def test_xml_that_is_wrong(text: str, part: str, context: Any) -> None:
    with pytest.raises((ValueError, AttributeError), match=part):
        read(text)


COMPOSED = """\
<multibot_container node="box" pkg="rclcpp_components" exec="isolated" files="a.yaml" robot="r">
  <multibot_composable_node node="one" pkg="p" plugin="p::One" files="b.yaml" if="false"/>
  <multibot_composable_node node="two" pkg="q" plugin="q::Two" describe="true" fleet="f.yaml">
    <param name="robot" value="$(multibot name robot:=$(var which))"/>
    <param name="rate" value="5"/>
    <remap from="scan" to="front"/>
    <remap from="a" to="b"/>
  </multibot_composable_node>
</multibot_container>
"""


def entity(text: str) -> Any:
    return launch_stand_in.Entity(ET.fromstring(text))


@pytest.mark.skipif(REAL, reason="real launch has its own parser")
def test_xml_for_a_container_with_components(frontend: Any, context: Any) -> None:
    made, given = frontend.container(entity(COMPOSED), launch_stand_in.Parser())
    assert made is launch.container and given.pop("describe") is False
    inside = given.pop("composable_node_descriptions")
    assert performed(context, given) == {
        "package": "rclcpp_components", "executable": "isolated", "name_in_set": "box",
        "files": "a.yaml", "robot": "r",
    }  # fmt: skip
    first, second = (it.options for it in inside)
    assert performed(context, first) == {"package": "p", "plugin": "p::One"}
    assert performed(context, {key: second[key] for key in ("package", "plugin")}) == {
        "package": "q", "plugin": "q::Two",
    }  # fmt: skip
    rules = [tuple(launch.perform(context, one) for one in it) for it in second["remappings"]]
    assert rules == [("scan", "front"), ("a", "b")]
    robot, rate = second["parameters"]
    # A value that is one of ours has its type; any other is launch_ros's.
    assert isinstance(robot["robot"], launch_context.substitution_class())
    assert isinstance(rate["rate"], _Untyped)
    assert inside[0].condition.evaluate(context) is False and inside[1].condition is None


@pytest.mark.skipif(REAL, reason="real launch has its own parser")
def test_xml_for_a_component(frontend: Any, context: Any) -> None:
    parser = launch_stand_in.Parser()
    text = '<multibot_composable_node node="one" pkg="p" plugin="p::One" use_sim_time="true"/>'
    made, given = frontend.composable_node(entity(text), parser)
    assert made is launch.node and given.pop("describe") is False
    assert performed(context, given) == {
        "package": "p", "plugin": "p::One", "name_in_set": "one", "use_sim_time": "true",
    }  # fmt: skip
    with pytest.raises(AttributeError, match="node"):
        frontend.composable_node(entity(text.replace('node="one"', "")), parser)
    # Its program is that of the node set.
    bare = text.replace('pkg="p" plugin="p::One"', "")
    assert not {"package", "plugin"} & {*frontend.composable_node(entity(bare), parser)[1]}
    # What is not known of a component in a container is not passed over.
    with pytest.raises(ValueError, match="plugn"):
        frontend.container(entity(COMPOSED.replace('pkg="p"', 'pkg="p" plugn="x"')), parser)
    with pytest.raises(ValueError, match="too"):
        frontend.container(entity(COMPOSED.replace('to="b"', 'to="b" too="c"')), parser)


@pytest.mark.skipif(REAL, reason="real launch has its own parser")
@pytest.mark.parametrize(
    ("text", "made", "known"),
    [
        ('<n node="a" exec="x" describe="true"/>', "node", {"executable": "x", "name_in_set": "a"}),
        (
            '<n node="a" use_sim_time="false"/>', "lifecycle_node",
            {"name_in_set": "a", "use_sim_time": "false"},
        ),
        (
            '<n simulator="gz" robot="r" output="screen"/>', "spawn",
            {"simulator": "gz", "robot": "r", "output": "screen"},
        ),
        ('<n fleet="f" use_sim_time="true"/>', "place", {"fleet": "f", "use_sim_time": "true"}),
    ],
)  # fmt: skip
def test_xml_is_what_the_functions_take(
    text: str, made: str, known: dict[str, str], frontend: Any, context: Any
) -> None:
    found, given = getattr(frontend, made)(entity(text), launch_stand_in.Parser())
    assert found is getattr(launch, made)
    assert given.pop("describe", None) in (None, made == "node")
    assert performed(context, given) == known


@pytest.mark.skipif(REAL, reason="real launch has its own table")
def test_words_of_xml_are_those_of_the_page(frontend: Any) -> None:
    """docs/launch.md: the names under which launch finds them."""
    made = {
        "robots", "node", "lifecycle_node", "container", "composable_node", "spawn", "place"
    }  # fmt: skip
    assert {it for it in launch_stand_in.ACTIONS if it.startswith("multibot_")} >= {
        f"multibot_{it}" for it in made
    }
    assert "multibot" in launch_stand_in.SUBSTITUTIONS
    for it in made:
        assert f"multibot_{it}" in PAGE


def test_a_value_alone_has_its_type(fleet: str, context: Any) -> None:
    """launch_ros reads every other substitution as YAML."""
    pose = launch.value("pose", "x", "robot1", fleet)
    assert pose.evaluate(context) == 1.0
    name = launch.value("name", "", "robot1", fleet)
    assert name.evaluate(context) == "robot1"

    class Value:
        def __init__(self, value: Any, value_type: Any = None) -> None:
            self.value, self.value_type = value, value_type

    assert launch_context.as_value(Value([pose])) is pose
    for other in (Value([pose, name]), Value([pose], str), Value(["text"]), Value("text"), 5):
        assert launch_context.as_value(other) is other


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda **it: launch.node("amcl", **it), "node"),
        (lambda **it: launch.lifecycle_node("amcl", **it), "lifecycle_node"),
        (lambda **it: launch.container("amcl", **it), "container"),
        (lambda **it: launch.composable_node("amcl", **it), "composable_node"),
        (launch.place, "place"),
    ],
)
def test_what_the_fleet_decides_is_no_option(
    make: Callable[..., Any], word: str, frontend: Any
) -> None:
    with pytest.raises(UsageError) as caught:
        make(namespace="/x")
    said = f"{word}: namespace comes from the fleet file; remove namespace="
    assert str(caught.value) == said
    with pytest.raises(UsageError, match=rf'write {word}\("amcl"\) .*, and remove name='):
        make(name="x")


def test_a_node_has_to_be_said(frontend: Any) -> None:
    for word in ("node", "lifecycle_node", "container", "composable_node"):
        with pytest.raises(UsageError, match=rf'{word}: which node\? .*{word}\("amcl"\)'):
            getattr(launch, word)(package="p")


def test_an_action_is_one_before_its_robot_is_known(frontend: Any) -> None:
    """Event handlers want an action of launch_ros; some of its classes want a name at once."""
    later = {"executable": "later"}
    named = {**later, "name": "later", "namespace": "", "package": "later"}
    assert launch.node("amcl", output="log").options == {**later, "output": "log"}
    assert launch.lifecycle_node("amcl").options == named
    assert launch.container("box").options == named
    component = {"package": "later", "plugin": "later"}
    assert launch.composable_node("amcl").options == component
    assert launch.node("amcl", plugin="p", package="q").options == {**later, "package": "q"}
    assert launch.spawn("gz", use_sim_time=True, output="log").options == {**later, "output": "log"}
    assert launch.place(executable="x").options == {"executable": "x"}


@pytest.mark.more
def test_the_options_of_a_program(fleet: str, context: Any) -> None:
    of_robot = {"robot": "robot1", "fleet": fleet}
    (made,) = run(
        context,
        launch.spawn("gz", **of_robot, use_sim_time=True, arguments=["-x"], parameters=[{"a": 1}]),
    )
    robot = load_fleet(fleet).robot("robot1")
    assert made.options == {
        "package": "ros_gz_sim", "executable": "create", "arguments": [*robot.spawn_arguments, "-x"],
        "parameters": [{"use_sim_time": True}, {"a": 1}],
    }  # fmt: skip
    (made,) = run(context, launch.spawn("classic", **of_robot))
    assert "parameters" not in made.options


class Around:
    """A launch context of which only the configurations are asked."""

    def __init__(self, **configurations: str) -> None:
        self.launch_configurations = configurations


@pytest.mark.parametrize(
    ("told", "configured", "of_robot", "clock"),
    [
        (True, "false", None, True), (False, "true", True, False), (None, "true", False, True),
        (None, " True ", None, True), (None, "1", None, True), (None, "0", True, False),
        (None, "false", True, False), (None, "", True, True), (None, " ", False, False),
        (None, None, True, True), (None, None, None, None),
    ],
)  # fmt: skip
def test_whose_word_on_the_clock_counts(
    told: Any, configured: str | None, of_robot: bool | None, clock: bool | None
) -> None:
    class Robot:
        use_sim_time = of_robot

    around = Around(**({} if configured is None else {"use_sim_time": configured}))
    assert launch_context.sim_time(around, Robot(), told) is clock  # type: ignore[arg-type]


def test_the_clock_of_a_node_may_be_a_text(context: Any) -> None:
    context.launch_configurations["sim"] = "TRUE"
    assert launch_context.sim_time(context, None, of("sim")) is True  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="use_sim_time is 'maybe'; write true or false"):
        launch_context.sim_time(context, None, "maybe")  # type: ignore[arg-type]


def test_words_of_launch_configurations_are_those_of_the_page() -> None:
    found = (
        launch_context.FLEET, launch_context.ROBOT, launch_context.TRUST, launch_context.DISTRO,
        launch_context.ROBOTS, launch_context.COUNT, launch_context.SIM_TIME,
    )  # fmt: skip
    words = ("fleet", "robot", "trust", "distro", "robots", "count")
    assert found == (*(f"multibot_{it}" for it in words), "use_sim_time")
    assert [launch_context.number_of(it) for it in ("", "0", "20")] == [0, 0, 20]


def test_options_of_load_fleet_are_launch_configurations(
    context: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each robots and count is a fleet of its own; release and trust are those of the launch."""
    asked: list[dict[str, Any]] = []

    class Fleet:
        findings = ()

    def load(path: str, **more: Any) -> Any:
        asked.append({"path": path, **more})
        return Fleet()

    monkeypatch.setattr(launch_context, "load_fleet", load)
    known = context.launch_configurations
    known.update(multibot_fleet="f.yaml", multibot_trust="1", multibot_distro="jazzy")
    first = launch.fleet_of(context)
    assert launch.fleet_of(context, "f.yaml") is first
    known["multibot_robots"] = "r={}"
    assert launch.fleet_of(context) is not first
    known.update(multibot_robots="", multibot_count="3")
    assert launch.fleet_of(context) is not first
    usual = {"path": "f.yaml", "trust": True, "distro": "jazzy", "robots": "", "count": 0}
    assert asked == [usual, {**usual, "robots": "r={}"}, {**usual, "count": 3}]


def test_files_of_robots_and_of_all_are_apart(fleet: str, context: Any) -> None:
    robot = load_fleet(fleet).robot("robot1")
    one = Path(launch_context.written(context, robot, "nodes/a.yaml", "é\n"))
    all_ = Path(launch_context.written(context, None, "a.yaml", "b\n"))
    assert one.parts[-3:] == ("robot1", "nodes", "a.yaml") and all_.parts[-2:] == ("all", "a.yaml")
    assert one.parents[2] == all_.parents[1] and one.read_bytes() == "é\n".encode()
    assert one.parents[2].name.startswith("multibot_launch_")


def test_substitutions_in_a_file_of_parameters_are_performed(
    fleet: str, context: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """launch reads quotes and backslashes of a text, so one without substitutions is none of its."""
    door = launch_context.of_launch
    parser = SimpleNamespace(
        parse_substitution=lambda text: text.replace("$(find-pkg-share p)", "/p")
    )
    monkeypatch.setattr(
        launch_context,
        "of_launch",
        lambda name: parser if name == "frontend.parse_substitution" else door(name),
    )
    of_robot = launch.RobotRef("robot1", fleet)
    file = Path(fleet).with_name("params.yaml")
    file.write_text(file.read_text().replace("}", ", map: $(find-pkg-share p)/m}"))
    made = Path(launch_context.node_file_of(context, "params.yaml", of_robot))
    assert "map: /p/m" in made.read_text()


def test_a_substitution_needs_a_word(frontend: Any) -> None:
    with pytest.raises(ValueError, match="needs one of: name"):
        frontend.words([])


PAGE = (ROOT / "docs" / "launch.md").read_text()
BLOCKS = re.findall(r"```(?:python|yaml|xml)\n(.*?)```", PAGE, re.DOTALL)
TUTORIAL = ROOT / "examples" / "launch_tutorial"
STEPS = ("one.launch.py", "fleet.yaml", "two.launch.py", "three.launch.py", "three.launch.xml")
SHOWN = [(TUTORIAL / it).read_text() for it in STEPS]
PYTHON = [it for it in BLOCKS if it.startswith("from") and it not in SHOWN]
THREE = "robots:=robot1={x: 1.0}; robot2={x: 3.0}; robot3={x: 5.0}"


def test_the_page_shows_the_files_of_the_tutorial() -> None:
    assert [it for it in BLOCKS if it in SHOWN] == SHOWN


@pytest.mark.parametrize(
    ("file", "robots", "count"),
    [("one.launch.py", "", 0), ("two.launch.py", "", 2), ("three.launch.py", "robot1", 1),
    ("three.launch.py", THREE.partition(":=")[2], 3)],
)  # fmt: skip
def test_a_step_of_the_tutorial(file: str, robots: str, count: int, context: Any) -> None:
    """What it makes, in launch or in the stand-in."""
    if REAL and file.startswith("three"):
        pytest.skip("what an event starts is tried where it is started")
    path = TUTORIAL / file
    names: dict[str, Any] = {"__file__": str(path)}
    exec(compile(path.read_text(), file, "exec"), names)
    context.launch_configurations["robots"] = robots
    made = run(context, names["generate_launch_description"]())
    programs = [it.options["executable"] for it in made]
    own = ("robot_state_publisher", "joint_state_publisher", "create")
    assert [programs.count(it) for it in own] == [max(count, 1)] * 3
    assert programs.count("static_transform_publisher") == count
    assert programs.count("parameter_bridge") == (count + 1 if count else 0)
    names_ = [it.options.get("namespace") for it in made if it.options["executable"] == own[0]]
    assert names_ == ([f"/robot{at}" for at in range(1, count + 1)] or [None])


@in_launch
@pytest.mark.parametrize("file", ["one.launch.py", "two.launch.py", *STEPS[3:]])
def test_a_step_of_the_tutorial_in_launch(file: str, tmp_path: Path) -> None:
    """As it is started: three robots where the launch file takes their number."""
    words = [THREE] if file.startswith("three") else []
    programs = {"joint_state_publisher": "joint_state_publisher"}
    told, said = launched(TUTORIAL / file, tmp_path, *words, programs=programs)
    assert "ERROR" not in said
    names = [Path(it["words"][0]).name for it in told]
    count = {"o": 1, "t": 2}[file[0]] + len(words)
    own = ("robot_state_publisher", "joint_state_publisher", "create")
    assert [names.count(it) for it in own] == [count] * 3
    assert names.count("parameter_bridge") == (count + 1 if count > 1 else 0)
    if count == 1:
        return
    fleet = load_fleet(TUTORIAL / "fleet.yaml", robots=THREE.partition(":=")[2] if words else "")
    texts = "".join(text for it in told for text in it["files"].values())
    for robot in fleet.robots:
        assert f"/{robot.name}/robot_state_publisher" in texts
        (model,) = (it for it in told if {*robot.spawn_arguments} <= {*it["words"]})
        assert Path(model["words"][0]).name == "create"
        assert f"/{robot.name}/bridge.yaml" in texts


@pytest.mark.more
@pytest.mark.parametrize("code", PYTHON, ids=["plain", "running"])
def test_the_python_of_the_page(
    code: str, fleet: str, context: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(Path(fleet).parent)
    context.launch_configurations["fleet"] = fleet
    names: dict[str, Any] = {}
    exec(compile(code, "launch.md", "exec"), names)
    made = run(context, names["generate_launch_description"]())
    programs = [it.options["executable"] for it in made]
    assert programs.count("amcl") == programs.count("create") == 2
    assert programs.count("robot_state_publisher") == 2


def test_the_words_of_the_page_are_those_there_are() -> None:
    (listed,) = re.findall(r"`\$\(multibot WORD\)` is one of (.*?)\.\s", PAGE, re.DOTALL)
    words = {it.split()[0] for it in re.findall(r"`(.*?)`", listed)}
    assert words == {*launch.WORDS, launch.FILE}


@in_launch
def test_the_xml_of_the_page(fleet: str, tmp_path: Path) -> None:
    (text,) = (it for it in BLOCKS if it.startswith("<launch>") and it not in SHOWN)
    (tmp_path / "page.launch.xml").write_text(text)
    more = {"amcl": "nav2_amcl", "driver": "my_driver"}
    told, _ = launched(tmp_path / "page.launch.xml", tmp_path, f"fleet:={fleet}", programs=more)
    drivers = [it["words"] for it in told if it["words"][0].endswith("driver")]
    assert sorted(words[1] for words in drivers) == ["robot1/lidar_link", "robot2/lidar_link"]
    assert len([it for it in told if it["words"][0].endswith("amcl")]) == 2


def test_the_stand_in_is_like_launch() -> None:
    """By the table that is made of the real one, and by the sources of newer classes."""
    known = {**SIGNATURES["launch"], **launch_signatures.NEWER}
    assert launch_signatures.stand_in() == known


def test_what_launch_offers_can_be_imported_without_it() -> None:
    """By the same table: a launch file does not fail at a name that it imports."""
    missing = {
        f"{module}.{name}"
        for module, names in SIGNATURES["names"].items()
        for name in {*names} - {*contents()[module]}
    }
    assert not missing


@pytest.mark.parametrize(
    "line",
    [
        "from launch.actions.declare_launch_argument import DeclareLaunchArgument",
        "from launch.launch_description import LaunchDescription",
        "from launch.substitutions.path_join_substitution import PathJoinSubstitution",
        "from launch_ros.substitutions.find_package import FindPackageShare",
        "import launch, launch_ros; launch.SomeSubstitutionsType; launch_ros.actions.Node",
    ],
)
def test_a_module_inside_of_launch_can_be_imported_without_it(line: str) -> None:
    with standing_in():
        exec(line, {})


def test_a_name_that_launch_has_not_cannot_be_imported() -> None:
    with standing_in():
        for line in ("from launch.actions import Nod", "import launch.actions.declare_argument"):
            with pytest.raises(ImportError):
                exec(line, {})


@in_launch
def test_the_table_is_that_of_launch_and_launch_ros() -> None:
    assert launch_signatures.table() == SIGNATURES


@pytest.mark.parametrize(
    "make",
    [
        lambda **it: launch.node("amcl", **it),
        lambda **it: launch.lifecycle_node("amcl", **it),
        lambda **it: launch.spawn("gz", **it),
        launch.place,
    ],
)
def test_an_option_that_launch_ros_has_not_is_refused_at_once(
    make: Callable[..., Any], context: Any
) -> None:
    with pytest.raises(TypeError, match="on_exitt"):
        make(on_exitt=[])


LAUNCH_FILES = ("gz.launch.py", "gz.launch.xml", "classic.launch.py", "classic.launch.yaml")


@in_launch
@pytest.mark.parametrize("name", LAUNCH_FILES)
def test_the_example_package(name: str, tmp_path: Path) -> None:
    told, said = launched(EXAMPLE / "launch" / name, tmp_path)
    assert "ERROR" not in said
    kind = "fleet_gz.yaml" if name.startswith("gz") else "fleet.yaml"
    fleet = load_fleet(tmp_path / "install" / "share" / "multibot_example" / "config" / kind)
    for robot in fleet.robots:
        assert_started(robot, told, name)
    if "rviz2" in (EXAMPLE / "launch" / name).read_text():
        (rviz,) = (it for it in told if it["words"][0].endswith("rviz2"))
        assert fleet.text("rover.rviz") in rviz["files"].values()


def assert_started(robot: Any, told: list[dict[str, Any]], name: str) -> None:
    """Its programs were started with what they need."""
    its = [it for it in told if f"__ns:={robot.namespace}" in it["words"]]
    (state,) = (it for it in its if it["words"][0].endswith("robot_state_publisher"))
    held: dict[str, Any] = {}
    for text in state["files"].values():
        section = yaml.safe_load(text) if "ros__parameters" in text else {}
        held |= section.get(f"{robot.namespace}/robot_state_publisher", {}).get(
            "ros__parameters", {}
        )
    assert held["robot_description"] == robot.description
    assert (held["use_sim_time"], held["publish_frequency"]) == (True, 30.0)
    (place,) = (it for it in its if it["words"][0].endswith("static_transform_publisher"))
    assert set(robot.transform_arguments) <= set(place["words"])
    arguments = robot.spawn_arguments if name.startswith("gz") else robot.classic_arguments
    assert any(it["words"][1 : 1 + len(arguments)] == arguments for it in told)
    if name.startswith("gz"):
        (bridge,) = (it for it in its if it["words"][0].endswith("parameter_bridge"))
        assert "config_file" in "".join(bridge["files"].values())


@in_launch
def test_the_example_with_some_of_the_robots(tmp_path: Path) -> None:
    told, _ = launched(EXAMPLE / "launch" / "gz.launch.xml", tmp_path, "robots:=robot2")
    names = {word for it in told for word in it["words"] if word.startswith("__ns:=/")}
    assert names == {"__ns:=/robot2"}


@in_launch
def test_a_mistake_is_one_line_of_launch(tmp_path: Path) -> None:
    with pytest.raises(AssertionError) as caught:
        launched(EXAMPLE / "launch" / "gz.launch.xml", tmp_path, "robots:=robt2")
    assert "did you mean 'robot2'" in str(caught.value)


def test_other_nodes_of_a_group_have_the_robots_clock(fleet: str, context: Any) -> None:
    def clocks() -> list[tuple[str, object]]:
        made = launch.each_robot(fleet, lambda robot: [])
        return [
            (it.name, it.value)
            for group in made.visit(context)
            for it in group.visit(context)
            if isinstance(it, Set)
        ]

    assert clocks() == []
    context.launch_configurations["use_sim_time"] = "true"
    assert clocks() == [("use_sim_time", True)] * 2


@pytest.mark.parametrize(
    ("configured", "what"),
    [({}, "robot"), ({"multibot_fleet": "f"}, "robot"), ({"multibot_robot": "r"}, "fleet")],
)
def test_what_no_group_says_has_to_be_set(
    configured: dict[str, str], what: str, context: Any
) -> None:
    context.launch_configurations.update(configured)
    with pytest.raises(UsageError) as caught:
        launch.robot_of(context)
    said = f"no {what} is given; set {what}, or put it into multibot_robots or each_robot"
    assert str(caught.value) == said
