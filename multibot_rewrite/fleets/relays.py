"""``relayed`` of a fleet file: each robot's tf on ``/tf``, too, so that one RViz shows all robots.

A ``relay`` of topic_tools for tf and one for tf_static, for each robot. It takes QoS from what it
reads, so tf_static stays latched. Source: topic_tools src/relay_node.cpp, src/tool_base_node.cpp.
husarion's tf_namespace_bridge puts the robot's namespace before each frame, so it is for the layout
in which frames have the same names (tf_namespace_bridge src/tf_namespace_bridge.cpp).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_file import FleetFile
from multibot_rewrite.model import UsageError
from multibot_rewrite.naming import NAMESPACE, TF_TOPICS, Naming
from multibot_rewrite.remap.bridged_topics import TF_TYPE
from multibot_rewrite.remap.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Endpoint,
    EndpointName,
    NodeTable,
)
from multibot_rewrite.remap.targets import placed, target_of

PACKAGE, EXECUTABLE = "topic_tools", "relay"
_FIXED = "the parameters input_topic and output_topic say its names"


class Relay(NamedTuple):
    """A relay of one robot: its node as the table has it, the topic it reads, the one it writes."""

    table: NodeTable
    source: str
    target: str

    @property
    def parameters(self) -> dict[str, str]:
        """What it is told."""
        return {"input_topic": self.source, "output_topic": self.target}


def check_relayed(file: FleetFile, naming: Naming) -> None:
    """Raises UsageError for a layout whose tf cannot be relayed to one topic, or need not be."""
    layout, place = naming.layout, f"{file.file}: relayed"
    if not layout.tf_per_robot:
        raise UsageError(
            f"{place}: layout {layout.name} has one /tf for all robots; remove relayed"
        )
    if not layout.frames:
        what = f"in layout {layout.name} frames of all robots have the same names"
        hint = (
            "take layout both, or start tf_namespace_bridge of Husarion for each robot by yourself"
        )
        raise UsageError(f"{place}: {what}, so on one /tf they would be one robot; {hint}")


def relays(robot: str, naming: Naming) -> Iterator[Relay]:
    """The relays of a robot (its namespace)."""
    for topic in TF_TOPICS:
        node = f"{topic}_relay"
        namespace, name = placed(robot, node, naming)
        target = target_of(f"/{topic}", TOPIC, robot, naming)
        above = f"/{robot}" if naming.topics == NAMESPACE else ""
        table = NodeTable(robot, node, namespace, name, ())
        yield Relay(table, f"{above}/{target.lstrip('/')}", f"/{topic}")


def with_relays(fleet: Fleet, file: FleetFile) -> Fleet:
    """The fleet with the relays that its file asks for; raises as ``check_relayed``."""
    if not file.relayed:
        return fleet
    check_relayed(file, fleet.naming)
    made = [it for spec in file.robots for it in relays(spec.namespace, fleet.naming)]
    table = fleet.table
    nodes = (*table.nodes, *(it.table for it in made))
    names = (*table.names, *(name for it in made for name in _names(it)))
    origins = {it.table.full_name: "relayed of the fleet file" for it in made}
    return fleet._replace(
        table=table._replace(nodes=nodes, names=names), origins={**fleet.origins, **origins}
    )


def _names(relay: Relay) -> Sequence[EndpointName]:
    robot, node = relay.table.robot, relay.table.full_name
    ends = ((SUBSCRIBES, relay.source), (PUBLISHES, relay.target))
    return [
        EndpointName(robot, node, Endpoint(TOPIC, role, name, TF_TYPE, fixed=_FIXED), name)
        for role, name in ends
    ]
