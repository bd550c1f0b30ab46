# SPDX-License-Identifier: Apache-2.0
"""What a plan lets each robot say and hear, as key expressions; expectations by hand."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from paths import ROBOTS
from plans import PlannedRobot, planned, planned_end

from multibot_rewrite.base.conventions import SENT_BY_ANY_NODE
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.outputs.zenoh_access import (
    FLEET_ROUTER,
    OWN_ROUTER,
    Rights,
    rights,
    robot_rules,
)
from multibot_rewrite.fleet.outputs.zenoh_configuration import Setup, configurations
from multibot_rewrite.planning.domain_bridge import with_bridges
from multibot_rewrite.system.records import Domain, End, Node, System


def made(*robots: tuple[str, str, str], ends: tuple[End, ...] = ()) -> System:
    """Robots as (name, node, tf topic)."""
    fleet = tuple(PlannedRobot(name, (node,), (), tf) for name, node, tf in robots)
    return planned("both", fleet, (), ("/clock", "/map"), (), ends)


def end(node: str, kind: str, role: str, name: str) -> End:
    return planned_end(node, kind, role, name, "", "")


def of(plan: System, domain: int = 0) -> Rights:
    return rights(plan, domain)[0]


NAMESPACED = (("robot1", "/robot1/a", "/robot1/tf"), ("robot2", "/robot2/a", "/robot2/tf"))


def test_a_namespace_is_the_robots_own() -> None:
    given = of(made(*NAMESPACED), 7)
    assert given.own == ("7/robot1/**", "7/robot1/**/@adv/**")
    assert not any("robot" in key for key in (*given.sends, *given.hears))
    assert "7/map/*/*" in given.hears and "7/map/*/*" not in given.sends


def test_two_levels_of_namespaces() -> None:
    robots = (("r1", "/fleet/r1/a", "/fleet/r1/tf"), ("r2", "/fleet/r2/a", "/fleet/r2/tf"))
    assert of(made(*robots)).own[0] == "0/fleet/r1/**"


def test_a_namespace_that_starts_like_another_is_another() -> None:
    robots = (("robot1", "/robot1/a", "/robot1/tf"), ("robot10", "/robot10/a", "/robot10/tf"))
    assert of(made(*robots)).own[0] == "0/robot1/**"


def test_a_namespace_of_two_robots_is_nobodys_own() -> None:
    robots = (("r1", "/fleet/a_r1", "/tf"), ("r2", "/fleet/a_r2", "/tf"))
    ends = (end("/fleet/a_r1", "topic", "publishes", "/fleet/odom/r1"),)
    given = of(made(*robots, ends=ends))
    # Its parameter services, and what the plan has.
    assert given.own == ("0/fleet/a_r1/*/*/*", "0/fleet/a_r1/*/*/*/@adv/**")
    assert "0/fleet/odom/r1/*/*" in given.sends
    assert "0/fleet/odom/r1/*/*" not in given.hears


def test_names_outside_of_the_namespace_by_direction() -> None:
    ends = (
        end("/robot1/a", "topic", "publishes", "/report"),
        end("/robot1/a", "topic", "subscribes", "/orders"),
        end("/robot1/a", "service", "serves", "/stop"),
        end("/robot1/a", "service", "calls", "/map_server/load"),
        end("/robot1/a", "action", "calls", "/lift"),
        end("/robot2/a", "topic", "publishes", "/secret"),
    )
    given = of(made(*NAMESPACED, ends=ends))
    assert {"0/report/*/*", "0/stop/*/*", "0/stop/*/*/@adv/**"} <= set(given.sends)
    assert {"0/orders/*/*", "0/map_server/load/*/*", "0/lift/_action/*/*/*"} <= set(given.hears)
    assert {"0/report/*/*", "0/stop/*/*"}.isdisjoint(given.hears)
    assert not any("secret" in key for key in (*given.sends, *given.hears))


def test_tf_of_all_robots_is_heard_and_sent() -> None:
    given = of(made(("r1", "/a_r1", "/tf/r1"), ("r2", "/a_r2", "/tf/r2")))
    for keys in (given.sends, given.hears):
        assert {"0/tf/r1/*/*", "0/tf_static/r1/*/*"} <= set(keys)
        assert not any("r2" in key for key in keys)


def test_a_robot_with_a_domain_of_its_own_is_kept_to_it() -> None:
    """But for its domain_bridge, whose other node is in the domain of all (domain_bridge.cpp)."""
    ends = tuple(
        planned_end(node, "topic", role, f"/{robot}/odom", "nav_msgs/msg/Odometry", "odom")
        for robot in ("robot1", "robot2")
        for node, role in ((f"/{robot}/a", "publishes"), ("/monitor", "subscribes"))
    )
    plan = made(*NAMESPACED, ends=ends)
    plan = plan._replace(nodes=(*plan.nodes, Node("/monitor")))
    numbers = {"": 10, "robot1": 11, "robot2": 12}
    plan = with_bridges(plan._replace(domains=tuple(Domain(*it) for it in numbers.items())))
    one, two = rights(plan, 0)
    assert one.own[0] == "11/robot1/**" and two.own[0] == "12/robot2/**"
    assert (one.domains, two.domains) == ((11, 10), (12, 10))
    assert "10/robot1/odom/*/*" in one.sends and "10/robot1/odom/*/*" not in one.hears
    every = [key for it in (one.own, one.sends, one.hears) for key in it]
    assert not any("robot2" in key or key.startswith(("0/", "12/")) for key in every)
    # Of the domain of all nothing but what crosses, and what every node sends.
    shared = {key for key in every if key.startswith("10/") and "@adv" not in key}
    topics = {key for key in shared if "robot1" in key}
    assert topics == {"10/robot1/odom/*/*", "10/robot1_bridge_10/**"}
    assert shared - topics <= {f"10{it}/*/*" for it in SENT_BY_ANY_NODE}


def test_a_router_has_the_flows_the_other_way_round() -> None:
    given = of(made(*NAMESPACED))
    flows = {str(it["id"]): it["flows"] for it in robot_rules(given)}
    mirrored = {str(it["id"]): it["flows"] for it in robot_rules(given, FLEET_ROUTER)}
    assert (flows["robot1_sends"], flows["robot1_hears"]) == (["egress"], ["ingress"])
    assert (mirrored["robot1_sends"], mirrored["robot1_hears"]) == (["ingress"], ["egress"])
    own = {str(it["id"]): it["flows"] for it in robot_rules(given, OWN_ROUTER)}
    assert own["robot1_sends"] == own["robot1_hears"] == ["egress", "ingress"]
    assert flows["robot1_own"] == mirrored["robot1_own"] == ["egress", "ingress"]


def test_files_and_certificates() -> None:
    setup = Setup("tcp/10.0.0.1:7000", 0, "/keys", ("/ops/desk",))
    files = {
        name: json.loads(data.partition(b"\n")[2])
        for name, data in configurations(made(*NAMESPACED), setup)
    }
    assert list(files) == ["router.json5", "robot1.json5", "robot2.json5", "ops_desk.json5"]
    router, robot = files["router.json5"], files["robot1.json5"]
    assert router["listen"]["endpoints"] == ["tls/0.0.0.0:7000"]
    assert robot["connect"]["endpoints"] == ["tls/10.0.0.1:7000"]
    tls = robot["transport"]["link"]["tls"]
    assert tls["connect_private_key"] == "/keys/enclaves/robot1/key.pem"
    assert tls["enable_mtls"] is True
    names = [it["cert_common_names"] for it in router["access_control"]["subjects"]]
    assert names == [["/robot1"], ["/robot2"], ["/ops/desk"]]
    assert router["access_control"]["default_permission"] == "deny"
    assert "access_control" not in files["ops_desk.json5"]


# rmw_zenoh 30f3030 DEFAULT_RMW_ZENOH_SESSION_CONFIG.json5: the values with "ROS setting".
FOR_ROS = {
    "scouting": {"multicast": {"enabled": False}},
    "timestamping": {"enabled": {"router": True, "peer": True, "client": True}},
    "queries_default_timeout": 60000,
    "transport": {
        "unicast": {
            "open_timeout": 60000, "accept_timeout": 60000, "accept_pending": 10000,
            "max_sessions": 10000,
        },
        "link": {
            "tx": {
                "lease": 60000, "keep_alive": 2,
                "queue": {"congestion_control": {"block": {"wait_before_close": 60000000}}},
            }
        },
    },
}  # fmt: skip
SENDS = ["put", "delete", "reply", "declare_queryable"]
ASKS = ["declare_subscriber", "query"]
ALIVE = ["liveliness_token", "liveliness_query", "declare_liveliness_subscriber", "reply"]


def test_the_whole_file_of_a_robot() -> None:
    """zenoh DEFAULT_CONFIG.json5 has the words of access_control and of its messages."""
    plan = made(("robot1", "/robot1/a", "/robot1/tf"))
    files = dict(configurations(plan, Setup("tcp/host:7447", 3)))
    about, _, text = files["robot1.json5"].decode().partition("\n")
    uri = "export ZENOH_SESSION_CONFIG_URI=robot1.json5 (its full path)"
    assert about == f"// The nodes of robot1: {uri}."
    config = json.loads(text)
    control = config.pop("access_control")
    assert config == {"mode": "client", "connect": {"endpoints": ["tcp/host:7447"]}, **FOR_ROS}
    rules = control.pop("rules")
    ids = ["own", "sends", "is_asked", "hears", "asks", "graph"]
    assert [it["id"] for it in rules] == [f"robot1_{it}" for it in ids]
    said = [(it["messages"], it["flows"]) for it in rules]
    both, out, back = ["egress", "ingress"], ["egress"], ["ingress"]
    assert said == [
        (SENDS + ASKS, both), (SENDS, out), (ASKS, back), (SENDS, back), (ASKS, out), (ALIVE, both),
    ]  # fmt: skip
    assert {it["permission"] for it in rules} == {"allow"}
    assert rules[0].keys() == {"id", "messages", "flows", "permission", "key_exprs"}
    assert rules[0]["key_exprs"] == ["3/robot1/**", "3/robot1/**/@adv/**"]
    assert rules[-1]["key_exprs"] == ["@ros2_lv/3/**", "3/**/@adv/**"]
    assert control == {
        "enabled": True, "default_permission": "deny", "subjects": [{"id": "anybody"}],
        "policies": [{"rules": [f"robot1_{it}" for it in ids], "subjects": ["anybody"]}],
    }  # fmt: skip
    router = json.loads(files["router.json5"].decode().partition("\n")[2])
    assert router == {"mode": "router", "listen": {"endpoints": ["tcp/0.0.0.0:7447"]}, **FOR_ROS}


def test_certificates_are_those_of_the_enclave() -> None:
    """zenoh_security_tools; sros2 has these files in the folder of an enclave."""
    plan = made(("robot1", "/robot1/a", "/robot1/tf"))
    setup = Setup("tcp/host:7447", 0, "/keys", ("/ops/all",), own_routers=True)
    files = {
        name: json.loads(text.decode().partition("\n")[2])
        for name, text in configurations(plan, setup)
    }
    for name, enclave, protocols in (
        ("router.json5", "/router", ["tls"]), ("ops_all.json5", "/ops/all", ["tls"]),
        ("robot1_router.json5", "/robot1", ["tls", "tcp"]),
    ):  # fmt: skip
        link = files[name]["transport"]["link"]
        folder = f"/keys/enclaves{enclave}"
        assert link["protocols"] == protocols
        assert link["tls"] == {
            "enable_mtls": True, "verify_name_on_connect": False,
            "root_ca_certificate": f"{folder}/identity_ca.cert.pem",
            **{f"{it}_private_key": f"{folder}/key.pem" for it in ("listen", "connect")},
            **{f"{it}_certificate": f"{folder}/cert.pem" for it in ("listen", "connect")},
        }  # fmt: skip
    subjects = [{"id": it, "cert_common_names": [it]} for it in ("/robot1", "/ops/all")]
    control = files["router.json5"]["access_control"]
    assert control["subjects"] == subjects
    keys = ["0/**", "0/**/@adv/**", "@ros2_lv/**"]
    assert (control["rules"][-1]["id"], control["rules"][-1]["key_exprs"]) == ("/ops/all", keys)
    assert control["rules"][-1]["messages"] == [*SENDS, *ASKS, *ALIVE[:-1]]


def test_robots_with_routers_of_their_own() -> None:
    setup = Setup("tcp/10.0.0.1:7000", 0, "/keys", (), True)
    files = {
        name: json.loads(data.partition(b"\n")[2])
        for name, data in configurations(made(*NAMESPACED), setup)
    }
    session, own = files["robot1.json5"], files["robot1_router.json5"]
    # As rmw_zenoh has them by default: peers beside the router on their machine.
    assert (session["mode"], session["connect"]["endpoints"]) == ("peer", ["tcp/localhost:7447"])
    assert "tls" not in session["transport"]["link"]
    assert own["listen"]["endpoints"] == ["tcp/localhost:7447"]
    assert own["connect"]["endpoints"] == ["tls/10.0.0.1:7000"]
    assert own["transport"]["link"]["protocols"] == ["tls", "tcp"]


def test_without_certificates_the_router_lets_all_in() -> None:
    """It cannot tell robots apart; their own files keep them apart."""
    (_, router), (_, robot), _ = configurations(made(*NAMESPACED), Setup("tcp/h:1", 0))
    assert b"access_control" not in router and b"tls" not in router
    assert b'"default_permission": "deny"' in robot


FLEET = """\
layout: frames-per-robot
description: rover.urdf
node_sets: [nav2]
robots: [{name: robot1}, {name: robot2}]
zenoh:
"""


def built(folder: Path, keys: str) -> int:
    """Build a fleet with these keys of Zenoh into ``folder/out``."""
    (folder / "rover.urdf").write_bytes((ROBOTS / "rover.urdf").read_bytes())
    (folder / "fleet.yaml").write_text(f"{FLEET}  {keys}\n")
    return main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")])


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("{router: tcp/h}", "zenoh.router"),
        ("{router: 'tcp/h:1', keystore: keys}", "zenoh.keystore"),
        ("{router: 'tcp/h:1', operators: [/ops]}", "fleet.yaml:5: zenoh: operators are known by"),
        (
            "{router: 'tcp/h:1', keystore: /k, operators: [/robot1]}",
            "two of robots, operators and router are robot1",
        ),
        ("{router: 'tcp/h:1', keystore: /k, operators: [ops]}", "'ops' is no enclave; write /ops"),
        ("{domain: 3}", "router"),
    ],
)
def test_wrong_keys_are_one_line(
    keys: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert built(tmp_path, keys) == 2
    shown = capsys.readouterr().err
    assert len(shown.splitlines()) == 1
    assert said in shown
    assert not (tmp_path / "out").exists()


@pytest.mark.more
def test_a_build_writes_a_file_each(tmp_path: Path) -> None:
    assert built(tmp_path, "{router: 'tcp/localhost:7447', domain: 3}") == 0
    out = tmp_path / "out" / "zenoh"
    assert sorted(it.name for it in out.iterdir()) == [
        *("robot1.json5", "robot2.json5", "router.json5"),
    ]
    assert '"3/robot1/**"' in (out / "robot1.json5").read_text()
