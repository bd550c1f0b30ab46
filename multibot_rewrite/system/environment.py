# SPDX-License-Identifier: Apache-2.0
"""How discovery is set, how far a snapshot reached, and whether a view of the graph is whole. Pure.

Sources: rcl ``domain_id.c``, ``discovery_options.c``; rmw_fastrtps ``participant.cpp`` (32 peers
on a machine under LOCALHOST, else Fast DDS's own 4); the ROS 2 domain id page (0 to 232).

"Not seen from here" is "missing" only where a robot would have been seen."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from math import inf
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.system.records import (
    CHANGING,
    PUBLISHES,
    SERVES,
    TIMEOUT,
    UNKNOWN_NODE,
    WAITED_FOR,
    ZENOH,
    Caveat,
    End,
    Node,
    System,
)
from multibot_rewrite.system.words import is_hidden

MAX_DOMAIN = 232
LOCALHOST = "LOCALHOST"
RANGES = ("OFF", LOCALHOST, "SUBNET", "SYSTEM_DEFAULT")
KNOWN_RMW = (
    "rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp", "rmw_cyclonedds_cpp", "rmw_connextdds",
    "rmw_zenoh_cpp", "rmw_gurumdds_cpp",
)  # fmt: skip
# So many participants of a machine are found by unicast: under LOCALHOST, of a peer under SUBNET.
LOCAL_LIMIT, PEER_LIMIT = 32, 4
# The caveats of ``unfinished``.
WITHOUT_READERS = "nodes-without-readers"
UNFINISHED = ("nodes-without-endpoints", WITHOUT_READERS, "node-name-unknown")
# So many nodes have parameter services in a system where all have them, and this part of all.
SERVING, SERVING_PART = 5, 0.8
# How the process of a Fast DDS participant starts: the vendor, then four digits for its machine.
_FAST_DDS = "010f"
_NUMBER = lazy_compile(r"\s*\+?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
# Never in a host name; rmw gives up on a host that it cannot look up.
_NOT_IN_PEER = lazy_compile(r"[,\s]")


class DiscoverySettings(NamedTuple):
    """What the environment variables set for the middleware; ``rmw`` is empty for the default."""

    domain: int
    range: str
    static_peers: tuple[str, ...]
    rmw: str
    discovery_server: str
    super_client: bool


def settings(environ: Mapping[str, str]) -> DiscoverySettings:
    """Return the discovery settings as rcl reads them; raises UsageError where rcl exits."""
    domain = _parse_domain_id(environ.get("ROS_DOMAIN_ID", ""))
    text = environ.get("ROS_STATIC_PEERS", "")
    peers = tuple(filter(None, text.split(";")))
    for peer in peers:
        if _NOT_IN_PEER.search(peer):
            hint = "give host names or IPv4 addresses with only ; between them"
            raise UsageError(f"ROS_STATIC_PEERS={text!r}: {peer!r} is not a host, {hint}")
    range_ = environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "") or "SUBNET"
    return DiscoverySettings(
        domain,
        range_ if range_ in RANGES and environ.get("ROS_LOCALHOST_ONLY") != "1" else LOCALHOST,
        peers,
        environ.get("RMW_IMPLEMENTATION", ""),
        environ.get("ROS_DISCOVERY_SERVER", ""),
        environ.get("ROS_SUPER_CLIENT", "").lower() in ("true", "1"),
    )


def _parse_domain_id(text: str) -> int:
    if not text:
        return 0
    found = _NUMBER.fullmatch(text)
    if not found:
        raise UsageError(f"ROS_DOMAIN_ID={text!r} is not a number, give 0 to {MAX_DOMAIN}")
    digits = found[1]
    # rcl reads it with strtoul and base 0: a leading 0 makes it octal.
    octal = digits.startswith("0") and digits.isdigit()
    domain = int(digits, 8 if octal else 0)
    if domain > MAX_DOMAIN:
        raise UsageError(
            f"ROS_DOMAIN_ID={text} is too high, give 0 to {MAX_DOMAIN} (101 or less avoids the"
            " ports that Linux uses itself)"
        )
    return domain


def setting_caveats(environ: Mapping[str, str]) -> Iterator[Caveat]:
    """Yield problems in the variables that rcl accepts, each with what to do."""
    asked = settings(environ)
    word = environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "")
    if environ.get("ROS_LOCALHOST_ONLY") == "1":
        text = "ROS_LOCALHOST_ONLY=1 overrides discovery range and static peers; unset it and set"
        yield Caveat("localhost-only", False, f"{text} ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST")
    elif word and word not in RANGES:
        text = f"ROS_AUTOMATIC_DISCOVERY_RANGE={word!r} is not a range, rcl takes LOCALHOST"
        yield Caveat("range-word", False, f"{text}; use one of {', '.join(RANGES)}")
    elif word == "OFF":
        text = (
            "ROS_AUTOMATIC_DISCOVERY_RANGE=OFF hides all other processes; use LOCALHOST or SUBNET"
        )
        yield Caveat("range-off", True, text)
    elif word == "SYSTEM_DEFAULT" and asked.static_peers:
        text = (
            "ROS_STATIC_PEERS is not read under range SYSTEM_DEFAULT, so robots of the peers may be"
            " missing; use SUBNET or LOCALHOST, or unset it"
        )
        yield Caveat("peers-unread", True, text)
    rmw = environ.get("RMW_IMPLEMENTATION", "")
    if rmw and rmw not in KNOWN_RMW:
        text = f"RMW_IMPLEMENTATION={rmw!r} is unknown; use for example {', '.join(KNOWN_RMW[:3])}"
        yield Caveat("rmw-word", False, text)
    if asked.discovery_server and not asked.super_client:
        text = (
            "ROS_DISCOVERY_SERVER is set without ROS_SUPER_CLIENT: nodes may be seen without their"
            " topics; set ROS_SUPER_CLIENT=TRUE"
        )
        yield Caveat("no-super-client", False, text)


def view_caveats(
    nodes: Collection[Node],
    endpoints: Collection[End],
    asked: DiscoverySettings,
    settled: str,
    expected: Iterable[str] = (),
    last: Collection[str] = (),
) -> Iterator[Caveat]:
    """Yield the limitations of a view; ``last`` are the names that came or went last."""
    names = Counter(node.name for node in nodes)
    if settled == TIMEOUT:
        which = f" (last came or went {shorten(sorted(last), SEVERAL)})" if last else ""
        text = f"the graph was still changing when the timeout was over{which}"
        yield Caveat("not-settled", True, f"{text}; give a longer --timeout")
    if settled == CHANGING:
        yield Caveat("not-settled", True, "the graph is still changing")
    if not nodes:
        yield Caveat("nothing-seen", True, _nothing_seen_message(asked))
    absent = sorted({*expected} - {*names, *(it.name for it in endpoints)})
    if nodes and absent:
        missing = shorten(absent, SEVERAL)
        text = f"expected names not in the graph: {missing}; is all started, are the names right?"
        yield Caveat(WAITED_FOR, True, text)
    yield from _cut_off(endpoints, asked)
    yield from unfinished(nodes, endpoints, asked.discovery_server)
    twins = [name for name, times in names.items() if times > 1]
    if twins:
        text = (
            f"several nodes have the name {shorten(twins, SEVERAL)}; a node that was killed stays"
            " visible for 20 s, look again after that"
        )
        yield Caveat("same-name", False, text)


def _nothing_seen_message(asked: DiscoverySettings) -> str:
    """Return the message if no node was seen: where, and the likely reason."""
    where = f"domain {asked.domain}, range {asked.range}"
    remedy = "do the robots use this ROS_DOMAIN_ID and discovery range?"
    if asked.discovery_server:
        where += f", discovery server {asked.discovery_server}"
        remedy = "is the server running there, and do the robots use it?"
    elif asked.static_peers:
        where += f", peers {' '.join(asked.static_peers)}"
    elif asked.range == "LOCALHOST":
        remedy += " For robots on other machines set ROS_STATIC_PEERS"
    else:
        remedy += " On other machines they may be hidden: multicast is lost, or they are on range"
        remedy += " LOCALHOST; set ROS_STATIC_PEERS, or take the snapshot there"
    return f"no node was seen ({where}); {remedy}"


def _cut_off(endpoints: Iterable[End], asked: DiscoverySettings) -> Iterator[Caveat]:
    """Report that Fast DDS may have found too few participants, without multicast or a server."""
    machines = Counter(map(machine, {it.process for it in endpoints} - {""}))
    if asked.discovery_server or not machines:
        return
    most = max(machines.values())
    if asked.range == "LOCALHOST" and most >= LOCAL_LIMIT:
        text = (
            f"{most} participants of one machine under LOCALHOST, where Fast DDS finds at most"
            f" {LOCAL_LIMIT}: the view may be cut off; use range SUBNET for all, or a discovery"
            " server with ROS_SUPER_CLIENT=TRUE"
        )
        yield Caveat("participant-limit", True, text)
    known = [count for name, count in machines.items() if name]
    if asked.range == "SUBNET" and asked.static_peers and min(known, default=inf) <= PEER_LIMIT:
        text = (
            f"{PEER_LIMIT} participants or fewer are seen of a machine, and the view may be cut off;"
            " Fast DDS finds no more on a static peer under SUBNET without multicast; use"
            f" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST, which finds {LOCAL_LIMIT}"
        )
        yield Caveat("peer-limit", True, text)


def machine(process: str) -> str:
    """Return what identifies the machine of a process; empty where it is unknown."""
    return process[:8] if process.startswith(_FAST_DDS) else ""


def unfinished(
    nodes: Iterable[Node], endpoints: Collection[End], discovery_server: str
) -> Iterator[Caveat]:
    """Report nodes without endpoints, and endpoints without a known node: discovery is unfinished."""
    bare = sorted({node.name for node in nodes} - {endpoint.node for endpoint in endpoints})
    if bare:
        remedy = "set ROS_SUPER_CLIENT=TRUE" if discovery_server else "look again"
        text = f"nodes without any endpoint: {shorten(bare, SEVERAL)}; the view is not complete,"
        yield Caveat("nodes-without-endpoints", True, f"{text} {remedy}")
    if half := _without_readers(endpoints):
        text = (
            f"nodes that only publish and have no parameter services, as the others have:"
            f" {shorten(half, SEVERAL)}; their other endpoints may not be seen yet, look again"
        )
        yield Caveat(WITHOUT_READERS, True, text)
    unknown = sorted({end.name for end in endpoints if UNKNOWN_NODE in end.node})
    if unknown:
        text = f"endpoints whose node is not known yet: {shorten(unknown, SEVERAL)}; look again"
        yield Caveat("node-name-unknown", True, text)


def _without_readers(endpoints: Collection[End]) -> list[str]:
    """Return nodes of which only publishers are seen yet: nearly all others serve parameters."""
    roles = sets_by_key((it.node, it.role) for it in endpoints)
    served = (it for it in endpoints if it.role == SERVES)
    serving = {it.node for it in served if it.name.endswith("/get_parameters")}
    if len(serving) < max(SERVING, SERVING_PART * len(roles)):
        return []
    return sorted(it for it, own in roles.items() if own == {PUBLISHES} and not is_hidden(it))


def participants(endpoints: Iterable[End]) -> int:
    """Return how many DDS participants the endpoints belong to."""
    return len({it.process for it in endpoints} - {""})


# The nodes of each machine.
Machines = Mapping[str, Sequence[str]]


def machines(graph: System) -> Machines:
    """Return the nodes of each machine by its Fast DDS id; empty with Zenoh, which has none."""
    nodes = graph.nodes if graph.environment.rmw != ZENOH else ()
    return lists_by_key((host, it.name) for it in nodes if (host := machine(it.process)))


def hidden_from_here(graph: System, seen: Machines) -> bool:
    """Return whether a robot on another machine may run unseen: nodes of one machine were seen.

    Then multicast may be lost, or the other machine keeps to itself. Under LOCALHOST without peers
    only this machine was asked for, and a discovery server or a router knows all that use it."""
    around = graph.environment
    asked_for_all = around.range not in (LOCALHOST, "OFF") or bool(around.static_peers)
    one_look = not any(it.code == "looks-merged" for it in around.caveats)
    return asked_for_all and one_look and not around.discovery_server and len(seen) == 1


def why_not_seen(graph: System, robot: str, seen: Machines) -> str:
    """Return where ``robot`` may be, as far as known, and what to do, in one sentence."""
    around = graph.environment
    if around.rmw == ZENOH:
        router = around.discovery_server
        return f"is it started, in this domain, and connected to the router at {router}?"
    if around.discovery_server:
        return f"is it started, and does it use the discovery server {around.discovery_server}?"
    if hidden_from_here(graph, seen):
        (names,) = seen.values()
        return (
            f"all that is seen runs on one machine ({shorten(names)}). If {robot} is on another,"
            " multicast may be lost, or it is on range LOCALHOST. Set ROS_STATIC_PEERS to its"
            " address, or take a snapshot there and join them (multibot snapshot --from). If all"
            " robots are to be on this machine set ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"
        )
    started = "is the robot started, and with this ROS_DOMAIN_ID?"
    if around.range == LOCALHOST and not around.static_peers:
        return f"{started} Only this machine is checked: range LOCALHOST, no ROS_STATIC_PEERS"
    return f"{started} {plural(len(seen), 'machine')} are seen" if len(seen) > 1 else started
