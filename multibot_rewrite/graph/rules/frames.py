"""Rules about tf: one parent a frame, one tree a robot, spelled and placed as the layout says."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from multibot_rewrite.graph.expectation import WantedRobot
from multibot_rewrite.graph.rules.causes import plugin, some
from multibot_rewrite.graph.rules.comparison import GraphFinding, View
from multibot_rewrite.graph.rules.likeness import similar
from multibot_rewrite.graph.rules.owners import JOINTS, one_less
from multibot_rewrite.graph.rules.trees import TfTree, names_on, tree_of
from multibot_rewrite.graph.snapshot import Frame
from multibot_rewrite.model import ERROR, WARNING


def two_parents(view: View) -> Iterator[GraphFinding]:
    """A tf frame with two parents on one topic: listeners see it jump."""
    for tree in view.trees:
        parents: dict[str, set[str]] = defaultdict(set)
        for edge in tree.edges:
            parents[edge.child].add(edge.parent)
        for child, found in parents.items():
            if len(found) > 1:
                both = " and ".join(sorted(found))
                message = f"frame {child} on {tree.topic} has the parents {both}"
                cause = "two nodes send it, or two robots share its name; who publishes there: "
                cause += some(_senders(tree)) or "nobody any more"
                robot = _robot_on(view, tree, child)
                yield GraphFinding("MG201", ERROR, robot, "", message, cause, (child,))


def _senders(tree: TfTree) -> list[str]:
    return [node for nodes in tree.senders.values() for node in nodes]


def _robot_on(view: View, tree: TfTree, frame: str) -> str:
    """Whose a frame is: its name tells, or the topic, if that is one robot's."""
    return view.frame_owners.of(frame) or (tree.home[0] if len(tree.home) == 1 else "")


def colliding_frames(view: View) -> Iterator[GraphFinding]:
    """One frame name that two robots send on one topic: neither tree can be used."""
    for tree in view.trees:
        shared = {frame: who for frame, who in _meanings(view, tree).items() if len(who) > 1}
        robots = sorted({robot for who in shared.values() for robot in who})
        if robots:
            message = f"frames {some(shared)} on {tree.topic} are sent by {_and(robots)}"
            yield GraphFinding(
                "MG202", ERROR, "", "", message, _why_colliding(view, tree, robots), tuple(shared)
            )


def _and(robots: Iterable[str]) -> str:
    return some(robots).replace(", ", " and ", 1)


def _why_colliding(view: View, tree: TfTree, robots: Sequence[str]) -> str:
    senders = some(node for robot in robots for node in tree.senders.get(robot, ()))
    first = view.robots[robots[0]]
    if _is_bare(view, first):
        rules = f"{_tf_rule(first, 'tf')} and {_tf_rule(first, 'tf_static')}"
        return f"bare frames need a tf topic for each robot: give {senders} the rules {rules}"
    return f"the descriptions are not rewritten: load each robot's own one in {senders}"


def _is_bare(view: View, robot: WantedRobot) -> bool:
    """Whether the layout has the same frames for every robot; one of them may hold its name."""
    return any(view.frame_owners.bare(frame, robot.name) == frame for frame in robot.frames)


def _meanings(view: View, tree: TfTree) -> dict[str, list[str]]:
    """The frames of a tree that tell no robot, with the robots they may be of: it declares them so,
    or declares them with its name and that is not there."""
    there = set(names_on(tree))
    stray = {name for name in there if not view.frame_owners.of(name)} - {*view.plan.shared_frames}
    found: dict[str, list[str]] = defaultdict(list)
    for robot in (view.robots[name] for name in tree.robots if stray):
        for bare, frame in _spelled(view, robot).items():
            if bare in stray and (bare == frame or frame not in there):
                found[bare].append(robot.name)
    return found


def bare_frames(view: View) -> Iterator[GraphFinding]:
    """A frame without the robot's name, which the layout puts in."""
    for tree in view.trees:
        own: dict[str, list[str]] = defaultdict(list)
        for frame, who in _meanings(view, tree).items():
            if len(who) == 1 and frame not in view.robots[who[0]].frames:
                own[who[0]].append(frame)
        for robot, found in own.items():
            spelled = _spelled(view, view.robots[robot])
            message = f"frames {some(found)} on {tree.topic} lack the name of {robot}"
            cause = f"expected is {spelled[found[0]]}: load the rewritten description in "
            cause += some(tree.senders.get(robot, ())) or "its robot_state_publisher"
            yield GraphFinding("MG207", ERROR, robot, "", message, cause, tuple(found))


def wrong_tf_topics(view: View) -> Iterator[GraphFinding]:
    """A robot's frames on a tf topic that is not the one of its layout."""
    there = {tree.topic: {edge.child for edge in tree.edges} for tree in view.trees}
    for tree in view.trees:
        astray: dict[str, list[Frame]] = defaultdict(list)
        for edge in tree.edges:
            robot = _whose(view, tree, edge.child)
            if robot and tree_of(view.robots[robot].tf) != tree.topic:
                astray[robot].append(edge)
        for robot, edges in astray.items():
            home = tree_of(view.robots[robot].tf)
            # A copy for those who look on, as RViz: the robot itself is as planned.
            copied = all(edge.child in there.get(home, ()) for edge in edges)
            if not (copied and tree.senders and robot not in tree.senders):
                yield _astray(view, tree, view.robots[robot], edges)


def _astray(view: View, tree: TfTree, robot: WantedRobot, edges: Sequence[Frame]) -> GraphFinding:
    frames = tuple(dict.fromkeys(edge.child for edge in edges))
    message = f"frame {frames[0]} of {robot.name} is on {edges[0].topic}, expected {robot.tf}"
    if len(frames) > 1:
        message += f"; as are {len(frames) - 1} more of its frames"
    cause = _why_astray(view, tree, robot, edges)
    return GraphFinding("MG205", ERROR, robot.name, "", message, cause, frames)


def _whose(view: View, tree: TfTree, frame: str) -> str:
    """The robot that sends a frame of its own: its name tells, or who publishes, if that is one."""
    robot = view.frame_owners.exact.get(frame, "")
    if robot or len(tree.robots) != 1:
        return robot
    only = tree.robots[0]
    return only if frame in view.robots[only].frames else ""


def _why_astray(view: View, tree: TfTree, robot: WantedRobot, edges: Iterable[Frame]) -> str:
    senders = tree.senders.get(robot.name) or tuple(_senders(tree))
    who = some(senders) or "its publisher"
    places = [place for _, place in (plugin(view, node) for node in senders) if place]
    where = f": see {some(places)}" if places else ""
    if robot.tf == "/tf":
        return f"the layout has one /tf for all robots: take the rule /tf:=... from {who}{where}"
    rule = _tf_rule(robot, "tf_static" if all(edge.static for edge in edges) else "tf")
    return f"the rule {rule} is missing for {who}{where}"


def _tf_rule(robot: WantedRobot, topic: str) -> str:
    """The rule that brings a tf topic to its place: relative in the robot's own namespace."""
    namespaced = any(node.startswith(f"/{robot.name}/") for node in robot.nodes)
    place = robot.tf.removeprefix(f"/{robot.name}/") if namespaced else robot.tf
    return f"/{topic}:={'/'.join(topic if it == 'tf' else it for it in place.split('/'))}"


def torn_trees(view: View) -> Iterator[GraphFinding]:
    """A robot's frames that do not hang together on its tf topic."""
    for tree in view.trees:
        parent_of: dict[str, dict[str, str]] = defaultdict(dict)
        children = {edge.child for edge in tree.edges}
        for edge in tree.edges:
            for robot in {_at_home(view, tree, name) for name in (edge.child, edge.parent)} - {""}:
                parent_of[robot][edge.child] = edge.parent
        for robot, above in parent_of.items():
            roots = sorted({parent for parent in above.values() if parent not in above})
            if len(roots) > 1:
                yield _torn(view, children, view.robots[robot], roots)


def _torn(view: View, children: Set[str], robot: WantedRobot, roots: Sequence[str]) -> GraphFinding:
    message = f"the tf tree of {robot.name} has {len(roots)} roots: {', '.join(roots)}"
    cause = (
        "a transform between them is missing: no joint_states for a joint that moves, no odometry, "
        "no localisation, or one side spells it otherwise"
    )
    for root in roots:
        bare = view.frame_owners.bare(root, robot.name)
        other = next(
            (
                n
                for n in _spellings(bare, root, view.frame_owners.spelled(robot.name))
                if n in children
            ),
            "",
        )
        # With one of its spellings it hangs in the tree.
        if other:
            cause = f"{other} and {root} are one frame in two spellings: see the other findings"
    return GraphFinding("MG203", ERROR, robot.name, "", message, cause, tuple(roots))


def _spellings(bare: str, root: str, robot: str) -> Iterator[str]:
    """What else a frame may be called: without the robot's name, and with it once more."""
    if bare != root:
        yield bare
    for joint in ("/", *JOINTS):
        yield f"{robot}{joint}{root}"
        yield f"{root}{joint}{robot}"


def _at_home(view: View, tree: TfTree, frame: str) -> str:
    """The robot whose tree a frame is part of, if that is to be here."""
    if len(tree.home) == 1:
        return tree.home[0] if frame in view.frames_of[tree.home[0]] else ""
    robot = view.frame_owners.exact.get(frame, "")
    return robot if robot and tree_of(view.robots[robot].tf) == tree.topic else ""


def _spelled(view: View, robot: WantedRobot) -> dict[str, str]:
    """The robot's frames by what they are called without its name."""
    if _is_bare(view, robot):
        return {frame: frame for frame in robot.frames}
    return {view.frame_owners.bare(frame, robot.name): frame for frame in robot.frames}


def undeclared_frames(view: View) -> Iterator[GraphFinding]:
    """Frames under a robot's name that its description does not have, or with the name twice."""
    for tree in view.trees:
        children = {edge.child: edge for edge in tree.edges}
        doubled: dict[str, list[str]] = defaultdict(list)
        unknown: dict[str, list[str]] = defaultdict(list)
        for name in names_on(tree):
            robot = _undeclared_by(view, tree, name, children)
            if not robot:
                continue
            if _is_doubled(view, view.robots[robot], name):
                doubled[robot].append(name)
            elif name in children and not _of_a_sensor(view, robot, name, children):
                unknown[robot].append(name)
        yield from (_doubled(view, view.robots[it], names) for it, names in doubled.items())
        yield from (_undeclared(view, view.robots[it], names) for it, names in unknown.items())


def _undeclared_by(view: View, tree: TfTree, name: str, children: Mapping[str, Frame]) -> str:
    """The robot whose a frame is by its name or topic, and whose description does not have it."""
    if name in view.plan.shared_frames or view.frame_owners.exact.get(name):
        return ""
    robot = view.frame_owners.of(name)
    # What moves on a robot's own topic may be anything that it sees.
    if not robot and len(tree.home) == 1 and name in children and children[name].static:
        robot = tree.home[0]
    if not robot or not view.robots[robot].frames or name in view.frames_of[robot]:
        return ""
    # Without the robot's name it is another rule's.
    return "" if name in _spelled(view, view.robots[robot]) else robot


def _is_doubled(view: View, robot: WantedRobot, name: str) -> bool:
    word = view.frame_owners.spelled(robot.name)
    if not view.frames_of[robot.name].isdisjoint(one_less(name, word)):
        return True
    once = view.frame_owners.bare(name, robot.name)
    twice = view.frame_owners.bare(once, robot.name)
    ordinary = word in view.frame_owners.words
    return twice != once and not ordinary and twice in _spelled(view, robot)


def _doubled(view: View, robot: WantedRobot, names: Sequence[str]) -> GraphFinding:
    cause = (
        "frame_prefix of robot_state_publisher or tf_frame_prefix_enable of a controller (on by "
    )
    if _is_bare(view, robot):
        message = f"{_frames(names)} the name of {robot.name}, the layout has bare frames"
        cause += "default), or a description rewritten for another layout: set them to '' and false"
    else:
        message = f"{_frames(names)} the name of {robot.name} twice"
        cause += "default), on top of a rewritten description: set them to '' and false"
    return GraphFinding("MG206", ERROR, robot.name, "", message, cause, tuple(names))


def _frames(names: Sequence[str]) -> str:
    return f"frame {names[0]} has" if len(names) == 1 else f"frames {some(names)} have"


def _of_a_sensor(view: View, robot: str, name: str, children: Mapping[str, Frame]) -> bool:
    """A driver's own frames hang below the link it is told, and are called after it: camera_link
    has camera_depth_frame."""
    above, passed = name, set()
    while above in children and children[above].static and above not in passed:
        passed.add(above)
        above = children[above].parent
        if above in view.frames_of[robot]:
            return _first_word(view, above, robot) == _first_word(view, name, robot)
    return False


def _first_word(view: View, frame: str, robot: str) -> str:
    bare = view.frame_owners.bare(frame, robot)
    return bare[: next((at for at, letter in enumerate(bare) if letter in "/" + JOINTS), None)]


def _undeclared(view: View, robot: WantedRobot, names: Sequence[str]) -> GraphFinding:
    verb = "is" if len(names) == 1 else "are"
    message = f"{_frames(names).rpartition(' ')[0]} {verb} not in the description of {robot.name}"
    spelled = _spelled(view, robot)
    bare = view.frame_owners.bare(names[0], robot.name)
    meant = spelled.get(bare) or spelled.get(similar(bare, spelled), "")
    cause = f"is {meant} meant? else" if meant else "a sensor's own? then"
    cause += f" put {'it' if len(names) == 1 else 'them'} in other_frames of the plan"
    return GraphFinding("MG204", WARNING, robot.name, "", message, cause, tuple(names))
