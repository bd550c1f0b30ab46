# SPDX-License-Identifier: Apache-2.0
"""Robots for a Zenoh router in tests: sessions with tokens as rmw_zenoh writes them.

The tokens are put together here from the source of rmw_zenoh (liveliness_utils.cpp), not by the
package. All is in this process, on loopback. ``python zenoh_robots.py ENDPOINT ROBOT... +ENDPOINT...``
is a machine of its own: a router that listens there and connects to those with a plus, with robots
beside it; it ends when its standard input closes.
"""

from __future__ import annotations

import json
import struct
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from typing import Any, NamedTuple

from waiting import wait_until

TF_HASH = "RIHS01_e369d0f05a23ae52508854b66f6aa04437f3449d652e8cbf61d2ee8fb5e2e9a1"
STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
TRIGGER_HASH = "RIHS01_eeff2cd6fc5ad9d27cdf4dec64818317839b62f12a91e6b5304b634b2062c5f3"
STRING, TRIGGER = "std_msgs::msg::dds_::String_", "std_srvs::srv::dds_::Trigger_"
TF_TYPE = "tf2_msgs::msg::dds_::TFMessage_"
DEFAULT_QOS = "::,10:,:,:,,"
# Twice the rate of a slow tf.
PERIOD = 0.05


def config(**settings: Any) -> Any:
    """Return a configuration without multicast; ``a__b`` is the key a/b."""
    import zenoh

    made = zenoh.Config()
    made.insert_json5("scouting/multicast/enabled", "false")
    for key, value in settings.items():
        made.insert_json5(key.replace("__", "/"), json.dumps(value))
    return made


@contextmanager
def router(**settings: Any) -> Iterator[str]:
    """Yield a router on loopback; gives its endpoint."""
    import zenoh

    with ExitStack() as stack:
        # A port that another run has taken is refused at once.
        for port in range(17447, 17547):
            address = f"tcp/127.0.0.1:{port}"
            try:
                made = config(mode="router", listen__endpoints=[address], **settings)
                session = zenoh.open(made)
            except zenoh.ZError:
                continue
            stack.callback(session.close)
            yield address
            return
        raise AssertionError("no free port for a router")


class Robot(NamedTuple):
    """A session of rmw_zenoh with the tokens that it holds, and another session that hears of them."""

    session: Any
    domain: int
    held: list[Any]
    witness: Any

    def hold(self, token: str) -> None:
        """Wait until the witness knows of the token: a session tells its router when it likes."""
        self.held.append(self.session.liveliness().declare_token(token))
        wait_until(lambda: any(reply.ok for reply in self.witness.liveliness().get(token)))

    def node(self, number: int, namespace: str, name: str) -> None:
        self.hold(f"{self._start(number, number, 'NN')}/{mangled(namespace)}/{name}")

    def end(
        self, number: int, namespace: str, node: str, kind: str, name: str, type_: str, **more: str
    ) -> None:
        hash_ = more.get("hash", TRIGGER_HASH if type_ == TRIGGER else STRING_HASH)
        owner = f"{mangled(namespace)}/{node}"
        rest = f"{mangled(name)}/{type_}/{hash_}/{more.get('qos', DEFAULT_QOS)}"
        self.hold(f"{self._start(number, 100 + len(self.held), kind)}/{owner}/{rest}")

    def _start(self, node: int, number: int, kind: str) -> str:
        return f"@ros2_lv/{self.domain}/{self.session.zid()}/{node}/{number}/{kind}/%"

    @contextmanager
    def sends(
        self,
        topic: str,
        *edges: tuple[str, str],
        latched: bool = False,
        gid: bytes = b"g",
        period: float = PERIOD,
    ) -> Iterator[None]:
        """Publish transforms on a topic: latched once in a cache, others again and again."""
        from zenoh import ext

        key = f"{self.domain}/{topic.strip('/')}/{TF_TYPE}/{TF_HASH}"

        def data() -> bytes:
            return tf_message(*edges, stamp=divmod(time.time_ns(), 10**9))

        attachment = struct.pack("<qqB", 1, 2, 16) + gid.ljust(16, b"g")
        if latched:
            cache = ext.CacheConfig(max_samples=1)
            publisher = ext.declare_advanced_publisher(self.session, key, cache=cache)
            publisher.put(data(), attachment=attachment)
            yield
            publisher.undeclare()
            return
        stop = threading.Event()

        def send() -> None:
            while not stop.wait(period):
                self.session.put(key, data(), attachment=attachment)

        thread = threading.Thread(target=send)
        thread.start()
        yield
        stop.set()
        thread.join()


@contextmanager
def robot(address: str, domain: int = 0, **settings: Any) -> Iterator[Robot]:
    """Yield a session as rmw_zenoh opens it: a peer that listens and connects to its router."""
    import zenoh

    given: Mapping[str, Any] = {
        "mode": "peer",
        "listen__endpoints": ["tcp/127.0.0.1:0"],
        "connect__endpoints": [address],
        "timestamping__enabled": True,
        **settings,
    }
    session = zenoh.open(config(**given))
    witness = zenoh.open(config(mode="client", connect__endpoints=[address]))
    try:
        # Held here: a token that nobody holds is taken back.
        yield Robot(session, domain, [], witness)
    finally:
        session.close()
        witness.close()


def drive(there: Robot, name: str, number: int = 0) -> None:
    """Run the node that the plan of ``live_commands`` has for each robot."""
    space = f"/{name}"
    there.node(number, space, "drive")
    there.end(number, space, "drive", "MP", f"/{name}/odom", STRING)
    there.end(number, space, "drive", "MS", f"/{name}/cmd_vel", STRING)
    there.end(number, space, "drive", "SS", f"/{name}/reset", TRIGGER)


def mangled(name: str) -> str:
    """As a part of a key."""
    return name.replace("/", "%")


def tf_message(
    *edges: tuple[str, str],
    mark: str = "<",
    numbers: tuple[float, ...] = (1, 2, 3, 0, 0, 0, 1),
    stamp: tuple[int, int] = (7, 8),
) -> bytes:
    """Return a TFMessage in CDR, of either endianness; all transforms have these numbers and stamp."""
    data = struct.pack(f"{mark}I", len(edges))
    for edge in edges:
        data += b"\0" * (-len(data) % 4) + struct.pack(f"{mark}iI", *stamp)
        for name in edge:
            text = name.encode() + b"\0"
            data += b"\0" * (-len(data) % 4) + struct.pack(f"{mark}I", len(text)) + text
        data += b"\0" * (-len(data) % 8) + struct.pack(f"{mark}7d", *numbers)
    return (b"\0\1\0\0" if mark == "<" else b"\0\0\0\0") + data


def main(address: str, *words: str) -> None:
    """Run a machine with a router and robots, until standard input closes."""
    others = [word[1:] for word in words if word.startswith("+")]
    names = [word for word in words if not word.startswith("+")]
    import zenoh

    made = config(mode="router", listen__endpoints=[address], connect__endpoints=others)
    session = zenoh.open(made)
    with robot(address) as there:
        for number, name in enumerate(names):
            drive(there, name, number)
        print("ready", flush=True)
        sys.stdin.read()
    session.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
