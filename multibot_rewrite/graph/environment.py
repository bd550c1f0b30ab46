"""Whether the environment lets a graph be seen at all, and whether a view of it is whole. Pure.

Sources: rcl ``domain_id.c``, ``discovery_options.c``; rmw_fastrtps ``participant.cpp`` (32 peers
on a machine under LOCALHOST, else Fast DDS's own 4); the ROS 2 domain id page (0 to 232).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from math import inf
from typing import NamedTuple

from multibot_rewrite.graph.snapshot import (
    CHANGING,
    TIMEOUT,
    UNKNOWN_NODE,
    Caveat,
    GraphEndpoint,
    GraphNode,
)
from multibot_rewrite.model import UsageError

MAX_DOMAIN = 232
RANGES = ("OFF", "LOCALHOST", "SUBNET", "SYSTEM_DEFAULT")
DEFAULT_RANGE = "SUBNET"
KNOWN_RMW = (
    "rmw_fastrtps_cpp",
    "rmw_fastrtps_dynamic_cpp",
    "rmw_cyclonedds_cpp",
    "rmw_connextdds",
    "rmw_zenoh_cpp",
    "rmw_gurumdds_cpp",
)
# That many participants of a machine are asked by unicast: under LOCALHOST, of a peer under SUBNET.
LOCAL_LIMIT, PEER_LIMIT = 32, 4
# How a Fast DDS participant's group starts: the vendor, then four digits for its machine.
_FAST_DDS = "010f"
_SHOWN = 5
_NUMBER = re.compile(r"\s*\+?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
# rmw gives up on a host that it cannot look up; these are never one.
_NO_PEER = re.compile(r"[,\s]")


class Settings(NamedTuple):
    """What the environment variables ask of the middleware; ``rmw`` is empty for the default."""

    domain: int
    range: str
    static_peers: tuple[str, ...]
    rmw: str
    discovery_server: str
    super_client: bool


def settings(environ: Mapping[str, str]) -> Settings:
    """Read the variables as rcl does; raises UsageError where rcl would end the process."""
    return Settings(
        _domain(environ.get("ROS_DOMAIN_ID", "")),
        _range(environ),
        _peers(environ.get("ROS_STATIC_PEERS", "")),
        environ.get("RMW_IMPLEMENTATION", ""),
        environ.get("ROS_DISCOVERY_SERVER", ""),
        environ.get("ROS_SUPER_CLIENT", "").lower() in ("true", "1"),
    )


def _domain(text: str) -> int:
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
            f"ROS_DOMAIN_ID={text} is too high for its ports, give 0 to {MAX_DOMAIN} (101 or less"
            " keeps clear of the ports Linux hands out)"
        )
    return domain


def _peers(text: str) -> tuple[str, ...]:
    peers = tuple(filter(None, text.split(";")))
    for peer in peers:
        if _NO_PEER.search(peer):
            hint = "give host names or IPv4 addresses with nothing but ; between them"
            raise UsageError(f"ROS_STATIC_PEERS={text!r}: {peer!r} is no host, {hint}")
    return peers


def _range(environ: Mapping[str, str]) -> str:
    if _localhost_only(environ):
        return "LOCALHOST"
    word = environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "") or DEFAULT_RANGE
    return word if word in RANGES else "LOCALHOST"


def _localhost_only(environ: Mapping[str, str]) -> bool:
    return environ.get("ROS_LOCALHOST_ONLY", "") == "1"


def setting_caveats(environ: Mapping[str, str]) -> Iterator[Caveat]:
    """What is odd in the variables, though rcl starts with it, each with what to do."""
    asked = settings(environ)
    word = environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "")
    if _localhost_only(environ):
        text = "ROS_LOCALHOST_ONLY=1 overrides discovery range and static peers; unset it and set"
        yield Caveat("localhost-only", False, f"{text} ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST")
    elif word and word not in RANGES:
        text = f"ROS_AUTOMATIC_DISCOVERY_RANGE={word!r} is no range and read as LOCALHOST"
        yield Caveat("range-word", False, f"{text}; use one of {', '.join(RANGES)}")
    elif word == "OFF":
        text = (
            "ROS_AUTOMATIC_DISCOVERY_RANGE=OFF hides every other process; use LOCALHOST or SUBNET"
        )
        yield Caveat("range-off", True, text)
    elif word == "SYSTEM_DEFAULT" and asked.static_peers:
        text = "ROS_STATIC_PEERS is not read under range SYSTEM_DEFAULT, so their robots may not be"
        yield Caveat("peers-unread", True, f"{text} seen; use SUBNET or LOCALHOST, or unset it")
    rmw = environ.get("RMW_IMPLEMENTATION", "")
    if rmw and rmw not in KNOWN_RMW:
        text = (
            f"RMW_IMPLEMENTATION={rmw!r} is not a known one; usual are {', '.join(KNOWN_RMW[:3])}"
        )
        yield Caveat("rmw-word", False, text)
    if asked.discovery_server and not asked.super_client:
        text = "ROS_DISCOVERY_SERVER is set and ROS_SUPER_CLIENT is not: a plain client of a server"
        text = f"{text} sees nodes without their topics; set ROS_SUPER_CLIENT=TRUE"
        yield Caveat("no-super-client", False, text)


def view_caveats(
    nodes: Collection[GraphNode],
    endpoints: Collection[GraphEndpoint],
    asked: Settings,
    settled: str,
    expected: Iterable[str] = (),
) -> Iterator[Caveat]:
    """What to know about a view before anything in it is called missing."""
    names = Counter(node.name for node in nodes)
    if settled == TIMEOUT:
        text = "the graph was still changing when time was up; give a longer --timeout"
        yield Caveat("not-settled", True, text)
    if settled == CHANGING:
        yield Caveat("not-settled", True, "the graph is still changing")
    if not nodes:
        yield Caveat("nothing-seen", True, _nothing(asked))
    absent = sorted(set(expected) - set(names))
    if nodes and absent:
        text = f"expected and not seen: {listed(absent)}; are they started, is the name right?"
        yield Caveat("expected-not-seen", True, text)
    yield from _cut_off(endpoints, asked)
    yield from _unfinished(names, endpoints, asked)
    twins = [name for name, times in names.items() if times > 1]
    if twins:
        text = f"more than one node is called {listed(twins)}; what was killed hard stays for 20 s,"
        yield Caveat("same-name", False, f"{text} look again after that")


def _nothing(asked: Settings) -> str:
    """Where nothing was seen, and what that may come from."""
    where = f"domain {asked.domain}, range {asked.range}"
    remedy = "is it the robots' ROS_DOMAIN_ID and discovery range?"
    if asked.discovery_server:
        where += f", discovery server {asked.discovery_server}"
        remedy = "does the server run there, and do the robots use it?"
    elif asked.static_peers:
        where += f", peers {' '.join(asked.static_peers)}"
    elif asked.range == "LOCALHOST":
        remedy += " Robots on other machines: name these in ROS_STATIC_PEERS"
    return f"no node was seen ({where}); {remedy}"


def _cut_off(endpoints: Iterable[GraphEndpoint], asked: Settings) -> Iterator[Caveat]:
    """Where Fast DDS may have asked too few participants, as it does without multicast or server."""
    machines = Counter(map(_machine, _processes(endpoints)))
    if asked.discovery_server or not machines:
        return
    most = max(machines.values())
    if asked.range == "LOCALHOST" and most >= LOCAL_LIMIT:
        text = (
            f"{most} participants of one machine under LOCALHOST, where a late one sees"
            f" {LOCAL_LIMIT} at most: the view may be cut off; use range SUBNET for all, or a"
            " discovery server with ROS_SUPER_CLIENT=TRUE"
        )
        yield Caveat("participant-limit", True, text)
    known = [count for name, count in machines.items() if name]
    if asked.range == "SUBNET" and asked.static_peers and min(known, default=inf) <= PEER_LIMIT:
        text = (
            f"a machine shows no more than the {PEER_LIMIT} participants that Fast DDS asks of each"
            " static peer under SUBNET: without multicast the view is cut off; look with"
            f" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST, which asks {LOCAL_LIMIT}"
        )
        yield Caveat("peer-limit", True, text)


def _machine(process: str) -> str:
    """What the participants of one machine have in common; empty where that is not known."""
    return process[:8] if process.startswith(_FAST_DDS) else ""


def _unfinished(
    names: Collection[str], endpoints: Collection[GraphEndpoint], asked: Settings
) -> Iterator[Caveat]:
    """Nodes and endpoints that have not found one another."""
    bare = sorted(set(names) - {endpoint.node for endpoint in endpoints})
    if bare:
        remedy = "set ROS_SUPER_CLIENT=TRUE" if asked.discovery_server else "look again"
        text = f"nodes without any endpoint: {listed(bare)}: the view is not complete; {remedy}"
        yield Caveat("nodes-without-endpoints", True, text)
    unknown = sorted({end.name for end in endpoints if UNKNOWN_NODE in end.node})
    if unknown:
        text = f"endpoints whose node is not known yet, on {listed(unknown)}; look again"
        yield Caveat("node-name-unknown", True, text)


def participants(endpoints: Iterable[GraphEndpoint]) -> int:
    """How many DDS participants the endpoints come from."""
    return len(_processes(endpoints))


def _processes(endpoints: Iterable[GraphEndpoint]) -> set[str]:
    return {endpoint.process for endpoint in endpoints} - {""}


def listed(names: Collection[str]) -> str:
    """The first few of many names, and how many more there are."""
    few = ", ".join(list(names)[:_SHOWN])
    return few if len(names) <= _SHOWN else f"{few} and {len(names) - _SHOWN} more"
