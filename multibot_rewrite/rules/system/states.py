# SPDX-License-Identifier: Apache-2.0
"""Dangers of nodes: two of one name, states, managers, controllers and their interfaces, clocks.

Source: ros2_control controller_manager.cpp (a controller whose interfaces do not exist is not
activated; a command interface has one owner) and its chaining: a controller's own interfaces are
called ``CONTROLLER/...``."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Setting
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.nearest import Guesses
from multibot_rewrite.base.wording import SEVERAL, and_then, shorten
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.declaration import last_place, see_all, system_rule
from multibot_rewrite.rules.system.causes import Cause, to_set
from multibot_rewrite.rules.system.clocks import mixed_clocks, planned_clocks
from multibot_rewrite.rules.system.names import not_managed
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, nodes_of
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import (
    CLAIMS,
    COMMAND,
    EXPORTS,
    JOINT,
    SERVICE,
    SIM_TIME,
    Interface,
    clocks,
)
from multibot_rewrite.system.words import is_tool, is_viewer, last_word

ACTIVE, INACTIVE = "active", "--inactive"


@system_rule("MG511", "not-active", ERROR)
def not_active(seen: Index) -> Iterator[Finding]:
    """Report nodes in another state than planned, or not active, those of one manager as one."""
    planned = seen.expected.system.nodes if seen.expected else ()
    states = {it.name: it.lifecycle for it in planned if it.lifecycle}
    found: dict[tuple[str, str, str, str], list[str]] = defaultdict(list)
    for it in seen.node.values():
        wanted = states.get(it.name, ACTIVE)
        if it.lifecycle not in ("", wanted):
            about = (seen.robot(it.name), it.lifecycle, wanted, _manager(seen, it.name))
            found[about].append(it.name)
    for (robot, state, wanted, manager), nodes in found.items():
        verb = "is" if len(nodes) == 1 else "are"
        message = f"{shorten(sorted(nodes), SEVERAL)} {verb} {state}, not {wanted}"
        is_planned = not states.keys().isdisjoint(nodes)
        other = next(filter(None, (_active_at_another(seen, it) for it in nodes)), "")
        cause = "no node activates it: is that meant?"
        if manager or is_planned:
            cause = f"see the log of {manager or 'its lifecycle manager'}"
        elif other:
            cause = f"no node activates it, and {other} is {ACTIVE}"
        yield not_active.finding(
            message,
            f"{cause}; ros2 lifecycle get {nodes[0]}",
            level=ERROR if manager or is_planned or other else WARNING,
            robot=robot,
            node=nodes[0],
        )


def _active_at_another(seen: Index, node: str) -> str:
    """Return the active node of another robot with the same plain name; empty for none."""
    same = (it for it in seen.node.values() if it.lifecycle == ACTIVE and seen.robot(it.name))
    return next((it.name for it in same if seen.plain(it.name) == seen.plain(node)), "")


def _manager(seen: Index, node: str) -> str:
    """Return the node that changes the state of another one; empty for none."""
    clients = (end.node for end in seen.ends_at(SERVICE, f"{node}/change_state").clients)
    own = (it for it in clients if not (is_viewer(it) or is_tool(seen.plain(it))))
    return min(own, default="")


@system_rule("MG512", "interface-commanded-twice", ERROR)
def interface_commanded_twice(seen: Index) -> Iterator[Finding]:
    """Yield interfaces that two controllers command; a running manager refuses its own second one."""
    active = (it for it in seen.system.controllers if it.state == ACTIVE)
    claims = lists_by_key(
        ((seen.robot(it.manager), interface), it) for it in active for interface in it.claims
    )
    reported = set()
    for (robot, interface), found in claims.items():
        names = tuple((it.manager, it.name) for it in found)
        if len(set(names)) > 1 and (robot, names) not in reported:
            reported.add((robot, names))
            who = " and ".join(f"{name} of {node}" for node, name in names)
            message = f"{interface} is commanded by {who}"
            cause = "two controller managers for one robot: stop one, or unload its controller"
            settings: tuple[Setting, ...] = ()
            if len({it.manager for it in found}) == 1:
                cause = f"spawn {found[-1].name} with {INACTIVE}"
                settings = (Setting(found[-1].manager, INACTIVE, found[-1].name),)
            wanted, own = (CLAIMS, COMMAND, interface), {it.name for it in found}
            claimed = (it for it in seen.system.interfaces if (it.role, it.kind, it.name) == wanted)
            places = [it for it in claimed if last_word(it.node) in own]
            yield interface_commanded_twice.finding(
                message, cause + see_all(places), settings=settings,
                robot=robot, node=found[0].manager, names=(interface,), **last_place(places),
            )  # fmt: skip


@system_rule("MG513", "no-controller-active", WARNING)
def no_controller_active(seen: Index) -> Iterator[Finding]:
    """Yield managers without an active controller; some inactive ones next to active ones are usual."""
    kept = lists_by_key((it.manager, it) for it in seen.system.controllers)
    for manager, own in kept.items():
        if all(it.state != ACTIVE for it in own):
            listed = shorten((f"{it.name} ({it.state})" for it in own), SEVERAL)
            message = f"none of its controllers is active: {listed}"
            cause = f"ros2 control list_controllers -c {manager}; see the log of the spawners"
            yield no_controller_active.finding(
                message, cause, robot=seen.robot(manager), node=manager
            )


@system_rule("MG514", "use-sim-time-differs", WARNING)
def use_sim_time_differs(seen: Index) -> Iterator[Finding]:
    """Yield robots' nodes with other clocks; tools and bridges may have the machine's time."""
    told, planned = {it.robot for it in mixed_clocks(seen)}, planned_clocks(seen)
    by_robot: dict[str, dict[bool, list[str]]] = defaultdict(lambda: defaultdict(list))
    for node, simulated in clocks(seen.system).items():
        if not is_tool(seen.plain(node)) and node not in planned:
            by_robot[seen.robot(node)][simulated].append(node)
    for robot, found in by_robot.items():
        if len(found) < 2 or robot in told:
            continue
        odd = min((True, False), key=lambda it: len(found[it]))
        message = (
            f"{SIM_TIME} is {str(odd).lower()} for {shorten(sorted(found[odd]))}, and not for"
            f" {shorten(sorted(found[not odd]))}"
        )
        cause = to_set(SIM_TIME, parameter_text(not odd), *sorted(found[odd]))
        yield use_sim_time_differs.finding(
            message, f"{cause.hint}: it is the same for all nodes of a robot",
            settings=cause.settings, robot=robot, node=min(found[odd]),
        )  # fmt: skip


# So many doubled nodes are two robots rather than two nodes.
MANY = 3


@system_rule("MG301", "nodes-of-one-name", ERROR)
def nodes_of_one_name(seen: Index) -> Iterator[Finding]:
    """Report nodes of one name; many of them as one finding: two robots."""
    times = seen.nodes
    # Tools may run twice. Of two containers each gets the components of the other.
    twins = [
        name
        for name, count in times.items()
        if count > 1 and (not seen.is_tool(name) or name.endswith("_container"))
    ]
    by_robot = lists_by_key((seen.robot(name), name) for name in twins)
    for robot, names in by_robot.items():
        if len(names) >= MANY:
            cause = f"{robot} was started twice, or another robot was started with its namespace"
            bare = "two robots were started without a namespace: give each its own"
            yield nodes_of_one_name.finding(
                f"{len(names)} nodes run more than once: {shorten(names, SEVERAL)}",
                cause if robot else bare, robot=robot, node=names[0], names=tuple(names),
            )  # fmt: skip
            continue
        for name in names:
            yield nodes_of_one_name.finding(
                f"{times[name]} nodes have the name {name}",
                "start it once, or give each robot a namespace of its own; a node that was killed"
                " stays visible for 20 s",
                robot=robot, node=name,
            )  # fmt: skip


@system_rule("MG302", "managed-twice", ERROR)
def managed_twice(seen: Index) -> Iterator[Finding]:
    """Report all nodes with the same managers as one finding; an operator's tool does not count."""
    managed: dict[Sequence[str], list[str]] = defaultdict(list)
    for ends in seen.by_name.values():
        if ends.kind == SERVICE and ends.name.endswith(words.CHANGE_STATE):
            # Not those that do as a person wants.
            own = (it for it in ends.clients if not is_viewer(it.node))
            asked = nodes_of(it for it in own if not is_tool(seen.plain(it.node)))
            managed[asked].append(ends.name.removesuffix(words.CHANGE_STATE))
    for managers, nodes in managed.items():
        if len(managers) > 1:
            message = f"{and_then(managers)} all manage the life cycle of {shorten(sorted(nodes))}"
            robot = seen.robot(nodes[0])
            foreign = [it for it in managers if seen.robot(it) != robot]
            cause = Cause(
                f"one of them is too many: stop {foreign[-1] if foreign else managers[-1]}"
            )
            if 0 < len(foreign) < len(managers):
                cause = not_managed(seen, foreign[0], nodes)
            services = (
                f"{node}{end}" for node in nodes for end in (words.CHANGE_STATE, "/get_state")
            )
            yield managed_twice.finding(
                message, **cause._asdict(),
                robot=robot, node=managers[0], names=(*managers, *services),
            )  # fmt: skip


# What is done with it, what it is called besides its kind, and who does not give it.
_OF_HARDWARE = ("claims", " interface", "no ros2_control exports")
_WORDS = {JOINT: ("plans for", "", "no controller of MoveIt moves")}


class Missing(NamedTuple):
    """What a controller claims at one place and no hardware exports.

    ``near`` is what may be ``meant``, or another interface of the same joint, sensor or gpio."""

    claims: tuple[Interface, ...]
    near: Interface | None
    meant: str


def _not_exported(seen: Index) -> Iterator[Finding]:
    """Report missing interfaces if any hardware is known: another description may have them."""
    by_robot = lists_by_key((seen.robot(it.node), it) for it in seen.system.interfaces)
    for robot, known in by_robot.items():
        for it in missing(known):
            first, *more = it.claims
            does, needed, gives = _WORDS.get(first.kind, _OF_HARDWARE)
            also = f" and {len(more)} more" if more else ""
            near = [it.near] if it.near else []
            cause = f"did you mean {it.meant}" if it.meant else "name one that is there"
            yield interface_not_exported.finding(
                f"{does} {first.kind}{needed} {first.name}{also}, which {gives}",
                cause + see_all((*near, first)),
                level=NOTE if first.kind == JOINT else WARNING,
                robot=robot, node=first.node, names=(first.name,), **last_place([first]),
            )  # fmt: skip


interface_not_exported = declaration.NOT_EXPORTED._replace(check=_not_exported)


def missing(known: Sequence[Interface]) -> Iterator[Missing]:
    """Yield the claims without an export among one robot's interfaces, by controller and place."""
    exports = {(it.kind, it.name): it for it in known if it.role == EXPORTS}
    opened = lists_by_key(((it.node, it.place), it) for it in open_claims(known))
    hints = Guesses()
    for first, *more in opened.values():
        near = hints.nearest(first.name, [name for kind, name in exports if kind == first.kind])
        meant = exports.get((first.kind, near))
        owner = first.name.rpartition("/")[0]
        beside = (it for it in exports.values() if it.name.rpartition("/")[0] == owner)
        yield Missing((first, *more), meant or next(beside, None), near)


def missing_message(it: Missing, shown: Callable[..., str] | None) -> tuple[str, str]:
    """Return message and hint about a claim of one robot. Known places are ``shown`` so."""
    first, *more = it.claims
    also = f" and {len(more)} more" if more else ""
    line = f" ({shown(it.near.place)})" if it.near and shown else ""
    named = f"name an interface that is there{line}, or add it"
    message = (
        f"{first.node} claims {first.kind} interface {first.name}{also}, which no <ros2_control>"
    )
    return f"{message} exports", f"did you mean {it.meant}{line}?" if it.meant else named


def open_claims(known: Sequence[Interface]) -> list[Interface]:
    """Return the claims that nothing exports, without those of another controller's interfaces."""
    exports = {(it.kind, it.name) for it in known if it.role == EXPORTS}
    given = {kind == JOINT for kind, _ in exports}
    claims = [it for it in known if it.role == CLAIMS]
    chained = {last_word(it.node) for it in claims}
    return [
        it
        for it in claims
        if (it.kind == JOINT) in given
        and (it.kind, it.name) not in exports
        # Launch files fill in placeholders such as <namespace>.
        and not PLACEHOLDER.search(it.name)
        and it.name.partition("/")[0] not in chained - {last_word(it.node)}
    ]


def claims_any(known: Iterable[Interface]) -> bool:
    """Return whether the controllers claim any interface of this hardware, and so are for it."""
    sides: dict[str, set[tuple[str, str]]] = {EXPORTS: set(), CLAIMS: set()}
    for it in known:
        sides[it.role].add((it.kind, it.name))
    return not sides[EXPORTS].isdisjoint(sides[CLAIMS])


def _claimed_twice(seen: Index) -> Iterator[Finding]:
    """Report command interfaces that one controller claims by two parameters."""
    for other, it in claimed_twice(seen.system.interfaces):
        yield interface_claimed_twice.finding(
            f"claims {it.name} by two parameters", f"name another joint{see_all((other, it))}",
            robot=seen.robot(it.node), node=it.node, names=(it.name,), **last_place([it]),
        )  # fmt: skip


interface_claimed_twice = declaration.CLAIMED_TWICE._replace(check=_claimed_twice)


def claimed_twice(known: Iterable[Interface]) -> Iterator[tuple[Interface, Interface]]:
    """Yield command interfaces that one controller claims again, after the first claim."""
    first: dict[tuple[str, str], Interface] = {}
    for it in (it for it in known if (it.role, it.kind) == (CLAIMS, COMMAND)):
        other = first.setdefault((it.node, it.name), it)
        if other is not it:
            yield other, it
