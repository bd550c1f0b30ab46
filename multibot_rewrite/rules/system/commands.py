# SPDX-License-Identifier: Apache-2.0
"""Dangers of commands: who may move a robot, and how many send at a time."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from multibot_rewrite.base.conventions import (
    EVERYBODYS,
    OF_EVERY_NODE,
    chooses,
    is_from_outside,
    team,
)
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Remap, Setting
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.wording import and_then, only, shorten
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.system.causes import Cause, Spelled, alike, names_another
from multibot_rewrite.rules.system.likes import has_likes_of
from multibot_rewrite.rules.system.matching import STAMPED
from multibot_rewrite.rules.system.names import ABSENT, nobody_in
from multibot_rewrite.rules.system.sharing import own_names
from multibot_rewrite.system import words
from multibot_rewrite.system.index import TF, Ends, Index, at_work, nodes_of, once, robots_of
from multibot_rewrite.system.records import ACTION, CALLS, PUBLISHES, RUNS, SUBSCRIBES, TOPIC
from multibot_rewrite.system.words import is_hidden, is_tool, is_viewer, last_word

# A person drives with these.
_BY_HAND = lazy_compile("teleop|joy|keyboard|gamepad")
_MUX, _EACH = "put twist_mux before", ", each sender with a topic of its own"
_CHOOSE = f"{_MUX} the robot's driver{_EACH}"
# Of Nav2, between its controller and the robot: they limit velocities, and stop before obstacles.
LIMITS = ("velocity_smoother", "collision_monitor")
_VELOCITY = "geometry_msgs/msg/Twist"
# Of a joystick; it has to be held (teleop_twist_joy).
_BUTTON = "enable_button"
# The topics of RViz's own tools.
_OFFERED = ("goal_pose", "initialpose", "clicked_point")


@system_rule("MG310", "command-for-several-robots", ERROR, drawn="leak", meant=(SUBSCRIBES,))
def command_for_several_robots(seen: Index) -> Iterator[Finding]:
    """Report a command topic of several robots, whether or not anybody sends on it."""
    orders = seen.orders
    for (kind, name), ends in seen.by_name.items():
        joystick = ends.type == words.JOYSTICK
        if kind != TOPIC or not (joystick or name in orders):
            continue
        nodes = nodes_of(at_work(ends.subscribers))
        robots = robots_of(seen, nodes)
        if len(robots) > 1:
            message = f"{and_then(robots)} all obey {name}: {shorten(nodes)}"
            cause = own_names(seen, ends, robots)
            nobodys = joystick and not seen.robot(name)
            told = (it for it in seen.system.parameters if joystick and it.name == _BUTTON)
            if len({it.value for it in told if it.node in nodes}) == len(nodes):
                continue
            if nobodys:
                own = tuple(Setting(it, _BUTTON, str(at)) for at, it in enumerate(nodes, 4))
                also = "".join(f", {it.value} for {it.node}" for it in own)
                hint = f"{cause.hint}; or give each its own {_BUTTON}: {also[2:]}"
                cause = cause._replace(hint=hint, settings=() if cause.remaps else own)
            yield command_for_several_robots.finding(
                message, level=WARNING if nobodys else ERROR, node=nodes[0], names=(name,),
                **cause._asdict(),
            )  # fmt: skip


@system_rule("MG308", "command-without-reader", ERROR, absence=True, drawn="leak")
def command_to_nobody(seen: Index) -> Iterator[Finding]:
    """Report commands without a reader, unless the reader of a like name is reported."""
    obeyed: dict[str, list[str]] = defaultdict(list)
    waiting: dict[str, list[Ends]] = defaultdict(list)
    plainly: dict[tuple[str, str], list[str]] = defaultdict(list)
    unread: dict[str, Ends] = {}
    for name, it in seen.orders.items():
        # What only may be sent is not missed.
        sent = tuple(one for one in it.publishers if one.sure == RUNS)
        if sent and not at_work(it.subscribers):
            unread[name] = it._replace(publishers=sent)
    for (kind, name), ends in seen.by_name.items() if unread else ():
        if kind == TOPIC and at_work(ends.subscribers):
            waiting[ends.type.removesuffix(STAMPED)].append(ends)
            obeyed[ends.type] += [name] * bool(ends.publishers)
            plainly[ends.type, seen.plain(name)] += [name] * bool(ends.publishers)
    spelled: dict[str, Spelled] = {}
    for name, ends in unread.items():
        # What waits for such a command is a finding of its own, unless it takes another type.
        others = (it for it in waiting[ends.type.removesuffix(STAMPED)] if it.type != ends.type)
        same = obeyed[ends.type] or [it.name for it in others]
        spelled[ends.type] = spelled.get(ends.type) or Spelled(same)
        robots = _meant_commands(seen, ends, plainly[ends.type, name])
        near = next(iter(robots), "") or _like_command(seen, ends, spelled[ends.type])
        meant = near or _topic_for_mux(seen, ends) or _command_by_hand(seen, ends, same)
        if meant:
            yield _unread_command(seen, ends, meant, len(robots))
        elif absent := nobody_in(seen, name, same):
            for node in nodes_of(at_work(ends.publishers)):
                yield command_to_nobody.finding(
                    f"publishes {name}, which no node reads; {absent}", ABSENT,
                    level=WARNING, node=node, names=(name,),
                )  # fmt: skip


def _meant_commands(seen: Index, ends: Ends, names: Sequence[str]) -> Sequence[str]:
    """Return the obeyed names that a sender may mean: its robot's own; of no robot, those of all."""
    mine = only(robots_of(seen, nodes_of(ends.publishers)))
    if not mine:
        return names
    own = seen.of_robot(mine, TOPIC, seen.plain(ends.name))
    return [own.name] if own and own.name != ends.name and at_work(own.subscribers) else []


def _like_command(seen: Index, ends: Ends, known: Spelled) -> str:
    """Return the obeyed name that is nearly this one, not of another robot than the sender's."""
    mine = only(robots_of(seen, nodes_of(ends.publishers)))
    return alike(ends.name, known, ends.type, lambda it: not mine or seen.robot(it) in ("", mine))


def _topic_for_mux(seen: Index, ends: Ends) -> str:
    """Return what a mux or Nav2 should publish instead: what the drive reads, or a mux input; or ""."""
    robot, kinds = seen.robot(ends.name), _plain_types(ends)
    # MoveIt's nodes have drives of their own kind, and each its own goal.
    chosen = any(map(chooses, nodes_of(ends.publishers)))
    of_nav2 = kinds == {_VELOCITY} and any(team(it) != it for it in nodes_of(ends.publishers))
    if not (chosen or of_nav2):
        return ""
    senders, relays, moving = _velocity_ends(seen)
    drives = [
        it
        for it in moving.get(robot, ())
        if kinds & _plain_types(it)
        if not senders.issuperset(nodes_of(at_work(it.subscribers)))
        # What a drive gets by way of another node may be meant, and what is chosen for it as well.
        if relays.isdisjoint(nodes_of(it.publishers))
        if not set(nodes_of(ends.publishers)).intersection(nodes_of(it.subscribers))
        # What a drive that runs for certain reads in vain is the finding, but for a topic below its own
        # name, since people send there, too.
        if chosen
        or it.publishers
        or all(one.sure != RUNS or one.name.startswith(f"{one.node}/") for one in it.subscribers)
    ]
    if drives or chosen:
        return min(drives, key=lambda it: bool(it.publishers)).name if drives else ""
    idle = (it for it in moving.get(robot, ()) if kinds & _plain_types(it) and not it.publishers)
    inputs = (it.name for it in idle if any(map(chooses, nodes_of(it.subscribers))))
    return nearest(ends.name, [it for it in inputs if not _BY_HAND.search(it)], alike=0.0)


@once
def _velocity_ends(seen: Index) -> tuple[set[str], set[str], Mapping[str, Sequence[Ends]]]:
    """Return three: nodes that send velocities, those that also read them, velocities by robot."""
    moving = [it for it in seen.orders.values() if words.moves(seen.plain(it.name), it.type)]
    senders = {it.node for ends in moving for it in ends.publishers}
    asked = (it for it in moving if it.publishers or not is_from_outside(it.name))
    relays = senders.intersection(it.node for ends in asked for it in ends.subscribers)
    found = lists_by_key((seen.robot(it.name), it) for it in moving)
    return senders, relays, found


@once
def _obeyed_commands(seen: Index) -> Mapping[tuple[str, str], Sequence[str]]:
    """Return the obeyed commands by type and robot."""
    return lists_by_key(
        ((it.type, seen.robot(it.name)), it.name)
        for it in seen.orders.values()
        if at_work(it.subscribers)
    )


def _plain_types(ends: Ends) -> set[str]:
    """Return the types of a topic, as if none were stamped: that is a switch of the sender."""
    return {it.removesuffix(STAMPED) for it in ends.type.split(" | ")}


def _command_by_hand(seen: Index, ends: Ends, same: Sequence[str]) -> str:
    """Return the one goal or velocity that the robot obeys, where a person sends another one."""
    robot = seen.robot(ends.name)
    if words.moves(seen.plain(ends.name), ends.type):
        if not any(_BY_HAND.search(it) for it in nodes_of(ends.publishers)):
            return ""
        # What one node of Nav2 hands to the next is no drive's.
        mine = [it for it in same if seen.robot(it) == robot]
        readers = {it: at_work(seen.by_name[TOPIC, it].subscribers) for it in mine}
        own = [it for it in mine if any(team(one.node) == one.node for one in readers[it])]
    else:
        own = [*_obeyed_commands(seen).get((ends.type, robot), ())]
    return own[0] if len(own) == 1 else ""


def _unread_command(seen: Index, ends: Ends, meant: str, robots: int) -> Finding:
    node = nodes_of(ends.publishers)[0]
    reader = nodes_of(at_work(seen.by_name[TOPIC, meant].subscribers))[0]
    message = f"publishes {ends.name}, which no node reads; {reader} reads {meant}"
    several = f" (or that of another of the {robots} robots)" if robots > 1 else ""
    wanted = seen.by_name[TOPIC, meant].type
    remaps = tuple(Remap(it, ends.name, meant) for it in nodes_of(ends.publishers))
    cause = f"start it in the robot's namespace, or pass the rule {ends.name}:={meant}{several}"
    if set(wanted.split(" | ")).isdisjoint(ends.type.split(" | ")):
        cause = f"send {meant} as {wanted}, not as {ends.type}{several}"
    if others := _sends_already(seen, meant):
        remaps, cause = (), f"{reader} obeys {others} there: {_CHOOSE}"
    # RViz offers these from the start.
    usual = last_word(ends.name) in _OFFERED and is_viewer(node) and not is_hidden(node)
    level = NOTE if usual else WARNING if is_viewer(node) and not is_hidden(node) else ERROR
    return command_to_nobody.finding(
        message, cause, level=level, robot=seen.robot(node), node=node, names=(ends.name, meant),
        remaps=() if wanted != ends.type else remaps,
    )  # fmt: skip


def _sends_already(seen: Index, name: str) -> str:
    """Return who sends velocities to a reader that does not choose between them; empty for nobody."""
    there = seen.by_name[TOPIC, name]
    chosen = any(map(chooses, nodes_of(there.subscribers)))
    moves = words.moves(seen.plain(name), there.type)
    return shorten(nodes_of(at_work(there.publishers))) if moves and not chosen else ""


@system_rule(
    "MG311", "command-from-another-robot", ERROR, drawn="cross-talk", meant=(PUBLISHES, CALLS)
)
def command_from_another_robot(seen: Index) -> Iterator[Finding]:
    """Report also tools: a joystick of one robot is not for another."""
    for (kind, name), ends in seen.by_name.items():
        owner = seen.robot(name)
        crossing = [
            it
            for it in ((*ends.publishers, *ends.clients) if owner else ())
            if seen.robot(it.node) not in ("", owner)
        ]
        if not crossing:
            continue
        order = kind == TOPIC and (name in seen.orders or _is_waited_for(seen, ends))
        role = PUBLISHES if order else CALLS
        served = kind == TOPIC or ends.servers
        for node in nodes_of(it for it in crossing if it.role == role) if served else ():
            robot = seen.robot(node)
            # Who has both coordinates the two; a service that its own robot has not is for others.
            own = seen.of_robot(robot, kind, seen.plain(name))
            if node in nodes_of((*own.publishers, *own.clients)) if own else kind != TOPIC:
                continue
            does = "publishes" if kind == TOPIC else "sends goals to" if kind == ACTION else "calls"
            message = f"{does} {name}, a name of {owner}"
            # Where somebody sends to its own robot already, a rule would make two senders.
            obeyed = own and at_work(own.subscribers) and not _sends_already(seen, own.name)
            free = own and (own.servers or obeyed) and kind != ACTION
            rules = [Remap(node, name, own.name)] if own and free and own.type == ends.type else []
            cause = names_another(robot, owner, rules)
            # A drive may be idle, a stop may not.
            alone = nodes_of(ends.publishers) == (node,) and name not in seen.orders
            if rules and alone and not has_likes_of(seen, owner, node):
                hint = names_another(robot, owner).hint
                cause = Cause(f"{hint}; no other node publishes {name}: start one for {owner} too")
            yield command_from_another_robot.finding(
                message, **cause._asdict(), robot=robot, node=node, names=(name,)
            )


def _is_waited_for(seen: Index, ends: Ends) -> bool:
    """Return whether the sender's robot has readers and no sender of the same topic."""
    plain = seen.plain(ends.name)
    if ends.kind != TOPIC or ends.name in EVERYBODYS or ends.type == TF:
        return False
    own = (seen.of_robot(it, ends.kind, plain) for it in robots_of(seen, nodes_of(ends.publishers)))
    return any(it and at_work(it.subscribers) and not it.publishers for it in own)


@system_rule("MG312", "several-command-senders", WARNING, meant=(PUBLISHES,))
def several_command_senders(seen: Index) -> Iterator[Finding]:
    """Yield command topics with several senders; nodes of Nav2 (or MoveIt) count as one."""
    for ends in seen.orders.values():
        if not words.moves(seen.plain(ends.name), ends.type):
            continue
        readers = nodes_of(at_work(ends.subscribers))
        # A program to look with that sends velocities is a joystick.
        # What sends it and reads it is a bridge in both directions, and orders nothing itself, unless
        # it is such a program.
        both = {it for it in nodes_of(ends.subscribers) if not is_viewer(it)}
        senders = [it for it in nodes_of(ends.publishers) if it not in both]
        teams = {team(node): node for node in reversed(senders)}
        played = any(last_word(node).startswith(words.PLAYER) for node in senders)
        if not readers or len(teams) < 2 or played or all(map(chooses, readers)):
            continue
        # A sender of another robot is a rule of its own.
        if len(robots_of(seen, senders)) > 1:
            continue
        guards = [it for it in senders if chooses(it) or last_word(it) in LIMITS]
        loose = [it for it in teams.values() if it not in guards]
        tool = next((node for node in loose if is_tool(node)), max(loose or teams.values()))
        others = [node for node in teams.values() if node != tool]
        message = f"publishes {ends.name}, and so does {shorten(others)}; {readers[0]} obeys both"
        past = bool(guards) and tool not in guards
        cause = f"{_MUX} {guards[0]}{_EACH}" if past else _CHOOSE
        if past and chooses(guards[0]):
            cause = f"send it to a topic that {guards[0]} reads"
        plan, robot = seen.expected, seen.robot(ends.name) or seen.robot(readers[0])
        planned = nodes_of(plan.ends_at(TOPIC, ends.name).publishers) if plan else ()
        yield several_command_senders.finding(
            message, cause, level=ERROR if past or (planned and tool not in planned) else WARNING,
            robot=robot, node=tool, names=(ends.name,),
        )  # fmt: skip


@system_rule("MG313", "bag-beside-a-robot", ERROR)
def bag_played_to_robot(seen: Index) -> Iterator[Finding]:
    """Yield bags that are played to topics with other senders, or that a robot obeys."""
    mixed: dict[str, list[str]] = defaultdict(list)
    played = {end.name for end in seen.system.ends if words.PLAYER in end.node}
    for ends in seen.by_name.values() if played else ():
        if ends.kind != TOPIC or ends.name not in played:
            continue
        players = [it for it in nodes_of(ends.publishers) if last_word(it).startswith(words.PLAYER)]
        others = [it for it in nodes_of(at_work(ends.publishers)) if it not in players]
        obeyed = words.moves(seen.plain(ends.name), ends.type) and at_work(ends.subscribers)
        if players and ends.name not in OF_EVERY_NODE and (others or obeyed):
            mixed[players[0]].append(ends.name)
    for player, names in mixed.items():
        message = f"plays {shorten(sorted(names))} into the running system"
        rules = [Remap(player, it, f"{it}_of_bag") for it in sorted(names)]
        listed = " ".join(f"{it.old}:={it.new}" for it in rules)
        yield bag_played_to_robot.finding(
            message, f"play it in another ROS_DOMAIN_ID, or with --remap {listed}",
            robot=only(robots_of(seen, names)), node=player, names=tuple(sorted(names)),
            remaps=tuple(rules),
        )  # fmt: skip
