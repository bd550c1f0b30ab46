# SPDX-License-Identifier: Apache-2.0
"""Dangers of names: a subscriber or client whose other side has nearly the same name, two servers."""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence, Set
from typing import NamedTuple

from multibot_rewrite.base.conventions import EVERYBODYS, chooses, is_from_outside, team
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Remap, Setting
from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.nearest import MISTYPED, meant_name, nearest
from multibot_rewrite.base.wording import and_then, shorten, unique
from multibot_rewrite.rules.declaration import last_place, see_all, system_rule
from multibot_rewrite.rules.system.causes import ACTION_PARTS, NONE, Cause, Spelled, alike
from multibot_rewrite.rules.system.instead import (
    COMMON,
    MANAGER,
    in_other_namespace,
    is_of_another_kind,
    listed_in_vain,
    sent_instead,
)
from multibot_rewrite.rules.system.likes import done_elsewhere, has_likes_of
from multibot_rewrite.system import words
from multibot_rewrite.system.index import (
    Ends,
    Index,
    at_work,
    nodes_of,
    once,
    robots_of,
    spaces,
)
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import ACTION, RUNS, SERVES, SERVICE, TOPIC, End
from multibot_rewrite.system.words import in_namespaces_above, is_spawner, is_viewer, last_word

ABSENT = "is that robot started, and is its name right?"


@system_rule("MG303", "topic-names-miss", ERROR, absence=True, drawn="leak")
def topic_names_miss(seen: Index) -> Iterator[Finding]:
    """Yield subscribers whose topic nobody sends, with the name it is sent under if one is alike."""
    unsent = [it for it in seen.topics if not it.publishers]
    if not unsent:
        return
    # What only may be sent is not what was meant.
    sent = (it for own in _published(seen).values() for it in own)
    published = {it.name: it for it in sent if any(one.sure == RUNS for one in it.publishers)}
    unheard = {name: it for name, it in published.items() if not at_work(it.subscribers)}
    for ends in unsent:
        by_kind: dict[str, list[End]] = {}
        there = done_elsewhere(seen, ends)
        lost = there and not has_likes_of(seen, seen.robot(ends.name), there)
        for end in {it.node: it for it in ends.subscribers}.values():
            if is_viewer(end.node) or end.sure != RUNS:
                continue
            # What chooses between several inputs seldom has all of them.
            offered = unheard if chooses(end.node) else published
            if near := published.get(_published_instead(seen, end, offered, unheard)):
                yield _missed_topic(seen, end, near, ERROR)
            elif not lost and (other := sent_instead(seen, end)) and other.name in published:
                by_kind.setdefault(other.name, []).append(end)
            elif mine := _robots_topics(seen, end):
                yield _outside_reader(seen, end, mine)
            elif absent := nobody_in(seen, ends.name, published):
                yield topic_names_miss.finding(
                    f"subscribes to {ends.name}, which {seen.nobody} publishes; {absent}",
                    ABSENT, level=WARNING, node=end.node, names=(ends.name,), **last_place([end]),
                )  # fmt: skip
        for other_name, (first, *more) in by_kind.items():
            # A lone sender and a lone reader of what a sensor measures are made for each other, but for
            # what another launch file may start.
            other = published[other_name]
            lone = other.type == first.type and not at_work(other.subscribers)
            sensor = words.is_of_one_sensor(first.type) and first.type != words.JOYSTICK
            sensor |= seen.is_observed and words.moves(seen.plain(first.name), first.type)
            sure = seen.is_live and (words.is_of_a_body(first.type) or (lone and sensor))
            yield _missed_topic(seen, first, other, ERROR if sure else WARNING, more)


def _robots_topics(seen: Index, end: End) -> Sequence[str]:
    """Return the robots' topics that a node outside of them reads: sensors, odometry, a map."""
    kind = words.kind_of_data(end.name, end.type)
    outside = not (seen.robot(end.node) or seen.robot(end.name) or seen.is_tool(end.node))
    if not (outside and kind) or is_from_outside(end.name) or words.moves(end.name, end.type):
        return ()
    names = (it for robot in seen.robots for it in _by_plain(seen).get((robot, end.name), ()))
    return [it for it in names if seen.by_name[TOPIC, it].type == end.type]


def _outside_reader(seen: Index, end: End, names: Sequence[str]) -> Finding:
    """Return the finding about a node of no robot that reads what only robots publish."""
    sender = nodes_of(seen.by_name[TOPIC, names[0]].publishers)[0]
    several = f" (or that of another of the {len(names)} robots)" if len(names) > 1 else ""
    lost = f"subscribes to {end.name}, which {seen.nobody} publishes"
    return topic_names_miss.finding(
        f"{lost}; {sender} publishes {names[0]}{several}",
        f"start it in its robot's namespace, or pass the rule {end.name}:={names[0]}{several}",
        node=end.node, names=(end.name, names[0]), **last_place([end]),
        remaps=() if several else (Remap(end.node, end.name, names[0]),),
    )  # fmt: skip


def _published_instead(
    seen: Index, end: End, published: dict[str, Ends], unheard: dict[str, Ends]
) -> str:
    """Return the published topic that was probably meant; empty for none."""
    robot, owner = seen.robot(end.node), seen.robot(end.name)
    own = {"", robot or owner}
    above = (it for it in _possible_names(end.node, end.name) if it in published)
    fitting = (it for it in above if published[it].type == end.type)

    def has_own_sender(it: str) -> bool:
        return not own.isdisjoint(map(seen.robot, nodes_of(published[it].publishers)))

    if captured := next(filter(has_own_sender, fitting), ""):
        return captured
    if not owner and robot:
        # Its own robot has it: whether or not others read it as well.
        same = (it for it in _by_plain(seen).get((robot, end.name), ()) if it in published)
        return next((it for it in same if published[it].type == end.type), "")
    if not owner and (lacking := _of_a_robot_without(seen, end, published)):
        return lacking

    def is_of_another(it: str) -> bool:
        if it not in published or nodes_of(published[it].publishers) == (end.node,):
            return False
        return not _is_of_other_robot(seen, end.name, it) and (not owner or has_own_sender(it))

    bare = seen.plain(end.name)
    hidden = [_without_own_name(end), *_hidden_names(seen, end.name)]
    hidden += [bare] if owner and not seen.robot(bare) else []
    same = (it for it in hidden if it in unheard and unheard[it].type == end.type)
    if found := next(filter(is_of_another, same), ""):
        return found
    return alike(end.name, _topics_by_type(seen).get(end.type, NONE), end.type, is_of_another)


def _is_of_other_robot(seen: Index, name: str, other: str) -> bool:
    """Return whether two names are those of two robots, such as ``left_arm`` and ``arm_left``."""
    robot, another = seen.robot(name), seen.robot(other)
    return bool(robot and another) and robot != another


@once
def _topics_by_type(seen: Index) -> Mapping[str, Spelled]:
    """Return the published topics by type, for a search by similar name."""
    return {type_: Spelled(it.name for it in own) for type_, own in _published(seen).items()}


def _of_a_robot_without(seen: Index, end: End, published: Mapping[str, Ends]) -> str:
    """Return the topic of the one robot that lacks the node, which then has no namespace; or empty."""
    there = _robots_with_node(seen).get(end.node, set())
    without = [it for it in seen.robots if it not in there] if len(there) > 1 else []
    name = f"/{without[0]}{end.name}" if len(without) == 1 else ""
    return name if name in published and published[name].type == end.type else ""


@once
def _robots_with_node(seen: Index) -> Mapping[str, Set[str]]:
    """Return the robots that have a node, by its name without theirs."""
    return sets_by_key((seen.plain(it), seen.robot(it)) for it in seen.nodes)


@once
def _by_plain(seen: Index) -> Mapping[tuple[str, str], Sequence[str]]:
    """Return the published topics of each robot, by robot and name without it."""
    return lists_by_key(
        ((seen.robot(it.name), seen.plain(it.name)), it.name) for it in seen.topics if it.publishers
    )


@once
def _published(seen: Index) -> Mapping[str, Sequence[Ends]]:
    """Return the topics with a publisher, by type."""
    topics = (it for it in seen.by_name.values() if it.kind == TOPIC and it.publishers)
    return lists_by_key((it.type, it) for it in topics)


def _possible_names(node: str, name: str) -> Iterator[str]:
    """Yield what a relative name may have meant: in a namespace above, or with it written twice."""
    yield from in_namespaces_above(node, name)
    space = node
    while space := space.rpartition("/")[0]:
        if name.startswith(f"{space}/"):
            yield name.removeprefix(space)


def _hidden_names(seen: Index, meant: str) -> Iterator[str]:
    """Yield what a name becomes below its publisher's own name, or with its namespace twice."""
    space, _, last = meant.rpartition("/")
    yield from _below_senders(seen).get((space, last), ())
    yield from (meant[:at] + meant for at in range(1, len(meant)) if meant[at] == "/")


@once
def _below_senders(seen: Index) -> Mapping[tuple[str, str], Sequence[str]]:
    """Return topics with their publisher's own name before the last word, by the rest."""
    found: dict[tuple[str, str], list[str]] = defaultdict(list)
    for it in (one for own in _published(seen).values() for one in own):
        above, _, last = it.name.rpartition("/")
        space, _, word = above.rpartition("/")
        if word in {last_word(one.node) for one in it.publishers}:
            found[space, last].append(it.name)
    return found


def _without_own_name(end: End) -> str:
    """Return the usual name of ``~/cmd_vel``, without the node's name; empty for other names."""
    last = last_word(end.name)
    return f"{end.node.rpartition('/')[0]}/{last}" if end.name == f"{end.node}/{last}" else ""


def _missed_topic(
    seen: Index, end: End, other: Ends, level: str, more: Sequence[End] = ()
) -> Finding:
    robot = seen.robot(end.node) or seen.robot(end.name)
    sender = min(nodes_of(other.publishers), key=lambda it: seen.robot(it) != robot)
    also = f" (and so does {shorten(nodes_of(more))})" if more else ""
    message = f"subscribes to {end.name}{also}, which {seen.nobody} publishes"
    message += f"; {sender} publishes {other.name}"
    if other.type != end.type:
        message += f" as {last_word(other.type)}"
    cause = _how_to_join(seen, [end, *more], other, sender)
    level = NOTE if is_viewer(sender) else level
    return topic_names_miss.finding(
        message, cause.hint + see_all((other.publishers[0], end)),
        level=level, robot=robot, node=end.node, names=(end.name, other.name),
        remaps=cause.remaps, **last_place([end]),
    )  # fmt: skip


def _how_to_join(seen: Index, readers: Sequence[End], other: Ends, sender: str) -> Cause:
    """Return how the readers of a topic get what is sent as ``other``: by a patch, or where to look."""
    end, senders = readers[0], nodes_of(other.publishers)
    owner, front = seen.robot(end.name), other.name.removesuffix(end.name)
    # The side in the wrong place is the one whose name has no robot, is below the node, or has a
    # namespace of the other name once more in front.
    if front != other.name and end.name.startswith(f"{front}/"):
        hint = f"its namespace is there twice: name it {last_word(other.name)} in {sender}"
        return Cause(hint, remaps=(Remap(sender, other.name, end.name),))
    misplaced = owner not in ("", seen.robot(other.name)) and other.name not in EVERYBODYS
    all_robots = misplaced and _serves_all(seen, end.name, senders)
    # By a plan the reader is right.
    misplaced |= _is_planned(seen, end) and not any(
        _is_planned(seen, it) for it in other.publishers
    )
    if misplaced and not all_robots and other.type == end.type:
        # That of another robot is sent there as well.
        own = [it for it in senders if seen.robot(it) == owner] or senders
        hint = f"pass the rule {other.name}:={end.name} to {shorten(own)}, or start it in the namespace"
        return Cause(hint, remaps=tuple(Remap(it, other.name, end.name) for it in own))
    robot, likes = seen.robot(other.name), _robots_with_node(seen).get(end.node, set())
    if robot and likes - {""} and robot not in likes and not seen.robot(end.node):
        space = other.name.removesuffix(seen.plain(other.name))
        hint = f"start it in the namespace of {robot}, with -r __ns:={space}"
        return Cause(hint, remaps=(Remap(end.node, "__ns", space),))
    if look := _where_to_look(seen, end, other, sender, all_robots):
        return Cause(look)
    each, set_ = " to each" if len(readers) > 1 else "", f"write {other.name} in its parameters"
    hint = f"pass the rule {end.name}:={other.name}{each}, or "
    hint += f"put {other.name} in shared_topics of the fleet file" if all_robots else set_
    return Cause(hint, remaps=tuple(Remap(it.node, end.name, other.name) for it in readers))


def _where_to_look(seen: Index, end: End, other: Ends, sender: str, all_robots: bool) -> str:
    """Return what to do where no rule may join a topic with its reader; empty where one may."""
    if other.type != end.type:
        return f"make both one type: set it in a parameter of one side, or convert {other.name}"
    alone = words.is_never_shared(seen.plain(end.name), end.type)
    if all_robots and (alone or _is_planned(seen, end)):
        shared = "" if alone else f", or put {other.name} in shared_topics of the fleet file"
        return f"{sender} sends it to all robots: start one for each, in its namespace{shared}"
    if _are_stages(end, other):
        between = "twist_mux, velocity_smoother or collision_monitor"
        return f"start what passes {other.name} on ({between}), or give both one name"
    if is_of_another_kind(seen, end, other):
        return f"start what sends {end.name}: {other.name} may be of another sensor or place"
    return ""


def _is_planned(seen: Index, end: End) -> bool:
    """Return whether a plan has this end."""
    planned = seen.expected.by_key if seen.expected else ()
    return (end.node, end.kind, end.role, end.name) in planned


def _serves_all(seen: Index, name: str, senders: Sequence[str]) -> bool:
    """Return whether the senders are of no robot and serve all, as none has one of its own."""
    own = (seen.of_robot(it, TOPIC, seen.plain(name)) for it in seen.robots)
    return (
        len(seen.robots) > 1
        and not any(map(seen.robot, senders))
        and not any(it and it.publishers for it in own)
    )


def _are_stages(end: End, other: Ends) -> bool:
    """Return whether both are commands on their way to a drive, such as cmd_vel_nav and cmd_vel."""
    (space, _, one), (above, _, two) = (it.name.rpartition("/") for it in (end, other))
    stem = one.split("_")[:2] == two.split("_")[:2]
    return space == above and stem and one != two and words.moves(end.name, end.type)


@system_rule("MG304", "server-names-miss", ERROR, absence=True)
def server_names_miss(seen: Index) -> Iterator[Finding]:
    """Yield clients whose server has another name. A service that nobody serves may be optional."""
    for ends in seen.by_name.values():
        if ends.kind != TOPIC and not ends.servers:
            for end in {it.node: it for it in ends.clients if it.sure == RUNS}.values():
                served = _served_names(seen).get((end.kind, end.type), _NOBODY)
                yield from _unserved_findings(seen, end, served)


def not_managed(
    seen: Index, manager: str, nodes: Sequence[str], else_: str = "", meant: str = ""
) -> Cause:
    """Return how a manager is to leave nodes out that it has in its list, or to list the meant one."""
    asked = (it.name for it in seen.by_node[manager] if it.name.endswith(words.CHANGE_STATE))
    listed = unique(it.removesuffix(words.CHANGE_STATE) for it in asked)
    space = manager.rpartition("/")[0] + "/"
    left = (it if it not in nodes else meant for it in listed)
    names = parameter_text([it.removeprefix(space) for it in left if it])
    hint = f"{else_}leave {shorten(nodes)} out of {words.NODE_NAMES} of {manager}"
    if meant:
        hint = f"write {meant} for {shorten(nodes)} in {words.NODE_NAMES} of {manager}"
    return Cause(hint, settings=(Setting(manager, words.NODE_NAMES, names),))


class _Served(NamedTuple):
    """What is served of a kind and type: all names, and those by their name without a robot's."""

    names: Mapping[str, Ends]
    plain: Mapping[str, Sequence[str]]
    spelled: Spelled


_NOBODY = _Served({}, {}, NONE)


@once
def _served_names(seen: Index) -> Mapping[tuple[str, str], _Served]:
    found: dict[tuple[str, str], dict[str, Ends]] = defaultdict(dict)
    for (kind, name), ends in seen.by_name.items():
        if ends.servers:
            found[kind, ends.type][name] = ends
    return {
        key: _Served(it, lists_by_key((seen.plain(name), name) for name in it), Spelled(it))
        for key, it in found.items()
    }


def _unserved_findings(seen: Index, end: End, served: _Served) -> Iterator[Finding]:
    listed = listed_in_vain(seen, end)
    outside = f"/{last_word(listed)}" if listed and f"/{last_word(listed)}" in seen.nodes else ""
    near = "" if outside else _served_instead(seen, end, served) or in_other_namespace(seen, end)
    asks = "sends goals to" if end.kind == ACTION else "calls"
    lost = f"{asks} {end.name}, which {seen.nobody} serves"
    by_type = None if near or listed else sent_instead(seen, end)
    if other := near or (by_type.name if by_type else ""):
        sure = near or end.kind == ACTION
        yield _missed_server(seen, end, lost, other, ERROR if sure else WARNING)
    elif listed and end.name.endswith(words.CHANGE_STATE):
        # A node that runs and is called nearly so: a letter wrong, or without the namespace.
        space, _, last = listed.rpartition("/")
        others = {last_word(it): it for it in seen.nodes if it.rpartition("/")[0] == space}
        meant = outside or others.get(
            meant_name(last, others) or nearest(last, others, MISTYPED), ""
        )
        instead = f"; {meant} runs" if meant else ""
        wait = f"it waits for {listed} and activates nothing after it: start it"
        cause = not_managed(seen, end.node, [listed], f"{wait}, or ", meant)
        if outside:
            moved = Remap(outside, "__ns", space)
            cause = Cause(f"{wait} in the namespace, with -r __ns:={space}", remaps=(moved,))
        yield server_names_miss.finding(
            f"{lost}: {listed} is in its list, and does not run{instead}",
            cause.hint, settings=cause.settings, remaps=cause.remaps,
            robot=seen.robot(end.node), node=end.node, names=(end.name,), **last_place([end]),
        )  # fmt: skip
    elif not (listed or is_viewer(end.node)) and (
        absent := nobody_in(seen, end.name, served.names)
    ):
        yield server_names_miss.finding(
            f"{lost}; {absent}", ABSENT, level=WARNING, node=end.node, names=(end.name,)
        )
    elif not listed and _calls_in_vain(seen, end):
        yield server_names_miss.finding(
            lost, "start the node that serves it, or leave out what calls it", level=WARNING,
            robot=seen.robot(end.node), node=end.node, names=(end.name,), **last_place([end]),
        )  # fmt: skip


def _calls_in_vain(seen: Index, end: End) -> bool:
    """Return whether the end is of a user's own program, and calls what nobody serves."""
    theirs = is_viewer(end.node) or seen.is_tool(end.node) or team(end.node) != end.node
    # A name below a node that runs is that node's own.
    below = end.name.rpartition("/")[0] in seen.node
    common = end.type.startswith(COMMON) and not end.type.startswith("std_srvs/")
    # Beside other robots it may be one that is not started yet, if it is not its own.
    own = seen.robot(end.name) if below else seen.robot(end.node)
    others = len(seen.robots) > 1 and not (own and own == seen.robot(end.name))
    # What all robots call in vain is so by their make; goals that another robot takes are MG322.
    vain, served = _called_by_robots(seen).get((end.kind, seen.plain(end.name)), ((), ()))
    others = others or any(it != own for it in (*vain, *(served if end.kind == ACTION else ())))
    usual = common or is_from_outside(end.name) or "/_" in end.name
    return not (seen.in_doubt or theirs or usual or end.code_name or others)


@once
def _called_by_robots(seen: Index) -> Mapping[tuple[str, str], tuple[list[str], list[str]]]:
    """Return by kind and plain name (robots that call in vain, robots that are served)."""
    found: dict[tuple[str, str], tuple[list[str], list[str]]] = defaultdict(lambda: ([], []))
    for ends in seen.by_name.values():
        robot = seen.robot(ends.name) if ends.clients or ends.servers else ""
        if robot:
            robots = found[ends.kind, seen.plain(ends.name)][bool(ends.servers)]
            # Two tell whether another than one of them is there.
            robots += [robot] * (len(robots) < 2)
    return dict(found)


def _missed_server(seen: Index, end: End, lost: str, other: str, level: str) -> Finding:
    servers = seen.by_name[end.kind, other].servers
    parts = f"{ACTION_PARTS}," if end.kind == ACTION else ""
    cause = f"pass the rule {end.name}:={other},{parts} or start it in the namespace of the robot"
    remaps: tuple[Remap, ...] = (Remap(end.node, end.name, other),)
    callers = (it.node for it in seen.by_name[end.kind, other].clients)
    managed = [it for it in callers if last_word(it).startswith(MANAGER)]
    if last_word(end.node).startswith(MANAGER) and managed:
        cause, remaps = f"{managed[0]} manages that node already: do not start {end.node}", ()
    clicked = is_viewer(end.node) and not is_spawner(end.node)
    return server_names_miss.finding(
        f"{lost}; {nodes_of(servers)[0]} serves {other}", cause + see_all((servers[0], end)),
        level=NOTE if clicked else level, robot=seen.robot(end.node) or seen.robot(other),
        node=end.node, names=(end.name, other), remaps=remaps, **last_place([end]),
    )  # fmt: skip


def _served_instead(seen: Index, end: End, served: _Served) -> str:
    """Return the served name that a client probably means; empty for none."""
    robot, owner = seen.robot(end.node), seen.robot(end.name)
    same = served.plain.get(seen.plain(end.name), ())
    # Another robot's is no answer to a robot that lacks it.
    near = [it for it in same if not owner or not seen.robot(it)]
    own = [it for it in near if seen.robot(it) == robot]
    above = (it for it in _possible_names(end.node, end.name) if it in served.names)
    first = (next(iter(it), "") for it in (own, near, above))
    return next(filter(None, first), "") or alike(
        end.name, served.spelled, end.type, lambda it: not _is_of_other_robot(seen, end.name, it)
    )


def nobody_in(seen: Index, name: str, known: Collection[str]) -> str:
    """Return words for a name in a namespace without nodes, if robots have it in theirs; else ""."""
    if seen.robot(name):
        return ""
    for at in (at for at in range(2, len(name)) if name[at] == "/"):
        alike_, space = _names_by_plain(seen).get(name[at:], ()), name[:at]
        other = next((it for it in reversed(alike_) if it in known), "")
        if other and space not in spaces(seen):
            return f"no node is in {space}, and {seen.robot(other)} has {other}"
    return ""


@once
def _names_by_plain(seen: Index) -> Mapping[str, Sequence[str]]:
    """Return the names of robots, by their name without a robot's."""
    return lists_by_key((seen.plain(name), name) for _, name in seen.by_name if seen.robot(name))


@system_rule("MG305", "service-of-two-nodes", ERROR, meant=(SERVES,))
def service_of_two_nodes(seen: Index) -> Iterator[Finding]:
    """Report services of two nodes; set_pose of two filters in one robot is by design."""
    for (kind, name), ends in seen.by_name.items():
        nodes = nodes_of(ends.servers) if ends.servers else ()
        if len(nodes) > 1 and (kind == ACTION or len(robots_of(seen, nodes)) > 1):
            what = "action" if kind == ACTION else SERVICE
            message = f"{and_then(nodes)} both serve the {what} {name}"
            cause = "an absolute name in their code or parameters: make it relative, or remap it"
            yield service_of_two_nodes.finding(
                message, cause, robot=seen.robot(name), node=nodes[0], names=(name,)
            )
