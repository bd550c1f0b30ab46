"""Rules about names of the wrong robot: those that belong to no robot, and another robot's."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator

from multibot_rewrite.findings.finding import ERROR, Finding
from multibot_rewrite.graph.wording import SEVERAL, shorten
from multibot_rewrite.rules.declaration import graph_rule
from multibot_rewrite.rules.pair.causes import (
    DOES,
    Cause,
    caused,
    how_to_pass,
    names_without_rules,
    plugin_of,
    why_not_remapped,
)
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.rules.pair.tf_copies import copying_nodes
from multibot_rewrite.system.conventions import EVERYBODYS, LISTENER
from multibot_rewrite.system.records import SUBSCRIBES, TOPIC, End


@graph_rule(
    "MG103",
    "leaked-name",
    ERROR,
    drawn="leak",
    what="A robot's node uses a name that belongs to no robot and is not shared, or its tf"
    " listener subscribes to the global `/tf`.",
    why="The same node of another robot uses the name too: one command moves both robots, and"
    " their scans are mixed.",
    fix="Pass the remap rule of the hint; for a tf listener pass it to the whole process. If all"
    " robots are to share the name, add it to `shared_topics` of the plan (`--shared-topics`).",
    bad="""\
planned: /robot1/driver
running: /robot1/driver subscribes /cmd_vel
""",
    good="""\
planned: /robot1/driver
running: /robot1/driver subscribes /robot1/cmd_vel
""",
    line=2,
)
def leaked_name(view: View) -> Iterator[Finding]:
    """All robots meet at such a name."""
    yield from _unplanned_leaks(view)
    yield from _planned_leaks(view)
    yield from _wrong_tf_listeners(view)


def _unplanned_leaks(view: View) -> Iterator[Finding]:
    shared = {*view.plan.shared_topics, *EVERYBODYS}
    not_remapped = _missing_by_name_without_rules(view)
    for node, robot in view.robot_of.items():
        for name in dict.fromkeys(e.name for e in view.unplanned_endpoints.get(node, ())):
            if name in shared or view.ownership.robot(name):
                continue
            message = (
                f"uses {name}, which is not a name of {robot}: the same node of another robot uses"
                " it too"
            )
            cause = _why_leaked(view, node, name, not_remapped.get((node, name)))
            yield leaked_name.finding(
                message, **cause._asdict(), robot=robot, node=node, names=(name,)
            )


def _missing_by_name_without_rules(view: View) -> dict[tuple[str, str], End]:
    """The planned endpoints that are missing, by node and the name they have without a rule."""
    return {
        (planned.node, name): planned
        for planned in view.missing.values()
        if planned.node in view.robot_of
        for name in names_without_rules(view, planned)
    }


def _why_leaked(view: View, node: str, name: str, planned: End | None) -> Cause:
    if planned:
        return why_not_remapped(view, planned)
    plugin, place = plugin_of(view, node)
    if plugin:
        return caused(f"{plugin} has no namespace or remap rule for it, see {place}", place)
    robot = view.robot_of[node]
    target = f"{name}/{robot}" if view.ownership.robot_is_last else f"/{robot}{name}"
    rule = how_to_pass(view, node, f"{name}:={target}")
    return Cause(f"an absolute name in its code or parameters; pass {rule}")


def _planned_leaks(view: View) -> Iterator[Finding]:
    """A name that the plan itself has for several robots, because no remap rule changes it."""
    shared = {*view.plan.shared_topics, *EVERYBODYS, *_shared_tf(view)}
    nodes: dict[str, dict[str, None]] = defaultdict(dict)
    relays = copying_nodes(view.plan)
    for key in view.planned:
        node, _, _, name = key
        if name in view.ownership.exact or name in shared or node not in view.robot_of:
            continue
        if not view.ownership.robot(name) and key in view.types and node not in relays:
            nodes[name][node] = None
    for name, users in nodes.items():
        robots = dict.fromkeys(view.robot_of[node] for node in users)
        for node in users if len(robots) > 1 else ():
            listed = shorten(robots, SEVERAL)
            message = f"uses {name}, which the plan has for several robots: {listed}"
            cause = "no remap rule changes it: set the node's parameter, or add it to shared_topics"
            yield leaked_name.finding(
                message, cause, robot=view.robot_of[node], node=node, names=(name,)
            )


def _shared_tf(view: View) -> set[str]:
    """The tf topics that robots share in their layout."""
    times = Counter(robot.tf_topic for robot in view.plan.robots)
    return {f"{tf}{end}" for tf, count in times.items() if count > 1 for end in ("", "_static")}


def _wrong_tf_listeners(view: View) -> Iterator[Finding]:
    """A tf listener in a robot's namespace that subscribes to /tf, which is not the robot's."""
    home = {robot.name: robot.tf_topic for robot in view.plan.robots}
    for node in view.seen:
        robot = view.ownership.robot(node) if f"/{LISTENER}" in node else ""
        if robot and home[robot] != "/tf" and (node, TOPIC, SUBSCRIBES, "/tf") in view.types:
            message = f"this tf listener subscribes to /tf, but tf of {robot} is on {home[robot]}"
            cause = "pass the rule /tf:=tf to its whole process or container, not to one node in it"
            yield leaked_name.finding(message, cause, robot=robot, node=node, names=("/tf",))


@graph_rule(
    "MG104",
    "cross-talk",
    ERROR,
    drawn="cross-talk",
    what="A robot's node uses a name of another robot.",
    why="One robot is driven or localized with the data of the other.",
    fix="Correct the remap rule or parameter that has the name of the other robot.",
    bad="""\
as planned: /robot2/driver subscribes /robot2/cmd_vel
planned: /robot1/planner
running: /robot1/planner publishes /robot2/cmd_vel
""",
    good="""\
as planned: /robot2/driver subscribes /robot2/cmd_vel
planned: /robot1/planner
running: /robot1/planner publishes /robot1/cmd_vel
""",
    line=3,
)
def cross_talk(view: View) -> Iterator[Finding]:
    """Of planned nodes; names that are in the plan are meant."""
    for node, robot in view.robot_of.items():
        for end in view.unplanned_endpoints.get(node, ()):
            other = view.ownership.robot(end.name)
            if other and other != robot:
                message = f"{DOES[end.role]} {end.name}, which belongs to {other}"
                cause = f"a remap rule or parameter of {robot} names {other}"
                yield cross_talk.finding(message, cause, robot=robot, node=node, names=(end.name,))
