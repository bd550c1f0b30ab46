"""Rules that a node needs and does not get where they stand, by release."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from functools import cache, partial

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.rosnames import resolve_bound
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.spelling.applied_rules import (
    RunningNode,
    bound_to,
    is_stand_in,
    running_nodes,
)
from multibot_rewrite.spelling.records import EndpointName, Table
from multibot_rewrite.spelling.ways import PLUGIN
from multibot_rewrite.system.records import ACTION, PUBLISHES, TOPIC

# A second robot shows what rules for all of a process do.
ENOUGH = 2
NOT_TAKEN = declare(
    "MR105",
    "rule-not-taken",
    WARNING,
    what="A node does not get a rule that it needs: in this release nothing hands the rule on to it "
    "from the place where it stands.",
    why="The node keeps the name in its code, and all robots share it. From ros2_control 6.5 on "
    "(Lyrical) controllers get no rules of their controller manager, so none of a gz_ros2_control "
    "plugin. On Humble all controllers in one Gazebo get those of the first robot's plugin.",
    fix="Name the stack of the controllers (--stack gz_ros2_control), and start each with its spawner: "
    "its line is in commands.md, and multibot plan --form ros-args prints it.",
    bad="""\
<robot name="rover">
  <link name="base_link"/>
  <gazebo>
    <plugin name="control" filename="gz_ros2_control-system">
      <ros>
        <remapping>~/odom:=odom</remapping>
      </ros>
    </plugin>
  </gazebo>
</robot>
""",
    good="""\
<robot name="rover">
  <link name="base_link"/>
  <gazebo>
    <plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">
      <left_joint>left</left_joint>
      <right_joint>right</right_joint>
    </plugin>
  </gazebo>
</robot>
""",
    line=6,
    formats=("remap-urdf",),
    options={"robots": ("robot1", "robot2"), "layout": "tf-per-robot"},
)


def not_taken(table: Table) -> Iterator[Finding]:
    """Names of the code or of another robot that a node has because its rule does not reach it.

    One finding a node. What a plugin's controllers are known to publish is for the judge of the
    description, who says it where no stack names them (MB435).
    """
    of_manager = controller_way(table.release).of_manager
    some = _of_robots(table, _robots_worth_a_look(table))
    names: dict[tuple[str, str], list[EndpointName]] = {}
    for it in some.names:
        if not (it.endpoint.fixed or it.endpoint.when):
            names.setdefault((it.robot, it.node), []).append(it)
    owners = cache(partial(_owners, table))
    for running in _worth_a_look(some):
        plain = tuple((it.source, it.target) for it in running.node.rules)
        if running.node.home.process_wide or running.rules != plain:
            own = names.get((running.node.robot, running.node.full_name), ())
            if running.node.home.process_wide and not of_manager:
                own = [it for it in own if it.endpoint.role != PUBLISHES]
            wrong = dict.fromkeys(_wrong(own, running, owners))
            if wrong:
                yield _finding(running, list(wrong), table.release)


def _robots_worth_a_look(table: Table) -> set[str]:
    """Those of which descriptions decide something, and the first with each of the stack's nodes."""
    first: dict[str, set[str]] = {}
    found = {""}
    for it in table.nodes:
        robots = first.setdefault(it.node, set())
        if len(robots) < ENOUGH or it.home.plugin or it.home.is_controller:
            robots.add(it.robot)
            found.add(it.robot)
    return found


def _of_robots(table: Table, robots: Set[str]) -> Table:
    return table._replace(
        nodes=tuple(it for it in table.nodes if it.robot in robots),
        names=tuple(it for it in table.names if it.robot in robots),
    )


def _owners(table: Table) -> dict[str, set[str]]:
    """The robots that have each name."""
    owners: dict[str, set[str]] = {}
    for it in table.names:
        owners.setdefault(it.name, set()).add(it.robot)
    return owners


def _worth_a_look(table: Table) -> Iterator[RunningNode]:
    """What descriptions decide, of all robots; of the stack's nodes, which all have alike, two."""
    seen: Counter[str] = Counter()
    for it in running_nodes(table):
        seen[it.node.node] += 1
        if it.node.home.plugin or it.node.home.is_controller or seen[it.node.node] <= ENOUGH:
            yield it


def _wrong(
    names: Iterable[EndpointName],
    running: RunningNode,
    owners: Callable[[], Mapping[str, set[str]]],
) -> Iterator[str]:
    """Those called otherwise than the table says: as in the code, or like something of a robot."""
    node = running.node
    own, theirs, bare = (bound_to(node, it) for it in (running.rules, running.handed_on, ()))
    for it in names:
        kind = TOPIC if it.endpoint.kind == ACTION else it.endpoint.kind
        given = theirs if is_stand_in(node, it.endpoint) else own
        found = resolve_bound(it.endpoint.name, kind, given)
        if found == it.name:
            continue
        is_bare = found == resolve_bound(it.endpoint.name, kind, bare)
        if is_bare or node.robot not in owners().get(found, {node.robot}):
            yield it.endpoint.name


def _finding(running: RunningNode, kept: list[str], release: str) -> Finding:
    node, names = running.node, ", ".join(kept)
    message = f"on {release} no rule reaches it for {names}, though one is written"
    hint = f"give its rules to the process of {node.home.host or node.name}"
    if node.home.process_wide and controller_way(release).spawner:
        message = f"on {release} its controllers do not get its rules for {names}"
        hint = "name their stack, and start each with its spawner's --controller-ros-args"
    elif running.way == PLUGIN:
        message = f"on {release} it gets the rules of the first robot alone, none for {names}"
        hint = "give each robot a namespace, with --topics namespace"
    place = {"robot": node.robot, "node": node.node, "names": tuple(kept)}
    return NOT_TAKEN.finding(message, hint, **place)
