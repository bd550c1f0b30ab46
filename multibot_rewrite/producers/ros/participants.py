# SPDX-License-Identifier: Apache-2.0
"""How many DDS participants run on this machine, whoever has heard of them: each has ports of its own.

Source: DDSI-RTPS 9.6.2.3, which Fast DDS and Cyclone DDS keep to: the port at which a participant is
found is 7400 + 250 * domain + 10 + 2 * number, and the next one is where it gets its data.
"""

import os
import socket
import sys
from collections import defaultdict
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import TypeVar

TABLES = ("/proc/net/udp", "/proc/net/udp6")
# The ports that any program gets, from domain 102 on those of participants, too.
ANYBODYS = "/proc/sys/net/ipv4/ip_local_port_range"
_FIRST, _A_DOMAIN, _UNICAST = 7400, 250, 10
OPEN_HERE = "/proc/self/fd"
# What all nodes of a large fleet say of themselves at once; net.core.rmem_max may be less.
ROOM_BYTES = 1 << 22
# SO_MEMINFO of Linux (asm-generic/socket.h) and its size; the last number in it counts drops.
_MEMORY_INFO, _DROPS = (55, 36), slice(32, 36)
T = TypeVar("T")


def participants_here(domain: int) -> int | None:
    """Return how many participants of a domain run on this machine; None if unknown: no Linux."""
    ports, last = _lost_at(domain), _FIRST + _A_DOMAIN * (domain + 1)
    with suppress(OSError), open(ANYBODYS) as given:
        # There one port alone is another program's.
        if int(given.read().split()[0]) < last:
            ports = {it: 0 for it in ports if it % 2 == 0 and it + 1 in ports}
    found = sum(port >= _UNICAST and port % 2 == 0 for port in ports)
    return found if os.path.exists(TABLES[0]) else None


def lost_here(domain: int) -> int:
    """Return how many datagrams for a domain this machine has lost; 0 if unknown."""
    return sum(_lost_at(domain).values())


def _lost_at(domain: int) -> Mapping[int, int]:
    """Return the datagrams lost at each open port of a domain, counted from its first; or empty."""
    found: dict[int, int] = defaultdict(int)
    for path in TABLES:
        # A machine without IPv6 has no second one.
        with suppress(OSError, ValueError, IndexError), open(path) as table:
            for row in map(str.split, [*table][1:]):
                port = int(row[1].rpartition(":")[2], 16) - _FIRST - _A_DOMAIN * domain
                if 0 <= port < _A_DOMAIN:
                    found[port] += int(row[-1])
    return found


def make_room() -> None:
    """Enlarge this process's UDP buffers: Linux keeps 160 datagrams, and lost ones cost 3 s."""
    _ask_own(lambda own: own.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, ROOM_BYTES))


def lost_by_us() -> int:
    """Return how many datagrams this process's UDP sockets have lost; 0 if unknown.

    What another process lost need not be waited for: it offers its endpoints again after 1 s, and that
    the names of its nodes have not come is noticed (``queries.without_nodes``)."""
    told = _ask_own(lambda own: own.getsockopt(socket.SOL_SOCKET, *_MEMORY_INFO))
    return sum(int.from_bytes(it[_DROPS], sys.byteorder) for it in told)


def _ask_own(ask: Callable[[socket.socket], T]) -> list[T]:
    """Return what each UDP socket of this process answers, without those that cannot."""
    found = []
    for number in os.listdir(OPEN_HERE) if os.path.isdir(OPEN_HERE) else ():
        with suppress(OSError):
            borrowed = socket.socket(fileno=int(number))
            try:
                if borrowed.type == socket.SOCK_DGRAM:
                    found.append(ask(borrowed))
            finally:
                borrowed.detach()
    return found
