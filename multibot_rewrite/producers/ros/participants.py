# SPDX-License-Identifier: Apache-2.0
"""How many DDS participants run on this machine, whoever has heard of them: each has ports of its own.

Source: DDSI-RTPS 9.6.2.3, which Fast DDS and Cyclone DDS keep to: the port at which a participant is
found is 7400 + 250 * domain + 10 + 2 * number.
"""

from __future__ import annotations

from collections.abc import Iterable

TABLES = ("/proc/net/udp", "/proc/net/udp6")
_FIRST, _A_DOMAIN, _UNICAST = 7400, 250, 10


def participants_at(ports: Iterable[int], domain: int) -> int:
    """Those of a domain that have some of these ports."""
    inner = {port - _FIRST - _A_DOMAIN * domain for port in ports}
    return len({it for it in inner if _UNICAST <= it < _A_DOMAIN and it % 2 == 0})


def ports_in(table: str) -> list[int]:
    """The local ports in a table of Linux, as ``/proc/net/udp`` has them."""
    rows = (line.split() for line in table.splitlines()[1:])
    return [int(row[1].rpartition(":")[2], 16) for row in rows if len(row) > 1]


def participants_here(domain: int) -> int | None:
    """Those of a domain that run on this machine; None where nobody can tell: no Linux."""
    ports: list[int] = []
    try:
        for path in TABLES:
            with open(path) as file:
                ports += ports_in(file.read())
    except (OSError, ValueError):
        return None
    return participants_at(ports, domain)
