# SPDX-License-Identifier: Apache-2.0
"""Configurations of a fleet's Zenoh router and sessions, and the files of free_fleet.

rmw_zenoh reads such a file in place of its own default, so what it sets for ROS is set here as
well: ``DEFAULT_RMW_ZENOH_SESSION_CONFIG.json5`` and ``..._ROUTER_CONFIG.json5`` at 30f3030, the
values with "ROS setting". Who a session is a router can tell by its certificate alone: rmw_zenoh
is built without user and password (``zenoh_cpp_vendor/CMakeLists.txt``). The certificates are
those of an sros2 keystore, as in rmw_zenoh's ``zenoh_security_tools``; their common name is the
enclave (sros2 ``_enclave.py``). Source: open-rmf/free_fleet 002505f. The adapter reads
``ROBOT/tf`` and ``ROBOT/battery_state``, calls ``ROBOT/navigate_to_pose``
(nav2_robot_adapter.py), looks up map -> ``robot_frame`` with what is on that tf topic alone, and
wants ``navigation_stack`` and ``initial_map`` of each robot (fleet_adapter.py). Its bridges are
of zenoh-bridge-ros2dds, where a name is a regular expression of the whole name
(DEFAULT_CONFIG.json5 at 0b277b7)."""

import json
from collections.abc import Iterator
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.conventions import BODY_FRAMES
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import TF_TOPICS
from multibot_rewrite.fleet.file.domains import FREE_FLEET, FreeFleet
from multibot_rewrite.fleet.file.fleet_data import FleetData, listed
from multibot_rewrite.fleet.outputs.zenoh_access import (
    FLEET_ROUTER,
    OWN_ROUTER,
    Rights,
    access_control,
    all_rule,
    rights,
    robot_rules,
)
from multibot_rewrite.system.domains import domain_of
from multibot_rewrite.system.ownership import Whose, whose_by_plan
from multibot_rewrite.system.records import ACTION, SERVES, Robot, System

ROUTER_FILE = "router.json5"
# Where rmw_zenoh's sessions look for a router.
LOCAL_ROUTER = "tcp/localhost:7447"
Config = dict[str, Any]
# A subject without a property is everybody.
_ANYBODY: Config = {"id": "anybody"}


class Setup(NamedTuple):
    """What the plan does not say: router, domain, keystore, enclaves of operators, own routers."""

    router: str
    domain: int
    keystore: str = ""
    operators: tuple[str, ...] = ()
    own_routers: bool = False


def configurations(plan: System, setup: Setup) -> Iterator[tuple[str, bytes]]:
    """Yield (name, bytes) of each file: for the router, the nodes of each robot, each operator."""
    known = rights(plan, setup.domain)
    domains = sorted({*domain_of(plan).values()}) or [setup.domain]
    # On every address, at the port that the robots connect to.
    protocol, _, address = _router_endpoint(setup).partition("/")
    listening = f"{protocol}/0.0.0.0:{address.rpartition(':')[2]}"
    config: Config = {"mode": "router", "listen": {"endpoints": [listening]}}
    config |= _shared_settings("/router", setup)
    about = f"The fleet's router: {_router_command(ROUTER_FILE)}."
    if setup.keystore:
        parts = [(_subject(f"/{it.robot}"), robot_rules(it, FLEET_ROUTER)) for it in known]
        parts += [(_subject(it), [all_rule(it, domains)]) for it in setup.operators]
        config["access_control"] = access_control(parts)
        about = f"{about} It tells robots apart by their certificates"
    else:
        about = (
            f"{about} Without a keystore it cannot tell robots apart, so each robot's"
            " own file is all that keeps it from the others"
        )
    yield ROUTER_FILE, _config_text(config, about)
    for given in known:
        name = f"{given.robot}.json5"
        # A client of the fleet's router, or a peer beside a router of its own.
        config = _client_config(f"/{given.robot}", setup)
        if setup.own_routers:
            config = {
                "mode": "peer",
                "connect": {"endpoints": [LOCAL_ROUTER]},
                "listen": {"endpoints": ["tcp/localhost:0"]},
                **_shared_settings("", setup._replace(keystore="")),
            }
        config["access_control"] = access_control([(_ANYBODY, robot_rules(given))])
        yield name, _config_text(config, f"The nodes of {given.robot}: {_session(name)}")
        if setup.own_routers:
            name = f"{given.robot}_router.json5"
            about = f"The router on {given.robot}: {_router_command(name)}"
            yield name, _config_text(_own_router(given, setup), about)
    for enclave in setup.operators:
        name = f"{operator_word(enclave)}.json5"
        about = (
            f"Who may do anything, as {enclave}: {_session(name)}, multibot snapshot --from {name}"
        )
        yield name, _config_text(_client_config(enclave, setup), about)


def operator_word(enclave: str) -> str:
    """Return the file name for an enclave."""
    return enclave.strip("/").replace("/", "_")


def _router_command(name: str) -> str:
    return f"ZENOH_ROUTER_CONFIG_URI={name} (its full path) ros2 run rmw_zenoh_cpp rmw_zenohd"


def _session(name: str) -> str:
    """Return the shell line that makes a session use a file."""
    return f"export ZENOH_SESSION_CONFIG_URI={name} (its full path)"


def _config_text(config: Config, about: str) -> bytes:
    return f"// {about}.\n{json.dumps(config, indent=2)}\n".encode()


def _shared_settings(enclave: str, setup: Setup) -> Config:
    """Return what rmw_zenoh sets for ROS, and the certificates."""
    config: Config = json.loads(own_text(__file__, "zenoh_session.json"))
    if setup.keystore:
        # As ``zenoh_security_tools`` writes them: both sides show a certificate of the keystore.
        folder = f"{setup.keystore}/enclaves{enclave}"
        key, certificate = f"{folder}/key.pem", f"{folder}/cert.pem"
        tls = {
            "enable_mtls": True,
            # Certificates of sros2 name an enclave, not a host.
            "verify_name_on_connect": False,
            "root_ca_certificate": f"{folder}/identity_ca.cert.pem",
            "listen_private_key": key,
            "listen_certificate": certificate,
            "connect_private_key": key,
            "connect_certificate": certificate,
        }
        config["transport"]["link"] |= {"protocols": ["tls"], "tls": tls}
    return config


def _router_endpoint(setup: Setup) -> str:
    """Return the router's endpoint; with certificates it is TLS."""
    return f"tls/{setup.router.partition('/')[2]}" if setup.keystore else setup.router


def _subject(enclave: str) -> Config:
    """Return the subject of access control for an enclave."""
    return {"id": enclave, "cert_common_names": [enclave]}


def _own_router(given: Rights, setup: Setup) -> Config:
    """Return a router on the robot: nodes connect by loopback, the rest through the fleet's router."""
    config: Config = {
        "mode": "router",
        "connect": {"endpoints": [_router_endpoint(setup)]},
        "listen": {"endpoints": [LOCAL_ROUTER]},
        **_shared_settings(f"/{given.robot}", setup),
    }
    if setup.keystore:
        config["transport"]["link"]["protocols"] = ["tls", "tcp"]
    rules = robot_rules(given, OWN_ROUTER)
    config["access_control"] = access_control([(_ANYBODY, rules)])
    return config


def _client_config(enclave: str, setup: Setup) -> Config:
    """Return a client: all that it sends goes through the router, which may refuse it."""
    config = {"mode": "client", "connect": {"endpoints": [_router_endpoint(setup)]}}
    return config | _shared_settings(enclave, setup)


ZENOH = "zenoh"


def zenoh_of(read: FleetData) -> Setup | None:
    """Return the Zenoh settings of a fleet file, None without; raises InputError if they conflict."""
    if ZENOH not in read.data:
        return None
    given = read.data[ZENOH]
    setup = Setup(
        given["router"],
        given.get("domain", 0),
        given.get("keystore", "").rstrip("/"),
        tuple(dict.fromkeys(listed(given.get("operators", [])))),
        given.get("own_routers", False),
    )
    file, line = read.places[ZENOH,]
    place = f"{file}:{line}: zenoh:"
    if setup.operators and not setup.keystore:
        what = "operators are known by certificates: give keystore as well"
        raise InputError(f"{place} {what}")
    for it in (it for it in setup.operators if not it.startswith("/")):
        raise InputError(f"{place} {it!r} is no enclave; write /{it}")
    # What the files are called.
    robots = [it["name"] for it in read.data["robots"]]
    words = [*robots, *map(operator_word, setup.operators)]
    words += [f"{robot}_router" for robot in robots if setup.own_routers]
    names = [ROUTER_FILE, *(f"{word}.json5" for word in words)]
    for name in sorted({it for it in names if names.count(it) > 1}):
        what = f"two of robots, operators and router are {name.removesuffix('.json5')}"
        raise InputError(f"{place} {what}; choose another name for one")
    return setup


ROBOTS_FILE = "robots.yaml"
_BATTERY, _NAVIGATE = "battery_state", "navigate_to_pose"
_MAP = "map"


def free_fleet_files(plan: System, setup: FreeFleet) -> Iterator[tuple[str, bytes]]:
    """Yield (path, bytes) of each file; raises UsageError for names that the adapter cannot find."""
    numbers, whose = domain_of(plan), whose_by_plan(plan)
    for robot in plan.robots:
        # Why the adapter would find nothing of the robot.
        tf, served = (f"/{robot.space}/{it}" for it in (TF_TOPICS[0], _NAVIGATE))
        if robot.tf_topic != tf:
            wanted = f"its adapter reads {tf}, and {robot.name} has {robot.tf_topic}"
            raise UsageError(f"{FREE_FLEET}: {wanted}; take layout tf-per-robot or both")
        if not any((it.kind, it.role, it.name) == (ACTION, SERVES, served) for it in plan.ends):
            what = f"no node of {robot.name} serves {served}"
            raise UsageError(f"{FREE_FLEET}: {what}; name the node set that does, as nav2")
        yield f"{FREE_FLEET}/{robot.name}.json5", _bridge_config(robot, numbers[robot.name], setup)
    rows = [
        "# The robots of the fleet adapter: put them below rmf_fleet of its configuration.",
        "rmf_fleet:",
        "  robots:",
    ]
    for it in plan.robots:
        own_map = (one for one in it.other_frames if whose.plain_frame(one) == _MAP)
        told = {
            "charger": setup.charger.replace("{robot}", it.name),
            "navigation_stack": 2,
            "initial_map": setup.map,
            "map_frame": _MAP if _MAP in plan.shared_frames else next(own_map, _MAP),
            "robot_frame": _robot_frame(plan, it, whose),
        }
        rows.append(f"    {it.name}:")
        rows += [f"      {key}: {json.dumps(value)}" for key, value in told.items()]
    yield f"{FREE_FLEET}/{ROBOTS_FILE}", "\n".join((*rows, "")).encode()


def _bridge_config(robot: Robot, domain: int, setup: FreeFleet) -> bytes:
    battery = f"/{robot.space}/{_BATTERY}"
    config = {
        "plugins": {
            "ros2dds": {
                "domain": domain,
                "allow": {
                    "publishers": [robot.tf_topic, battery],
                    "subscribers": [],
                    "service_servers": [],
                    "service_clients": [],
                    "action_servers": [f"/{robot.space}/{_NAVIGATE}"],
                    "action_clients": [],
                },
                "pub_max_frequencies": [f"{battery}=1"],
            }
        },
        "mode": "client",
        "connect": {"endpoints": [setup.router]},
        "listen": {"endpoints": []},
    }
    about = f"On {robot.name}: zenoh-bridge-ros2dds -c {robot.name}.json5"
    return f"// {about}\n{json.dumps(config, indent=2)}\n".encode()


def _robot_frame(plan: System, robot: Robot, whose: Whose) -> str:
    """Return the frame that odometry moves; fixed ones are on tf_static, not read by the adapter."""
    nodes = {it.name for it in plan.nodes if it.robot == robot.name}
    moved = (
        it.child
        for it in plan.edges
        if not nodes.isdisjoint(it.publishers) and whose.plain_frame(it.parent) == "odom"
    )
    plain = {whose.plain_frame(it): it for it in robot.frames}
    base = next((plain[it] for it in BODY_FRAMES if it in plain), BODY_FRAMES[0])
    return next(moved, base)
