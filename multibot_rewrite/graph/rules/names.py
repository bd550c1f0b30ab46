"""Rules about a node's names: is each there, does it leak, is somebody on the other side."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping

from multibot_rewrite.graph.environment import listed
from multibot_rewrite.graph.expectation import EVERYWHERE, Wanted
from multibot_rewrite.graph.rules.causes import how_to_give, no_rule, plugin, unremapped
from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.rules.likeness import similar
from multibot_rewrite.graph.snapshot import LISTENER, GraphEndpoint
from multibot_rewrite.model import ERROR, WARNING
from multibot_rewrite.remap.records import CALLS, PUBLISHES, SERVES, SERVICE, SUBSCRIBES, TOPIC

SHOULD = {PUBLISHES: "publish", SUBSCRIBES: "subscribe", SERVES: "serve", CALLS: "call"}
# What Nav2's costmaps are called.
COSTMAP = "costmap"
# Publishers by their name without a robot's.
Strays = dict[str, list[GraphEndpoint]]


def missing_endpoints(view: View) -> Iterator[GraphFinding]:
    """A planned name that its node does not have, though the node is there."""
    for end, wanted in view.planned.items():
        robot = view.robot_of.get(wanted.node)
        if robot is None or wanted.node not in view.seen or end in view.types:
            continue
        # Of two nodes of one name, rcl shows the services of one only.
        if view.seen[wanted.node] > 1 and wanted.kind != TOPIC:
            continue
        message = f"it should {SHOULD[wanted.role]} {wanted.kind} {wanted.name}, and does not"
        cause = _why_missing(view, wanted, robot)
        yield GraphFinding("MG102", ERROR, robot, wanted.node, message, cause, (wanted.name,))


def _why_missing(view: View, wanted: Wanted, robot: str) -> str:
    """The first user question: we never get the topic /robot1/cmd_vel, why?"""
    instead = _instead(view, wanted, robot)
    if not instead:
        managed = (wanted.node, SERVICE, SERVES, f"{wanted.node}/get_state") in view.planned
        state = f"; is it configured? ros2 lifecycle get {wanted.node}" if managed else ""
        return f"it has no name like it: switched off by a parameter?{state}"
    said = f"it {wanted.role} {instead} instead"
    if instead in _as_asked(view, wanted, robot):
        return f"{said}: {no_rule(view, wanted)}{how_to_give(view, wanted)}"
    if not view.owners.of(wanted.name):
        return f"{said}: a rule moves it, though the plan has one {wanted.name} for all robots"
    if _captured(wanted.node, instead, wanted.name):
        return f"{said}: {_absolute(wanted.name)}"
    other = view.owners.of(instead)
    if other and other != robot:
        return f"{said}, which is {other}'s: a rule or parameter names the wrong robot"
    return f"{said}: a rule or parameter spells it otherwise"


def _as_asked(view: View, wanted: Wanted, robot: str) -> tuple[str, ...]:
    """Where it is if no rule and no namespace reach it."""
    bare = f"/{wanted.asked.strip('/').removeprefix('~/')}"
    names = (unremapped(wanted), bare, view.owners.bare(wanted.name, robot))
    return tuple(name for name in names if name not in ("", "/", wanted.name))


def _instead(view: View, wanted: Wanted, robot: str) -> str:
    """What the node has in place of a planned name, or an empty string."""
    others = _unplanned_names(view, wanted)
    likely = [name for name in _as_asked(view, wanted, robot) if name in others]
    likely += [name for name in others if _captured(wanted.node, name, wanted.name)]
    if likely:
        return likely[0]
    bare = {view.owners.bare(name, view.owners.of(name) or robot): name for name in others}
    meant = view.owners.bare(wanted.name, robot)
    return bare.get(meant, "") or bare.get(similar(meant, bare), "")


def _unplanned_names(view: View, wanted: Wanted) -> list[str]:
    node, kind, role = wanted.node, wanted.kind, wanted.role
    return [
        e.name
        for e in view.by_node.get(node, ())
        if (e.kind, e.role) == (kind, role) and (node, kind, role, e.name) not in view.planned
    ]


def leaks(view: View) -> Iterator[GraphFinding]:
    """A robot's node with a name that is no robot's and not shared: every robot would meet there."""
    shared = {*view.plan.shared_topics, *EVERYWHERE}
    meant = _meant_otherwise(view)
    for node, robot in view.robot_of.items():
        for name in dict.fromkeys(e.name for e in view.more.get(node, ())):
            if name in shared or view.owners.of(name):
                continue
            message = f"{name} is not {robot}'s own: the same node of another robot has it too"
            cause = _why_leaked(view, node, name, meant.get((node, name)))
            yield GraphFinding("MG103", ERROR, robot, node, message, cause, (name,))


def _meant_otherwise(view: View) -> dict[tuple[str, str], Wanted]:
    """The planned endpoints that are missing, by the names they have without a rule."""
    return {
        (wanted.node, name): wanted
        for end, wanted in view.planned.items()
        if end not in view.types and wanted.node in view.robot_of
        for name in _as_asked(view, wanted, view.robot_of[wanted.node])
    }


def _why_leaked(view: View, node: str, name: str, meant: Wanted | None) -> str:
    if meant:
        return no_rule(view, meant)
    which, place = plugin(view, node)
    if which:
        return f"{which} has no namespace or rule for it: see {place}"
    robot = view.robot_of[node]
    target = f"{name}/{robot}" if view.owners.last else f"/{robot}{name}"
    return f"an absolute name in its code or parameters: give --ros-args -r {name}:={target}"


def planned_leaks(view: View) -> Iterator[GraphFinding]:
    """A name that the plan itself has for several robots, since no rule reaches it."""
    shared = {*view.plan.shared_topics, *EVERYWHERE, *_shared_tf(view)}
    nodes: dict[str, dict[str, None]] = defaultdict(dict)
    for node, kind, role, name in view.planned:
        own = node in view.robot_of and name not in shared and not view.owners.of(name)
        if own and (node, kind, role, name) in view.types:
            nodes[name][node] = None
    for name, there in nodes.items():
        robots = dict.fromkeys(view.robot_of[node] for node in there)
        for node in there if len(robots) > 1 else ():
            message = f"{name} is planned for {listed(robots)}: they meet there"
            cause = "no rule reaches it: set the node's parameter, or put it in shared_topics"
            yield GraphFinding("MG103", ERROR, view.robot_of[node], node, message, cause, (name,))


def _shared_tf(view: View) -> set[str]:
    """The tf topics that robots share by their layout."""
    times = Counter(robot.tf for robot in view.plan.robots)
    return {f"{tf}{end}" for tf, count in times.items() if count > 1 for end in ("", "_static")}


def deaf_listeners(view: View) -> Iterator[GraphFinding]:
    """A tf listener in a robot's namespace that hears a tf topic which is not the robot's."""
    home = {robot.name: robot.tf for robot in view.plan.robots}
    for node in view.seen:
        robot = view.owners.of(node) if f"/{LISTENER}" in node else ""
        if robot and home[robot] != "/tf" and (node, TOPIC, SUBSCRIBES, "/tf") in view.types:
            message = f"/tf is what this tf listener hears, {robot}'s is on {home[robot]}"
            cause = "give the rule /tf:=tf to its whole process (--ros-args), not to one node of it"
            yield GraphFinding("MG103", ERROR, robot, node, message, cause, ("/tf",))


def cross_talk(view: View) -> Iterator[GraphFinding]:
    """A robot's node that speaks or listens under another robot's name."""
    for node, robot in view.robot_of.items():
        for end in view.more.get(node, ()):
            other = view.owners.of(end.name)
            if other and other != robot:
                message = f"it {end.role} {end.name}, which is {other}'s"
                cause = f"a rule or parameter of {robot} names {other}"
                yield GraphFinding("MG104", ERROR, robot, node, message, cause, (end.name,))


def captured_topics(view: View) -> Iterator[GraphFinding]:
    """A relative topic below a node's own namespace, as a costmap's sensors: nobody is there."""
    known = {*view.spoken, *(name for _, _, _, name in view.planned)}
    for node, robot in _below_a_namespace(view):
        # A costmap's sensors are its robot's; what else is planned so is meant so.
        costmap = COSTMAP in node.rpartition("/")[2]
        for end in _lonely(view, view.by_node if costmap else view.more, node):
            above = [n for n in _above(node, end.name) if view.owners.of(n) == robot]
            planned = (node, end.kind, end.role, end.name) in view.planned
            meant = next((n for n in above if n in (view.spoken if planned else known)), "")
            if meant:
                message = f"it subscribes {end.name}, where nobody publishes; {meant} is meant"
                about = (end.name, meant)
                yield GraphFinding("MG110", ERROR, robot, node, message, _absolute(meant), about)


def _below_a_namespace(view: View) -> Iterator[tuple[str, str]]:
    """The nodes with a namespace below their robot's: planned ones, and costmaps."""
    for node, robot in view.robot_of.items():
        if view.owners.bare(node, robot).count("/") > 1:
            yield node, robot
    for node in view.unplanned:
        robot = view.owners.of(node) if COSTMAP in node.rpartition("/")[2] else ""
        if robot:
            yield node, robot


def _lonely(
    view: View, ends: Mapping[str, list[GraphEndpoint]], node: str
) -> Iterator[GraphEndpoint]:
    """A node's subscriptions that nobody publishes, each name once."""
    names = {
        end.name: end
        for end in ends.get(node, ())
        if (end.kind, end.role) == (TOPIC, SUBSCRIBES) and end.name not in view.spoken
    }
    return iter(names.values())


def _absolute(meant: str) -> str:
    return f"a relative name falls below the node's own namespace: write {meant} in its parameters"


def _above(node: str, name: str) -> Iterator[str]:
    """A name that stands right below a node's namespace, in the namespaces above it."""
    namespace = node.rpartition("/")[0]
    while namespace and name.startswith(f"{namespace}/"):
        rest = name.removeprefix(namespace)
        namespace = namespace.rpartition("/")[0]
        yield namespace + rest
        name = namespace + rest


def _captured(node: str, name: str, meant: str) -> bool:
    return meant in _above(node, name)


def unheard(view: View) -> Iterator[GraphFinding]:
    """A planned subscription without any publisher, while one nearly of its name is there."""
    lonely = [
        end
        for end in view.planned
        if end[1:3] == (TOPIC, SUBSCRIBES) and end[3] not in view.spoken and end in view.types
    ]
    makers = _makers(view) if lonely else {}
    strays = _strays(view) if lonely else {}
    told = set()
    for node, _, _, name in lonely:
        robot = view.robot_of.get(node, "")
        # What a node that is there does not publish is told of that node.
        if not robot or name in told or any(maker in view.seen for maker in makers.get(name, ())):
            continue
        own, nobodys = strays.get(robot, {}), strays.get("", {})
        twin = _twin(view.owners.bare(name, robot), own, nobodys, name in makers)
        if twin:
            told.add(name)
            message = f"nobody publishes {name}; {twin.node} publishes {twin.name}"
            cause = f"give {twin.node} the rule {twin.name}:={name}, if it is meant for {robot}"
            yield GraphFinding("MG111", WARNING, robot, node, message, cause, (name, twin.name))


def _makers(view: View) -> Mapping[str, list[str]]:
    """The nodes that are to publish each topic."""
    found: dict[str, list[str]] = defaultdict(list)
    for node, kind, role, name in view.planned:
        if (kind, role) == (TOPIC, PUBLISHES):
            found[name].append(node)
    return found


def _strays(view: View) -> Mapping[str, Strays]:
    """Publishers nobody planned, by the robot of their node."""
    found: dict[str, Strays] = defaultdict(dict)
    told = set(view.stand_ins.values())
    for node, ends in view.more.items():
        for end in ends if node not in told else ():
            if (end.kind, end.role) == (TOPIC, PUBLISHES) and end.name not in EVERYWHERE:
                bare = view.owners.bare(end.name, view.owners.of(end.name))
                found[view.owners.of(node)].setdefault(bare, []).append(end)
    return found


def _twin(bare: str, own: Strays, nobodys: Strays, planned: bool) -> GraphEndpoint | None:
    """Who publishes what was meant: the bare name; where the plan has a publisher, one like it."""
    same = [*own.get(bare, ()), *nobodys.get(bare, ())]
    exact = next((end for end in same if end.name == bare), None)
    if exact or not planned:
        return exact
    near = own.get(similar(bare, own), ())
    return next(iter((*same, *near)), None)
