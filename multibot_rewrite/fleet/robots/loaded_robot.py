# SPDX-License-Identifier: Apache-2.0
"""One robot of a fleet, for launch scripts: what its nodes, simulator and tf need, as plain values."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from tempfile import TemporaryDirectory
from typing import Any, Protocol

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs import spawn, teleop
from multibot_rewrite.fleet.outputs.moveit_parameters import move_group_parameters
from multibot_rewrite.fleet.outputs.output_file import OutputFile, params_paths
from multibot_rewrite.fleet.outputs.relays import Relay, relays
from multibot_rewrite.fleet.robots import start_poses
from multibot_rewrite.fleet.robots.node_names import NodeNames, Rules, names_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_nodes import nodes_of_sets
from multibot_rewrite.knowledge.node_sets import is_apart
from multibot_rewrite.knowledge.programs import Program, started_as
from multibot_rewrite.planning.of_runs import placed, target_of
from multibot_rewrite.related_files.names.node_topics import fleet_topics, robot_topic
from multibot_rewrite.related_files.names.rename_map import KINDS, spell
from multibot_rewrite.related_files.params.rcl_parameters import (
    exact_nodes,
    node_parameters,
    parameters_text,
)
from multibot_rewrite.related_files.yaml_text import YamlText
from multibot_rewrite.system.parameters import Value
from multibot_rewrite.system.records import TOPIC


class KeptFiles:
    """Files in a folder that is made with the first of them, and goes when the process ends."""

    def __init__(self) -> None:
        self._folder: TemporaryDirectory[str] | None = None

    def path(self, robot: str, file: str, text: str) -> str:
        """Return the path of a robot's file with this text; raises OSError if none can be written."""
        if self._folder is None:
            self._folder = TemporaryDirectory(prefix="multibot_")
        path = os.path.join(self._folder.name, robot, os.path.basename(file))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as out:
            out.write(text.encode())
        return path


class OfFleet(Protocol):
    """What a robot asks of its fleet, which is ``scripts.LoadedFleet``."""

    plan: FleetPlan
    kept: KeptFiles

    @property
    def planned(self) -> Fleet:
        """Return the fleet with its plan."""

    @property
    def placed(self) -> start_poses.StartPoses:
        """Return where each robot starts."""

    @property
    def files(self) -> Mapping[str, OutputFile]:
        """Return the files that a build writes, by path."""

    def text(self, path: str) -> str:
        """Return the text of a file of the build."""

    def node_text(self, path: str) -> str:
        """Return the text of a parameter file for nodes that are started one by one."""

    def parameters(self, path: str) -> YamlText:
        """Return a parameter file of the build as parsed YAML."""

    def robot(self, name: str) -> LoadedRobot:
        """Return the robot of that name."""


class LoadedRobot:
    """One robot of a fleet: what its nodes, its simulator and its tf need, as plain values.

    ``namespace`` is absolute; ``tag`` is the prefix or postfix of its frames and joints; ``pose``
    is None if the fleet file has none; ``node_set`` are the nodes of its node sets. It can be copied
    and pickled, with its fleet."""

    def __init__(self, fleet: OfFleet, robot: RewrittenRobot) -> None:
        self._fleet, self._robot = fleet, robot
        spec = robot.spec
        self._graph = spec.namespace
        self.name: str = spec.name
        self.model: str = spec.model
        self.tag: str = spec.tag
        self.pose: Pose | None = spec.pose
        self.use_sim_time: bool | None = spec.use_sim_time
        self.distro: str = fleet.plan.file.distro
        nodes = nodes_of_sets(spec, fleet.plan.file)
        self.node_set: tuple[str, ...] = tuple(it.name for it in nodes)
        namespaced = robot.topics.naming.topics == NAMESPACE
        self.namespace: str = f"/{spec.namespace}" if namespaced else "/"

    def __repr__(self) -> str:
        return f"LoadedRobot({self.name!r})"

    def __reduce__(self) -> tuple[Callable[..., LoadedRobot], tuple[object, ...]]:
        return type(self._fleet).robot, (self._fleet, self.name)

    @property
    @checked
    def params_files(self) -> tuple[str, ...]:
        """The names of its parameter files, if any; raises as ``LoadedFleet.made``."""
        # Those of the fleet file, else ``params.yaml``.
        return tuple(map(os.path.basename, params_paths(self._robot, self._fleet.files)))

    @property
    def description(self) -> str:
        """The robot's rewritten description, for ``robot_description``; raises nothing."""
        return self._robot.description.decode()

    @property
    def description_parameters(self) -> dict[str, Any]:
        """The parameters of its robot_state_publisher, with ``frame_prefix``; raises nothing."""
        prefix = self._robot.frame_prefix
        given = {"robot_description": self.description}
        return {**given, "frame_prefix": prefix} if prefix else given

    @property
    def srdf(self) -> str:
        """The robot's rewritten SRDF, empty if it has none; raises nothing."""
        return self._robot.srdf.decode()

    def to_dict(self) -> dict[str, Any]:
        """Return move_group's parameters as moveit_configs_utils does; raises as ``text``."""
        files = self._robot.spec.related_files.get("moveit", ())
        texts = {it: self.text(it) for it in files}
        return move_group_parameters(self.description, self.srdf, texts)

    @cached_property
    def table(self) -> NodeNames:
        """Names and remappings of its nodes, as ``table.for_node("amcl")``; raises nothing."""
        return names_of(self._fleet.planned.table, self._graph)

    @checked
    def node(self, node: str, *files: str) -> dict[str, Any]:
        """Return what ``Node(**...)`` takes for a node of its node sets.

        ``files`` are parameter files of the fleet; amcl also gets its start pose, and each node
        the clock of the fleet file. If other nodes run in its process, such as costmaps or
        components, these are paths of files, deleted with this process: only files reach them.
        Raises UsageError for a node that no node set has and for a controller (``spawner``), and
        as ``params`` for a file."""
        clock = {} if self.use_sim_time is None else {"use_sim_time": self.use_sim_time}
        given: list[Any] = [self.params(file, node) for file in files]
        if self.table.inside(node):
            given = [self._fleet.kept.path(self.name, it, self.node_text(it)) for it in files]
            text = parameters_text({"/**": clock})
            given += [self._fleet.kept.path(self.name, "clock.yaml", text)] if clock else []
            clock = {}
        return {
            "name": self.table.name(node),
            "namespace": self.table.namespace(node),
            "remappings": self.table.for_node(node),
            "parameters": [it for it in (*given, self.start_parameters(node), clock) if it],
        }

    @checked
    def spawner(self, controller: str, *paths: str) -> dict[str, Any]:
        """Return what ``Node(**...)`` takes to load a controller with parameter files.

        Raises UsageError for a node that is no controller or that no node set has."""
        made = self.table.spawner(controller)
        files = (word for path in paths for word in ("-p", path))
        return {**made, "arguments": [*made["arguments"], *files]}

    @checked
    def program(self, node: str) -> Program | None:
        """Return what is started for a node, its class if a component; None if no source says it.

        Raises UsageError for a node that no node set has."""
        self.table.name(node)
        runs = self._fleet.plan.evidence_of(self._robot).nodes
        facts = next((it for it in runs if it.name == node), None)
        return facts and started_as(facts, self.distro)

    @checked
    def params(self, file: str, node: str) -> dict[str, Value]:
        """Return a node's parameters in a rewritten parameter file, by dotted names.

        ``node`` is its name in the node set or in the file. A node of a node set without a
        section gets an empty dict. Raises UsageError for an unknown node, and as ``text`` and
        ``LoadedFleet.parameters`` for the file."""
        document = self._fleet.parameters(self._own_path(file))
        known = node in self.table.nodes
        release, naming = self._fleet.planned.table.release, self._robot.topics.naming
        above, name = placed(self._graph, node, naming, is_apart(node, release))
        full = self.table.full_name(node) if known else f"{above.rstrip('/')}/{name}"
        exact = exact_nodes(document)
        if not known and full not in exact:
            own = {it.removeprefix(f"/{self._graph}/").lstrip("/") for it in exact}
            raise UsageError(f"{file}: {unknown('node', node, own, self.table.nodes)}")
        return node_parameters(document, full)

    @checked
    def text(self, file: str) -> str:
        """Return the robot's text of a file such as ``params.yaml``; raises as ``LoadedFleet.text``."""
        return self._fleet.text(self._path_in_build(file))

    @checked
    def node_text(self, file: str) -> str:
        """Return a parameter file for nodes started here, with full names; raises as ``text``."""
        return self._fleet.node_text(self._path_in_build(file))

    def _path_in_build(self, file: str) -> str:
        name = os.path.basename(file)
        own = self._own_path(file)
        return own if own in self._fleet.files else name

    def _own_path(self, file: str) -> str:
        """Return where the robot's version of a file is; the folder decides between two of one name."""
        *_, above, name = ("", *os.path.normpath(file).split(os.sep))
        places = dict(self._robot.spec.places)
        paths = [f"{self.name}/{places.get(it, it)}" for it in (f"{above}/{name}", name)]
        return next((it for it in paths if it in self._fleet.files), paths[-1])

    @checked
    def frame(self, name: str) -> str:
        """Return the robot's name of a link or sent frame; raises UsageError for another."""
        runs = self._fleet.plan.evidence_of(self._robot).nodes
        sent = (it.default for node in runs for it in node.frames)
        return self._own_name("frame", name, (*SENT_FRAMES, *sent))

    @checked
    def link(self, name: str) -> str:
        """Return this robot's name of a link of the description; raises UsageError for another name."""
        return self._own_name("link", name)

    @checked
    def joint(self, name: str) -> str:
        """Return this robot's name of a joint of the description; raises as ``link``."""
        return self._own_name("joint", name)

    def _own_name(self, word: str, name: str, more: Iterable[str] = ()) -> str:
        """Return the robot's version of a name that the description or ``more`` has."""
        names = self._robot.names
        described = [it for kind in KINDS[word] for it in names.declared.get(kind, ())]
        if name not in {*described, *more}:
            raise UsageError(f"robot {self.name!r}: {unknown(word, name, described, more)}")
        return spell(names, word, name)

    @checked
    def topic(self, name: str) -> str:
        """Return this robot's absolute name of a single robot's topic ``name``; raises as ``frame``."""
        plan = self._fleet.plan
        known = fleet_topics(plan.fleet.table, plan.fleet.facts, self._graph)
        full = robot_topic(self._robot.topics, name, known)
        return full if full.startswith("/") else f"/{full}"

    @property
    def tf_remappings(self) -> Rules:
        """The remappings with which another node reads its tf; raises nothing."""
        names = self._robot.topics
        targets = {
            f"/{it}": target_of(f"/{it}", TOPIC, self._graph, names.naming) for it in TF_TOPICS
        }
        return [(topic, target) for topic, target in targets.items() if target]

    @property
    def relays(self) -> dict[str, Relay]:
        """The relays of its tf to ``/tf`` by name, if the fleet asks for them; raises nothing."""
        made = relays(self._graph, self._robot.topics.naming, self._fleet.plan.file)
        return {it.run.node: it for it in made}

    @cached_property
    def _spawn(self) -> spawn.Spawn:
        made, _ = spawn.spawns(self._fleet.plan)
        return next(it for it in made if it.robot == self._graph)

    @property
    def spawn_arguments(self) -> list[str]:
        """``arguments`` of ``ros_gz_sim create``; raises nothing."""
        return spawn.spawner(self._spawn._replace(text=self._robot.simulated.decode()), False).words

    @property
    def classic_arguments(self) -> list[str]:
        """``arguments`` of ``gazebo_ros spawn_entity.py``; raises nothing."""
        return spawn.spawner(self._spawn, True).words

    @property
    def teleop_arguments(self) -> list[str]:
        """``arguments`` of ``teleop_twist_keyboard``; raises nothing."""
        return teleop.teleop(self._fleet.plan, self._robot).start.words

    @property
    def transform_arguments(self) -> list[str]:
        """Arguments of its pose's ``static_transform_publisher``, if it needs one; raises nothing."""
        made = self._fleet.placed.transforms
        return next((it.start.words for it in made if it.robot == self._graph), [])

    @checked
    def start_parameters(self, node: str) -> dict[str, Any]:
        """Return ``node``'s parameters with the start pose, if it has them; raises as ``frame``."""
        made = self._fleet.placed.initial
        own = (it for it in made if it.robot == self._graph and it.node == node)
        return next((dict(it.values) for it in own), {})
