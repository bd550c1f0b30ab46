# SPDX-License-Identifier: Apache-2.0
"""The configurations of a fleet, loaded by Zenoh itself: what is refused really does not arrive."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
from graph_cases import read_plan
from live_commands import write_plan
from waiting import wait_until
from zenoh_robots import (
    STRING,
    STRING_HASH,
    TF_HASH,
    TF_TYPE,
    Robot,
    config,
    drive,
    router,
)

from multibot_rewrite.fleet.outputs.zenoh_configuration import Setup, configurations
from multibot_rewrite.planning.domain_bridge import with_bridges
from multibot_rewrite.planning.plan import read_plan as plan_in
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.zenoh.observe import Router, look
from multibot_rewrite.system.records import Domain, System

zenoh = pytest.importorskip("zenoh", reason="no zenoh: pip install '.[zenoh]'")
pytestmark = pytest.mark.live
SECONDS = 5.0
OPERATOR = "/operator"


def key(topic: str, domain: int = 0) -> str:
    return f"{domain}{topic}/{STRING}/{STRING_HASH}"


@pytest.fixture
def plan(tmp_path: Path) -> System:
    path = write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))
    return plan_in(path.read_bytes(), str(path))


def written(folder: Path, plan: System, setup: Setup) -> dict[str, Path]:
    files = {}
    for name, data in configurations(plan, setup):
        files[name] = folder / name
        files[name].write_bytes(data)
    return files


@contextmanager
def opened(file: Path, **changes: Any) -> Iterator[Any]:
    """Yield a session with the configuration of a file, as rmw_zenoh opens it."""
    made = zenoh.Config.from_file(str(file))
    for name, value in changes.items():
        made.insert_json5(name.replace("__", "/"), json.dumps(value))
    session = zenoh.open(made)
    try:
        yield session
    finally:
        session.close()


def arrives(sender: Any, listener: Any, name: str, witness: str) -> bool:
    """Return whether what is sent on ``name`` arrives, by the time that ``witness`` has it. The
    witness is allowed, so a refusal is told from a slow machine.

    The witness is allowed, so a refusal is told from a slow machine.
    """
    heard: list[str] = []
    subscriptions = [
        listener.declare_subscriber(it, lambda sample: heard.append(str(sample.key_expr)))
        for it in (name, witness)
    ]

    def sent() -> bool:
        # In this order, and twice: who hears the witness heard of the name before it.
        for it in (name, witness):
            sender.put(it, b"hello")
        return heard.count(witness) > 1

    wait_until(sent)
    for it in subscriptions:
        it.undeclare()
    return name in heard


def reaches(sender: Any, listener: Any, name: str, witness: str) -> None:
    """Assert that what is sent on ``name`` arrives, once the sender knows who listens. The first
    time it may not: the sender may still know the witness of the time before.

    Not always the first time: it may still know the witness of the time before.
    """
    wait_until(lambda: arrives(sender, listener, name, witness))


def test_a_robot_commands_itself_and_no_other(tmp_path: Path, plan: System) -> None:
    """By its own file: what it says to another robot does not leave its session."""
    with router() as address:
        files = written(tmp_path, plan, Setup(address, 0))
        with ExitStack() as stack:
            one = stack.enter_context(opened(files["robot1.json5"]))
            anybody = zenoh.open(config(mode="client", connect__endpoints=[address]))
            stack.callback(anybody.close)
            own, other = key("/robot1/odom"), key("/robot2/cmd_vel")
            assert not arrives(one, anybody, other, own)
            reaches(one, anybody, key("/diagnostics"), own)
            assert not arrives(one, anybody, key("/clock"), own)
            # It hears its own commands, and not those to others.
            assert not arrives(anybody, one, other, key("/robot1/cmd_vel"))
            assert not arrives(anybody, one, key("/robot1/cmd_vel", 7), key("/robot1/cmd_vel"))


def test_robots_in_domains_reach_the_domain_of_all_by_their_bridge(
    tmp_path: Path, plan: System
) -> None:
    """One process of domain_bridge is in two domains, with the configuration of its robot."""
    numbers = {"": 10, "robot1": 11, "robot2": 12}
    plan = plan._replace(domains=tuple(Domain(*it) for it in numbers.items()))
    plan = with_bridges(plan, ["odom"])
    with router() as address:
        files = written(tmp_path, plan, Setup(address, 0))
        with ExitStack() as stack:
            one = stack.enter_context(opened(files["robot1.json5"]))
            anybody = zenoh.open(config(mode="client", connect__endpoints=[address]))
            stack.callback(anybody.close)
            own, crossed = key("/robot1/odom", 11), key("/robot1/odom", 10)
            reaches(one, anybody, crossed, own)
            for refused in (key("/robot2/odom", 10), own.replace("11/", "12/", 1)):
                assert not arrives(one, anybody, refused, own)
            # What robots say in the domain of all is not for robot1.
            assert not arrives(anybody, one, key("/robot2/odom", 10), key("/robot1/cmd_vel", 11))


def test_what_is_latched_and_the_graph_pass(tmp_path: Path, plan: System) -> None:
    """tf_static of a robot with rules reaches who comes later; so do its tokens."""
    with router() as address:
        files = written(tmp_path, plan, Setup(address, 0))
        anybody = zenoh.open(config(mode="client", connect__endpoints=[address]))
        with opened(files["robot1.json5"]) as session, anybody:
            there = Robot(session, 0, [], anybody)
            drive(there, "robot1")
            topic, latched = "/robot1/tf_static", ":1:,1:,:,:,,"
            there.end(0, "/robot1", "drive", "MP", topic, TF_TYPE, hash=TF_HASH, qos=latched)
            with there.sends(topic, ("base", "laser"), latched=True):
                graph = look(Request(SECONDS), Router(address, 0))
    assert [(it.parent, it.child, it.static) for it in graph.edges] == [("base", "laser", True)]
    assert [it.name for it in graph.nodes] == ["/robot1/drive"]


@pytest.fixture(scope="module")
def keystore(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Certificates as sros2 makes them: one authority, an enclave's name in each."""
    if not shutil.which("openssl"):
        pytest.skip("no certificates: openssl not found")
    top = tmp_path_factory.mktemp("keystore")
    authority = top / "identity_ca.cert.pem"
    _openssl(
        *("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"),
        *("-keyout", top / "ca.key.pem", "-out", authority, "-subj", "/CN=authority", "-days", "2"),
    )
    for enclave in ("router", "robot1", "robot2", "operator", "stranger"):
        folder = top / "enclaves" / enclave
        folder.mkdir(parents=True)
        shutil.copy(authority, folder / "identity_ca.cert.pem")
        request = folder / "request.pem"
        _openssl(
            *("req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"),
            *("-keyout", folder / "key.pem", "-out", request, "-subj", f"/CN=\\/{enclave}"),
        )
        extensions = folder / "extensions"
        extensions.write_text("basicConstraints=CA:FALSE\nsubjectAltName=DNS:localhost\n")
        _openssl(
            *("x509", "-req", "-in", request, "-CA", authority, "-CAkey", top / "ca.key.pem"),
            *("-CAcreateserial", "-out", folder / "cert.pem", "-days", "2"),
            *("-extfile", extensions),
        )
    return top


def _openssl(*arguments: object) -> None:
    subprocess.run(["openssl", *map(str, arguments)], check=True, capture_output=True)


def test_the_router_refuses_by_certificate(tmp_path: Path, plan: System, keystore: Path) -> None:
    """Even a session of robot1 that has thrown away its rules drives no other robot."""
    setup = Setup("tcp/127.0.0.1:17647", 0, str(keystore), (OPERATOR,))
    files = written(tmp_path, plan, setup)
    free = {"access_control__enabled": False}
    with ExitStack() as stack:
        stack.enter_context(opened(files["router.json5"]))
        lawless = stack.enter_context(opened(files["robot1.json5"], **free))
        two = stack.enter_context(opened(files["robot2.json5"]))
        operator = stack.enter_context(opened(files["operator.json5"]))
        stranger = stack.enter_context(_as(files["robot1.json5"], keystore, "stranger"))
        own = key("/robot2/cmd_vel")
        reaches(operator, two, own, own)
        assert not arrives(lawless, operator, own, key("/robot1/odom"))
        assert not arrives(two, lawless, key("/robot2/odom"), key("/parameter_events"))
        reaches(two, operator, key("/diagnostics"), key("/robot2/odom"))
        serve = key("/robot2/reset")
        two.declare_queryable(serve, lambda query: query.reply(serve, b"done"))
        wait_until(lambda: [it for it in operator.get(serve, timeout=SECONDS) if it.ok])
        assert list(lawless.get(serve, timeout=SECONDS)) == []
        # The robots are seen by who may look, and by nobody without a known certificate.
        drive(Robot(two, 0, held := [], operator), "robot2")
        graph = look(Request(SECONDS), Router(str(files["operator.json5"]), 0))
        assert [it.name for it in graph.nodes] == ["/robot2/drive"]
        assert list(stranger.liveliness().get("@ros2_lv/**", timeout=1.0)) == []
        assert len(held) == 4


def test_a_router_on_the_robot_lets_out_what_is_its_own(
    tmp_path: Path, plan: System, keystore: Path
) -> None:
    """Two routers between robot1 and who looks after it; its session keeps no rules."""
    setup = Setup("tcp/127.0.0.1:17649", 0, str(keystore), (OPERATOR,), own_routers=True)
    files = written(tmp_path, plan, setup)
    here = ["tcp/127.0.0.1:17650"]
    with ExitStack() as stack:
        stack.enter_context(opened(files["router.json5"]))
        stack.enter_context(opened(files["robot1_router.json5"], listen__endpoints=here))
        free = {"connect__endpoints": here, "access_control__enabled": False}
        one = stack.enter_context(opened(files["robot1.json5"], **free))
        operator = stack.enter_context(opened(files["operator.json5"]))
        assert not arrives(one, operator, key("/robot2/cmd_vel"), key("/robot1/odom"))
        reaches(one, operator, key("/diagnostics"), key("/robot1/odom"))
        assert not arrives(operator, one, key("/robot2/odom"), key("/robot1/cmd_vel"))
        reaches(operator, one, key("/clock"), key("/robot1/cmd_vel"))
        drive(there := Robot(one, 0, [], operator), "robot1")
        graph = look(Request(SECONDS), Router(str(files["operator.json5"]), 0))
    assert [it.name for it in graph.nodes] == ["/robot1/drive"]
    assert len(there.held) == 4


def _as(file: Path, keystore: Path, enclave: str) -> Any:
    """Return the same session with another certificate and without rules of its own."""
    folder = keystore / "enclaves" / enclave
    changes = {
        "transport__link__tls__connect_private_key": str(folder / "key.pem"),
        "transport__link__tls__connect_certificate": str(folder / "cert.pem"),
        "access_control__enabled": False,
    }
    return opened(file, **changes)


def test_zenoh_loads_the_files_of_every_layout(tmp_path: Path) -> None:
    for layout in ("frames-per-robot", "tf-per-robot", "both", "postfix"):
        folder = tmp_path / layout
        folder.mkdir()
        setup = Setup("tcp/10.0.0.1:7447", 3, "/keystore", (OPERATOR,))
        files = written(folder, read_plan(layout), setup)
        robots = ["robot1.json5", "robot2.json5", "router.json5"]
        assert sorted(files) == ["operator.json5", *robots]
        for name, file in files.items():
            loaded = zenoh.Config.from_file(str(file))
            enabled = json.loads(loaded.get_json("access_control/enabled"))
            assert enabled is (name in robots)
