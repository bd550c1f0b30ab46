"""The key ``zenoh`` of a fleet file: what the configurations of its router and sessions rest on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.model import InputError
from multibot_rewrite.fleet.file.fleet_data import FleetData
from multibot_rewrite.fleet.file.fleet_paths import listed
from multibot_rewrite.fleet.outputs.zenoh_configuration import Setup, file_names

ZENOH = "zenoh"


def zenoh_of(read: FleetData) -> Setup | None:
    """What a fleet file says of Zenoh, if it does; InputError where that does not fit together."""
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
    for what in _faults(setup, [it["name"] for it in read.data["robots"]]):
        raise InputError(f"{file}:{line}: zenoh: {what}")
    return setup


def _faults(setup: Setup, robots: Sequence[str]) -> Iterator[str]:
    if setup.operators and not setup.keystore:
        yield "operators are known by certificates: give keystore as well"
    for it in setup.operators:
        if not it.startswith("/"):
            yield f"{it!r} is no enclave; write /{it}"
    names = file_names(robots, setup)
    for name in sorted({it for it in names if names.count(it) > 1}):
        word = name.removesuffix(".json5")
        yield f"two of robots, operators and router are {word}; choose another name for one"
