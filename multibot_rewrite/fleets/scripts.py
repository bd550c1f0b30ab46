"""A fleet file for launch scripts: plain values for each robot, without writing files.

from multibot_rewrite import load_fleet

for robot in load_fleet("fleet.yaml").robots:
    Node(package="nav2_amcl", executable="amcl", **robot.node("amcl", "params.yaml"))
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import Any, NoReturn

from multibot_rewrite.arguments import checked
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.companions.names.robot_topics import fleet_topics, robot_topic
from multibot_rewrite.companions.params.rcl_parameters import (
    Value,
    check_values,
    exact_nodes,
    node_parameters,
)
from multibot_rewrite.companions.yaml_text import YamlText, read_yaml
from multibot_rewrite.findings.finding import ERROR, Finding, RewriteRefused
from multibot_rewrite.fleets import spawn, start_poses, teleop
from multibot_rewrite.fleets.build import Outputs, make_outputs
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_file import FleetFile, Pose, Sources, read_fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan, plan_fleet
from multibot_rewrite.fleets.node_names import NodeNames, Rules, names_of
from multibot_rewrite.fleets.output_file import OutputFile
from multibot_rewrite.fleets.rewritten_robots import Jobs, RewrittenRobot
from multibot_rewrite.fleets.robot_choice import Choice
from multibot_rewrite.fleets.with_start_pose_nodes import with_start_pose_nodes
from multibot_rewrite.model import UsageError
from multibot_rewrite.naming import NAMESPACE, TF_TOPICS
from multibot_rewrite.remap.records import TOPIC
from multibot_rewrite.remap.stacks import is_apart
from multibot_rewrite.remap.targets import placed, target_of
from multibot_rewrite.remap.yaml_with_lines import unknown
from multibot_rewrite.sources.read import read_file


class LoadedRobot:
    """One robot of a fleet: what its nodes, its simulator and its tf need, as plain values.

    ``namespace`` is absolute; ``tag`` is the prefix or postfix of its frames and joints; ``pose`` is
    None if the fleet file has none. It can be copied and pickled, with its fleet.
    """

    def __init__(self, fleet: LoadedFleet, robot: RewrittenRobot) -> None:
        self._fleet, self._robot = fleet, robot
        spec = robot.spec
        self._graph = spec.namespace
        self.name: str = spec.name
        self.model: str = spec.model
        self.tag: str = spec.tag
        self.pose: Pose | None = spec.pose
        self.use_sim_time: bool | None = spec.use_sim_time
        namespaced = robot.topics.naming.topics == NAMESPACE
        self.namespace: str = f"/{spec.namespace}" if namespaced else "/"

    def __repr__(self) -> str:
        return f"LoadedRobot({self.name!r})"

    def __reduce__(self) -> tuple[Callable[[LoadedFleet, str], LoadedRobot], tuple[object, ...]]:
        return LoadedFleet.robot, (self._fleet, self.name)

    @property
    def description(self) -> str:
        """Its rewritten description, for ``robot_description``; raises nothing."""
        return self._robot.description.decode()

    @property
    def description_parameters(self) -> dict[str, Any]:
        """The parameters of its robot_state_publisher: ``robot_description``, and ``frame_prefix`` in
        the layout of that name. Raises nothing."""
        prefix = self._robot.frame_prefix
        given = {"robot_description": self.description}
        return {**given, "frame_prefix": prefix} if prefix else given

    @property
    def srdf(self) -> str:
        """Its rewritten SRDF, for ``robot_description_semantic``; empty if it has none. Raises
        nothing."""
        return self._robot.srdf.decode()

    @cached_property
    def table(self) -> NodeNames:
        """Names and remappings of its nodes: ``remappings=robot.table.for_node("amcl")``. Raises
        nothing."""
        return names_of(self._fleet.planned.table, self._graph)

    @checked
    def node(self, node: str, *files: str) -> dict[str, Any]:
        """Name, namespace, remappings and parameters of a node of its stacks, for ``Node(**...)``.

        ``files`` are parameter files of the fleet; amcl gets its start pose as well, and
        each node the clock that the fleet file says.
        Raises UsageError for a node that no stack has and for a controller (``spawner``), and as
        ``params`` for a file.
        """
        given = [self.params(file, node) for file in files]
        clock = {} if self.use_sim_time is None else {"use_sim_time": self.use_sim_time}
        return {
            "name": self.table.name(node),
            "namespace": self.table.namespace(node),
            "remappings": self.table.for_node(node),
            "parameters": [it for it in (*given, self.start_parameters(node), clock) if it],
        }

    @checked
    def spawner(self, controller: str, *paths: str) -> dict[str, Any]:
        """What loads a controller of its stacks, with its remappings, for ``Node(**...)``.

        ``paths`` are parameter files for it. Raises UsageError for a node that is no controller or
        that no stack has.
        """
        made = self.table.spawner(controller)
        files = (word for path in paths for word in ("-p", path))
        return {**made, "arguments": [*made["arguments"], *files]}

    @checked
    def params(self, file: str, node: str) -> dict[str, Value]:
        """The parameters of a node in a rewritten parameter file of the fleet, by dotted names.

        ``node`` is its name in the stack or in the file. A node of a stack without a section gets an
        empty dict. Raises UsageError for an unknown node, and as ``text`` and
        ``LoadedFleet.parameters`` for the file.
        """
        document = self._read(file)
        known = node in self.table.nodes
        full = self.table.full_name(node) if known else self._placed(node)
        exact = exact_nodes(document)
        if not known and full not in exact:
            own = {it.removeprefix(f"/{self._graph}/").lstrip("/") for it in exact}
            raise UsageError(f"{file}: {unknown('node', node, own, self.table.nodes)}")
        return node_parameters(document, full)

    @checked
    def text(self, file: str) -> str:
        """This robot's version of a file of the fleet, such as ``params.yaml`` or ``bridge.yaml``.

        Raises as ``LoadedFleet.text``.
        """
        name = os.path.basename(file)
        own, shared = f"{self.name}/{name}", name
        return self._fleet.text(own if own in self._fleet.files else shared)

    @checked
    def frame(self, name: str) -> str:
        """This robot's name of a frame or link of the description; raises UsageError for a name
        that is not a str."""
        return spell(self._robot.names, "frame", name)

    @checked
    def joint(self, name: str) -> str:
        """This robot's name of a joint of the description; raises as ``frame``."""
        return spell(self._robot.names, "joint", name)

    @checked
    def topic(self, name: str) -> str:
        """This robot's absolute name of a single robot's topic ``name``; raises as ``frame``."""
        plan = self._fleet.plan
        known = fleet_topics(plan.fleet.table, plan.fleet.facts, self._graph)
        full = robot_topic(self._robot.topics, name, known)
        return full if full.startswith("/") else f"/{full}"

    @property
    def tf_remappings(self) -> Rules:
        """The remappings with which a node outside the stacks reads this robot's tf; raises nothing."""
        names = self._robot.topics
        targets = {
            f"/{it}": target_of(f"/{it}", TOPIC, self._graph, names.naming) for it in TF_TOPICS
        }
        return [(topic, target) for topic, target in targets.items() if target]

    @cached_property
    def _spawn(self) -> spawn.Spawn:
        made, _ = spawn.spawns(self._fleet.plan)
        return next(it for it in made if it.robot == self._graph)

    @property
    def spawn_arguments(self) -> list[str]:
        """``arguments`` of ``ros_gz_sim create``; raises nothing."""
        return spawn.gz_arguments(self._spawn)

    @property
    def classic_arguments(self) -> list[str]:
        """``arguments`` of ``gazebo_ros spawn_entity.py``; raises nothing."""
        return spawn.classic_arguments(self._spawn)

    @property
    def teleop_arguments(self) -> list[str]:
        """``arguments`` of ``teleop_twist_keyboard``; raises nothing."""
        return teleop.arguments(teleop.teleop(self._fleet.plan, self._robot))

    @property
    def transform_arguments(self) -> list[str]:
        """``arguments`` of the ``static_transform_publisher`` of its pose, empty if it needs none;
        raises nothing."""
        made = self._fleet.placed.transforms
        return next((start_poses.arguments(it) for it in made if it.robot == self._graph), [])

    @checked
    def start_parameters(self, node: str) -> dict[str, Any]:
        """Parameters with the start pose for ``node``, empty if it does not use them; raises as
        ``frame``."""
        made = self._fleet.placed.initial
        own = (it for it in made if it.robot == self._graph and it.node == node)
        return next((dict(it.values) for it in own), {})

    def _placed(self, node: str) -> str:
        apart = is_apart(node, self._fleet.planned.table.release)
        namespace, name = placed(self._graph, node, self._robot.topics.naming, apart)
        return f"{namespace.rstrip('/')}/{name}"

    def _read(self, file: str) -> YamlText:
        return self._fleet.parameters(f"{self.name}/{os.path.basename(file)}")


class LoadedFleet:
    """A fleet file, ready for a launch script; ``robots`` are in its order.

    ``findings`` are warnings about the descriptions and the remap table. It can be copied
    and pickled: the descriptions are included as they were read, other files are read again.
    """

    def __init__(self, plan: FleetPlan) -> None:
        self.plan = plan
        self.file: str = plan.file.file
        self.robots: tuple[LoadedRobot, ...] = tuple(LoadedRobot(self, it) for it in plan.robots)
        self.findings: tuple[Finding, ...] = _findings(plan)
        self._parameters: dict[str, YamlText] = {}

    def __repr__(self) -> str:
        return f"LoadedFleet({self.file!r})"

    def __reduce__(self) -> tuple[Callable[..., LoadedFleet], tuple[object, ...]]:
        return _planned, (self.plan.file, self.plan.jobs)

    @checked
    def robot(self, name: str) -> LoadedRobot:
        """The robot of this name; raises UsageError for another."""
        found = {it.name: it for it in self.robots}
        if name not in found:
            raise UsageError(f"{self.file}: {unknown('robot', name, found)}")
        return found[name]

    @cached_property
    def table(self) -> NodeNames:
        """Names and remappings of the nodes that serve all robots; raises nothing."""
        return names_of(self.planned.table, "")

    @cached_property
    def planned(self) -> Fleet:
        """The fleet with the nodes that publish start poses; raises nothing."""
        return with_start_pose_nodes(self.plan)

    @cached_property
    def placed(self) -> start_poses.StartPoses:
        """The start poses of its robots; raises nothing."""
        return start_poses.start_poses(self.plan)

    @cached_property
    def made(self) -> Outputs:
        """Everything that ``multibot build`` would write, made on first use.

        Raises InputError for a companion that cannot be read, RewriteRefused for one that cannot be
        rewritten.
        """
        made = make_outputs(self.plan)
        _refuse(made.findings)
        return made

    @cached_property
    def files(self) -> Mapping[str, OutputFile]:
        """The same files by path, such as ``robot1/params.yaml``; raises as ``made``."""
        return {it.path: it for it in self.made.files}

    @checked
    def text(self, path: str) -> str:
        """The text of one of these files; raises UsageError for an unknown path, else as ``made``."""
        if path not in self.files:
            _no_file(self, path)
        return self.files[path].data.decode()

    @checked
    def parameters(self, path: str) -> YamlText:
        """One of these files as a parameter file. Raises as ``text``, and InputError with the line of
        the source for values that rcl rejects."""
        if path not in self._parameters:
            text = self.text(path)
            for source in self.files[path].sources:
                check_values(read_yaml(read_file(source), source))
            self._parameters[path] = read_yaml(text.encode(), path)
        return self._parameters[path]


@checked
def load_fleet(
    path: str | os.PathLike[str] | Mapping[str, Any],
    *,
    trust: bool = False,
    distro: str = "",
    robots: str = "",
    count: int = 0,
) -> LoadedFleet:
    """Read a fleet file, rewrite its robots' descriptions and make their tables.

    ``path`` may be what a fleet file holds, as a dict; its paths are relative to the working directory.
    ``robots`` are the robots in place of those of the file, with their poses, as Nav2 writes them:
    ``robot1={x: 1.0, y: 0}; robot2={x: 2.0}``. ``count`` is the number of robots of the one that is a
    pattern.

    ``trust`` lets xacro files do anything; without it they only compute (SECURITY.md). ``distro``
    is the ROS 2 release whose facts count (default: the fleet file's, else ROS_DISTRO, else the newest
    LTS).

    Raises InputError and UsageError for what cannot be read or used, RewriteRefused if two
    robots would get the same name, VocabularyError and ProofError as ``rewrite`` does.
    """
    source = path if isinstance(path, Mapping) else os.fspath(path)
    file = read_fleet(source, distro, os.environ, Choice(robots, count))
    fleet = LoadedFleet(plan_fleet(file, trust=trust))
    _refuse(fleet.findings)
    return fleet


def _planned(file: FleetFile, jobs: Mapping[Sources, Jobs]) -> LoadedFleet:
    """The fleet of a pickle: rewritten again from the descriptions that it includes."""
    return LoadedFleet(plan_fleet(file, jobs=jobs))


def _findings(plan: FleetPlan) -> tuple[Finding, ...]:
    found = (it for robot in plan.robots for it in robot.findings)
    return tuple(dict.fromkeys((*found, *plan.fleet.table.problems)))


def _refuse(findings: Iterable[Finding]) -> None:
    wrong = tuple(it for it in findings if it.level == ERROR)
    if wrong:
        raise RewriteRefused(wrong)


def _no_file(fleet: LoadedFleet, path: str) -> NoReturn:
    hint = "list it under companions: in the fleet file"
    raise UsageError(f"{fleet.file}: {unknown('file', path, fleet.files)}; {hint}")
