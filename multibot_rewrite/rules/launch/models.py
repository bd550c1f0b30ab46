# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the models that a launch spawns, and with the rows of their bridges.

Two of one name, at one place, on one topic, or in a world that does not run what they need.

Source: ros_gz_sim jazzy create.cpp (``-name``, ``-x`` ... and ``-allow_renaming``); gz-sim8
src/systems/user_commands/UserCommands.cpp (an entity of a name that is there is not created);
src/ServerConfig.cc and src/SimulationRunner.cc (a world without any plugin gets those of
server.config: physics, user commands, scene broadcaster); src/systems/sensors and the systems of
other sensors."""

from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations
from math import dist
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.rosnames import resolve_bound
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.checks.shapes import filled_by
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.sources.world_systems import needed_systems
from multibot_rewrite.knowledge.worlds import DEFAULTS
from multibot_rewrite.planning.bridged_topics import DIRECTIONS, TF_TYPE
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.launch.bridges import bridged_by
from multibot_rewrite.producers.launch.launched import InSimulator, Launched, worlds
from multibot_rewrite.producers.launch.running import bound_of
from multibot_rewrite.rules.declaration import at, launch_rule
from multibot_rewrite.system.records import SUBSCRIBES, TOPIC

_POSE = ("-x", "-y", "-z")
# Two that stand nearer than this are in each other, whatever they are.
_NEAR = 0.01


@launch_rule("MG701", "model-name-twice")
def name_twice(launched: Launched) -> Iterator[Finding]:
    """Report models of one name, if nothing renames the second one."""
    first: dict[str, InSimulator] = {}
    for it in launched.simulated:
        other = first.setdefault(it.name, it)
        if other is not it and it.words.get("-allow_renaming") not in ("true", "1"):
            message = f"spawns a second model {it.name}"
            hint = f"give it a -name of its own; see {other.place}"
            yield at(name_twice, it.place, message, hint)


@launch_rule("MG702", "robots-in-each-other")
def in_each_other(launched: Launched) -> Iterator[Finding]:
    """Report models at one place; only URDF: a model in SDF may have a pose of its own."""
    models = [it for it in launched.simulated if it.root.tag == "robot"]
    placed = [(it, place, filled_by(it.root)) for it in models for place in _place_of(it)]
    level = ERROR if any(any(place) for _, place, _ in placed) else WARNING
    for (one, here, own), (other, there, reach) in combinations(placed, 2):
        if one.name != other.name and dist(here, there) < max(_NEAR, own + reach):
            where = ", ".join(other.words.get(it, "0") for it in _POSE)
            message = f"spawns {other.name} at the place of {one.name}, {where}"
            hint = f"move one with -x or -y; see {one.place}"
            yield at(in_each_other, other.place, message, hint)._replace(level=level)


def _place_of(it: InSimulator) -> Iterator[tuple[float, ...]]:
    """Yield where a model is spawned; nothing for what is no number."""
    with suppress(ValueError):
        yield tuple(float(it.words.get(key, 0)) for key in _POSE)


@launch_rule("MG703", "gz-topic-of-two-models")
def shared_topic(launched: Launched) -> Iterator[Finding]:
    """Report topics of two models, once for both; all robots' transforms may share one."""
    models = launched.simulated
    having: dict[str, list[int]] = defaultdict(list)
    shared: dict[tuple[int, int], list[str]] = defaultdict(list)
    for number, model in enumerate(models):
        names = (f"/{it.gz.lstrip('/')}" for it in model.topics if it.ros_type != TF_TYPE)
        for name in dict.fromkeys(names):
            for before in having[name]:
                shared[before, number].append(name)
            having[name].append(number)
    for (first, second), both in sorted(shared.items()):
        one, other = models[first], models[second]
        if one.name != other.name:
            message = f"{other.name} and {one.name} both have gz topic {shorten(both)}"
            hint = f"give each description topics of its own; see {one.place}"
            yield at(shared_topic, other.place, message, hint, names=tuple(both))


@launch_rule("MG704", "command-not-bridged")
def not_bridged(launched: Launched) -> Iterator[Finding]:
    """Yield the gz topics that a model reads and no bridge fills, if another model's is bridged."""
    for it, gz in _unbridged_topics(launched, inwards=True):
        message = f"{it.name} reads gz topic {gz}, and no bridge passes anything on to it"
        hint = "add a row to Gazebo for it, as another model has one"
        yield at(not_bridged, it.place, message, hint, names=(gz,))


@launch_rule("MG707", "data-not-bridged")
def not_brought(launched: Launched) -> Iterator[Finding]:
    """Report gz topics that no bridge brings to ROS, if it brings those of another model."""
    for it, gz in _unbridged_topics(launched, inwards=False):
        message = f"{it.name} sends gz topic {gz}, and no bridge brings it to ROS"
        hint = "add a row to ROS for it, as another model has one"
        yield at(not_brought, it.place, message, hint, names=(gz,))


def _unbridged_topics(launched: Launched, inwards: bool) -> Iterator[tuple[InSimulator, str]]:
    """Yield the topics of models that no bridge has, where one has that of another model."""
    told = {it.gz for it in _bridge_rows(launched) if it.inwards is inwards}
    every = [
        (model, (it.ros_type, f"/{it.gz.lstrip('/')}"))
        for model in launched.simulated
        for it in model.topics
        if (it.direction == DIRECTIONS["out"]) is inwards
    ]
    alike = {_topic_without_robot(model, one) for model, one in every if one[1] in told}
    for model, one in every:
        if one[1] not in told and _topic_without_robot(model, one) in alike:
            yield model, one[1]


def _topic_without_robot(model: InSimulator, topic: tuple[str, str]) -> tuple[str, str]:
    """Return a topic of a model without its name, and without the namespace of its description."""
    kind, gz = topic
    own = {model.name, *model.words.get("-topic", "").strip("/").split("/")[:-1]}
    return kind, "/".join(word for word in gz.split("/") if word not in own)


@launch_rule("MG706", "world-without-system")
def without_system(launched: Launched) -> Iterator[Finding]:
    """Yield the systems that a world does not load and no robot brings."""
    models = launched.simulated
    roots = [it.root for it in models]
    brought = {_system_name(it.get("filename", "")) for root in roots for it in root.iter("plugin")}
    for world in worlds(launched):
        found = list(world.root.iterfind("world/plugin"))
        there = {_system_name(it.get("filename", "")) for it in found} if found else set(DEFAULTS)
        for system, why in needed_systems((it.name, it.root) for it in models):
            if system not in {*there, *brought}:
                message = f"world {world.file} does not load the system {system}: {why}"
                hint = f'add <plugin filename="gz-sim-{system}-system" .../> to the world'
                yield at(without_system, world.place, message, hint)


def _system_name(library: str) -> str:
    return library_key(library).removeprefix("gz-sim-").removesuffix("-system")


class _Row(NamedTuple):
    """A row of a bridge: the name in ROS and in Gazebo, whether it goes to Gazebo, who has it."""

    ros: str
    gz: str
    inwards: bool
    node: Run


def _bridge_rows(launched: Launched) -> Iterator[_Row]:
    for it in launched.nodes:
        for end, inside in bridged_by(it):
            # A node with a name that ROS refuses does not start.
            with suppress(UsageError):
                if end.kind == TOPIC:
                    bound = bound_of(it.name, it.namespace, it.rules)
                    full = resolve_bound(end.name, end.kind, bound)
                    yield _Row(full, inside, end.role == SUBSCRIBES, it)


@launch_rule("MG705", "bridge-to-another-robot")
def to_another_robot(launched: Launched) -> Iterator[Finding]:
    """Report bridges to another robot's topics, by the models' names in the topics."""
    models = launched.simulated
    called = {it.name: {it.name, *it.words.get("-topic", "").split("/")} - {""} for it in models}
    sent = {(f"/{one.gz.lstrip('/')}", it.name) for it in models for one in it.topics}
    of_several = Counter(topic for topic, _ in sent)
    # A topic that models share, such as one tf for all, is of none of them.
    owners = {topic: name for topic, name in sent if of_several[topic] == 1}
    names = {it.name for it in models if it.topics}
    rows = [it for it in _bridge_rows(launched) if owners.get(it.gz) and len(names) > 1]
    spaces = {word for it in launched.nodes for word in it.namespace.split("/") if word}
    usual = {_plain_row(it, owners[it.gz]) for it in rows if owners[it.gz] in it.ros.split("/")}
    for it in rows:
        own, words = owners[it.gz], set(it.ros.split("/"))
        # A word that both sides have says no other robot, whatever else is called so.
        others = sorted(names & words - {*it.gz.split("/"), *called[own]})
        if others and words.isdisjoint(called[own]):
            message = f"{it.ros} of {others[0]} is bridged to gz topic {it.gz} of {own}"
        elif not words & {own, *spaces} and _plain_row(it, own) in usual:
            message = f"{it.ros} is bridged to gz topic {it.gz} of {own}, and has no robot's name"
        else:
            continue
        hint = f"write the name of {own} on both sides"
        yield at(to_another_robot, it.node.place, message, hint, names=(it.ros,))


def _plain_row(row: _Row, own: str) -> tuple[str, str]:
    """Return the names of a row without the robot's name."""
    ros, gz = ("/".join(w for w in it.split("/") if w != own) for it in (row.ros, row.gz))
    return ros, gz
