# SPDX-License-Identifier: Apache-2.0
"""``relayed`` of a fleet file: each robot's tf on ``/tf``, too, so that one RViz shows all robots.

Where frames differ, a ``relay`` of topic_tools for tf and one for tf_static, for each robot. It takes
QoS from what it reads, so tf_static stays latched. Source: topic_tools src/relay_node.cpp,
src/tool_base_node.cpp.
Where they have the same names, husarion's tf_namespace_bridge: it runs in the robot's namespace, reads
``tf`` and ``tf_static`` there, and puts that namespace before every frame, the world's too: a static
transform joins that to the world of the fleet. Source: tf_namespace_bridge
src/tf_namespace_bridge.cpp, launch/tf_namespace_bridge.yaml, CMakeLists.txt (41881734b).
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, Naming
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.bridged_topics import TF_TYPE
from multibot_rewrite.planning.of_runs import placed, target_of
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.start import Start
from multibot_rewrite.related_files.rviz.rewrite import world_frame
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, Origin, Place

BRIDGE, _WORLD = "tf_namespace_bridge", "bridged_world"
_RELAY, _STATIC = ("topic_tools", "relay"), ("tf2_ros", "static_transform_publisher")
_FIXED = "the parameters input_topic and output_topic say its names"
_IN_CODE = "its code says its names"


class Relay(NamedTuple):
    """A node that brings tf of one robot to ``/tf``, and its process."""

    run: Run
    start: Start


def relays(robot: str, naming: Naming, file: FleetFile) -> list[Relay]:
    """Return the relays of a robot (its namespace), if the fleet file asks for them."""
    if not file.relayed:
        return []
    copied = naming.layout.frames
    return [*(_relays_to_tf(robot, naming) if copied else _bridges(robot, naming, file.world))]


def _relays_to_tf(robot: str, naming: Naming) -> Iterator[Relay]:
    above = f"/{robot}" if naming.topics == NAMESPACE else ""
    for topic in TF_TOPICS:
        node = f"{topic}_relay"
        target = target_of(f"/{topic}", TOPIC, robot, naming)
        source = f"{above}/{target.lstrip('/')}"
        told = {"input_topic": source, "output_topic": f"/{topic}"}
        run = _relay_run(robot, node, naming, (source,), (f"/{topic}",), _FIXED)
        yield Relay(run, Start(*_RELAY, run.namespace, run.name, (told,)))


def _bridges(robot: str, naming: Naming, world: str) -> Iterator[Relay]:
    """Yield the relays of tf to ``/tf``, and of the world frame."""
    reads, writes = (tuple(f"{above}/{it}" for it in TF_TOPICS) for above in (f"/{robot}", ""))
    run = _relay_run(robot, BRIDGE, naming, reads, writes, _IN_CODE)
    yield Relay(run, Start(BRIDGE, BRIDGE, run.namespace, run.name, needs=BRIDGE))
    if frame := world or world_frame(naming):
        words = ("--frame-id", frame, "--child-frame-id", f"{robot}/{frame}")
        run = _relay_run(robot, _WORLD, naming, (), writes[1:], _IN_CODE)
        start = Start(*_STATIC, run.namespace, run.name, arguments=words, needs=BRIDGE)
        yield Relay(run, start)


def not_bridged(robot: str) -> str:
    """Return the message if the bridge is not installed: a relay would merge all robots' frames."""
    why = f"{BRIDGE} is not installed, so the tf of {robot} is not on /tf"
    return f"{why}: install it, or take layout both"


def _relay_run(
    robot: str, node: str, naming: Naming, reads: Iterable[str], writes: Iterable[str], why: str
) -> Run:
    """Return a node with topics of these full names; ``why`` no remap rule changes them."""
    ends = ((role, it) for role, own in ((SUBSCRIBES, reads), (PUBLISHES, writes)) for it in own)
    names = ((Endpoint(TOPIC, role, it, TF_TYPE, fixed=why), it) for role, it in ends)
    origin = Origin(place=Place("relayed of the fleet file"))
    fact = NodeFacts(node, "", (), origin=origin)
    return Run(robot, node, *placed(robot, node, naming), (), fact, names=tuple(names))


def with_relays(fleet: Fleet, file: FleetFile) -> Fleet:
    """Return the fleet with the relays that its file asks for; raises as ``check_relayed``."""
    if not file.relayed:
        return fleet
    # Raises UsageError for a layout whose tf need not be relayed to one topic, or cannot be.
    layout, place = fleet.naming.layout, f"{file.file}: relayed"
    if not layout.tf_per_robot:
        raise UsageError(
            f"{place}: layout {layout.name} has one /tf for all robots; remove relayed"
        )
    if not layout.frames and fleet.naming.topics != NAMESPACE:
        what = f"{BRIDGE} reads tf in the robot's namespace, and topics: {fleet.naming.topics} moves it"
        raise UsageError(f"{place}: {what}; remove topics, or take layout both")
    made = [it for spec in file.robots for it in relays(spec.namespace, fleet.naming, file)]
    runs = (*fleet.table.runs, *(it.run for it in made))
    return fleet._replace(table=fleet.table._replace(runs=runs))
