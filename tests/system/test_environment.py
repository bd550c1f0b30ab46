# SPDX-License-Identifier: Apache-2.0
"""What the variables of discovery say, and what a view of the graph may not have seen."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.system.environment import (
    DiscoverySettings,
    settings,
    unfinished,
    view_caveats,
)
from multibot_rewrite.system.records import (
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    UNKNOWN_NODE,
    End,
    Node,
)

USUAL = DiscoverySettings(0, "SUBNET", (), "", "", False)


def end(process: str, node: str = "/driver", name: str = "/scan") -> End:
    return End(TOPIC, PUBLISHES, name, "", "", node, None, process)


def ends(*counts: int, start: str = "010f") -> tuple[End, ...]:
    """So many participants of each machine."""
    return tuple(
        end(f"{start}{at:04d}{number:04d}")
        for at, count in enumerate(counts)
        for number in range(count)
    )


@pytest.mark.parametrize(
    ("text", "domain"),
    [
        ("", 0),
        ("7", 7),
        ("0", 0),
        (" +42", 42),
        ("010", 8),
        ("10", 10),
        ("0x1F", 31),
        ("0X1f", 31),
        ("232", 232),
    ],
)
def test_a_domain_is_read_as_strtoul_does(text: str, domain: int) -> None:
    """rcl domain_id.c: base 0, so 010 is octal."""
    assert settings({"ROS_DOMAIN_ID": text}).domain == domain


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("variables", "asked"),
    [
        ({}, USUAL),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, USUAL._replace(range="OFF")),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, USUAL._replace(range="LOCALHOST")),
        (
            {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"},
            USUAL._replace(range="SYSTEM_DEFAULT"),
        ),
        # A word that is none.
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "subnet"}, USUAL._replace(range="LOCALHOST")),
        (
            {"ROS_LOCALHOST_ONLY": "1", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"},
            USUAL._replace(range="LOCALHOST"),
        ),
        ({"ROS_LOCALHOST_ONLY": "0"}, USUAL),
        ({"ROS_STATIC_PEERS": ";a;;10.0.0.1;"}, USUAL._replace(static_peers=("a", "10.0.0.1"))),
        ({"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}, USUAL._replace(rmw="rmw_zenoh_cpp")),
        ({"ROS_DISCOVERY_SERVER": "h:1"}, USUAL._replace(discovery_server="h:1")),
        ({"ROS_SUPER_CLIENT": "True"}, USUAL._replace(super_client=True)),
        ({"ROS_SUPER_CLIENT": "1"}, USUAL._replace(super_client=True)),
        ({"ROS_SUPER_CLIENT": "yes"}, USUAL),
    ],
)
def test_variables_are_read_as_rcl_reads_them(
    variables: dict[str, str], asked: DiscoverySettings
) -> None:
    assert settings(variables) == asked


@pytest.mark.parametrize("peers", ["a,b", "a b", "a;b c"])
def test_peers_that_are_no_hosts_are_refused(peers: str) -> None:
    with pytest.raises(UsageError, match="only ; between them"):
        settings({"ROS_STATIC_PEERS": peers})


def codes(
    count: int = 1,
    seen: tuple[End, ...] = (),
    settled: str = "quiet",
    expected: tuple[str, ...] = (),
    **asked: object,
) -> list[tuple[str, bool]]:
    nodes = [Node("/driver")] * count
    seen = seen or (end("") if count else end("", ""),)
    found = view_caveats(nodes, seen, USUAL._replace(**asked), settled, expected)
    return [(it.code, it.incomplete) for it in found]


def test_a_caveat_names_what_came_or_went_last_and_what_did_not_come() -> None:
    seen = [Node("/a"), Node("/b"), Node("/b"), Node("/bare")]
    ends = [end("", "/a"), end("", "/b")]
    still = "the graph was still changing when the timeout was over"
    found = view_caveats(seen, ends, USUAL, "timeout", ("/y", "/x", "/a"), ("/q", "/p"))
    assert [it.message.partition(";")[0] for it in found] == [
        f"{still} (last came or went /p, /q)",
        "expected names not in the graph: /x, /y",
        "nodes without any endpoint: /bare",
        "several nodes have the name /b",
    ]
    (first,) = view_caveats(seen[:2], ends, USUAL, "timeout")
    assert first.message == f"{still}; give a longer --timeout"


def test_a_view_says_what_it_may_not_have_seen() -> None:
    assert codes(settled="timeout") == codes(settled="changing") == [("not-settled", True)]
    assert codes(0, expected=("/driver",)) == [("nothing-seen", True)]
    assert codes(expected=("/other",)) == [("expected-not-seen", True)]
    assert codes(2) == [("same-name", False)]


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("seen", "asked", "found"),
    [
        (ends(32), {"range": "LOCALHOST"}, ["participant-limit"]),
        (ends(31), {"range": "LOCALHOST"}, []),
        (ends(31, 31), {"range": "LOCALHOST"}, []),
        (ends(1, 32), {"range": "LOCALHOST"}, ["participant-limit"]),
        (ends(32), {"range": "SUBNET"}, []),
        (ends(32), {"range": "LOCALHOST", "discovery_server": "h"}, []),
        (ends(4, 9), {"static_peers": ("h",)}, ["peer-limit"]),
        (ends(5, 9), {"static_peers": ("h",)}, []),
        (ends(4), {}, []),
        (ends(4), {"static_peers": ("h",), "range": "LOCALHOST"}, []),
        # Of another vendor: the machine is not known, nor its limit.
        (ends(4, start="0110"), {"static_peers": ("h",)}, []),
    ],
)
def test_fast_dds_finds_so_many_participants_of_a_machine(
    seen: tuple[End, ...], asked: dict[str, object], found: list[str]
) -> None:
    """rmw_fastrtps participant.cpp: 32 under LOCALHOST, 4 of a static peer."""
    assert codes(seen=seen, **asked) == [(it, True) for it in found]


@pytest.mark.parametrize(
    ("asked", "where", "remedy"),
    [
        (
            {},
            "(domain 0, range SUBNET)",
            "On other machines they may be hidden: multicast is lost, or they are on range"
            " LOCALHOST; set ROS_STATIC_PEERS, or take the snapshot there",
        ),
        ({"domain": 7, "range": "LOCALHOST"}, "(domain 7, range LOCALHOST)", "For robots on other"),
        ({"static_peers": ("a", "b")}, "(domain 0, range SUBNET, peers a b)", "discovery range?"),
        (
            {"discovery_server": "h:1", "static_peers": ("a",)},
            "(domain 0, range SUBNET, discovery server h:1)",
            "is the server running there",
        ),
    ],
)
def test_an_empty_view_says_where_it_looked_and_what_to_try(
    asked: dict[str, object], where: str, remedy: str
) -> None:
    (found,) = view_caveats([], [], USUAL._replace(**asked), "quiet")
    assert where in found.message
    assert remedy in found.message


def test_discovery_is_not_finished_while_a_node_or_its_ends_are_missing() -> None:
    hidden = (end("", f"/{UNKNOWN_NODE}", f"/{it}") for it in ("scan", "odom", "imu"))
    nodes = [Node(it) for it in ("/lidar", "/driver", "/camera", "/arm")]
    bare, unknown = unfinished(nodes, (*hidden, end("", "/lidar")), "")
    assert bare.message == (
        "nodes without any endpoint: /arm, /camera, /driver; the view is not complete, look again"
    )
    assert (
        unknown.message == "endpoints whose node is not known yet: /imu, /odom, /scan; look again"
    )
    (served,) = unfinished([Node("/driver")], [], "h:1")
    assert served.message.endswith("set ROS_SUPER_CLIENT=TRUE")
    assert (bare.incomplete, unknown.incomplete, served.incomplete) == (True, True, True)


def serving(node: str, namespace: str = "/robot1") -> tuple[End, ...]:
    """Return the ends that every node has, as far as they count here."""
    name = f"{namespace}/{node}"
    service = End(SERVICE, SERVES, f"{name}/get_parameters", "", "", name, None, "p")
    return service, end("p", name, f"{name}/out")


MANY = tuple(own for it in range(6) for own in serving(f"node{it}"))


@pytest.mark.parametrize(
    ("more", "half"),
    [
        pytest.param((), "", id="all seen"),
        pytest.param((end("p", "/robot1/lidar"), end("p", "/robot1/lidar", "/odom")), "/robot1/lidar",
                     id="its readers have not come yet"),
        pytest.param((end("p", "/robot1/_hidden"),), "", id="a tool, which is made without services"),
        pytest.param((end("p", "/lidar"), End(TOPIC, SUBSCRIBES, "/odom", "", "", "/lidar", None, "p")),
                     "", id="it reads: it is made without services"),
        pytest.param((end("p", "/a"), end("p", "/b")), "", id="a quarter has none: so it is here"),
    ],
)  # fmt: skip
def test_a_node_of_which_only_publishers_came_is_seen_in_half(
    more: tuple[End, ...], half: str
) -> None:
    ends = (*MANY, *more)
    nodes = [Node(it) for it in {it.node for it in ends}]
    found = [it for it in unfinished(nodes, ends, "") if it.code == "nodes-without-readers"]
    assert [it.incomplete for it in found] == [True] * bool(half)
    assert half in "".join(it.message for it in found)
    # Of a few nodes nobody can say what all have.
    few = [it for it in ends if it.node[-1] in "01r"]
    assert not [*unfinished([], few, "")]
