# SPDX-License-Identifier: Apache-2.0
"""A file with a snapshot, in one of its forms: our own JSON, or a message of rosgraph_msgs/Graph."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

from multibot_rewrite.base.bounded import MAX_FLEET_BYTES
from multibot_rewrite.base.file_kinds import KINDS, PLAN
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.system.environment import WITHOUT_READERS, unfinished
from multibot_rewrite.system.json import from_value, json_value
from multibot_rewrite.system.merging import Look, merged
from multibot_rewrite.system.records import System

# A message in YAML starts with its only field; JSON has the name in quotes.
_MESSAGE = lazy_compile(rb"\A(?:\xef\xbb\xbf)?(?:\s|#[^\n]*\n|---[^\S\n]*\n)*nodes:")


def read_snapshot(path: str) -> System:
    """Return the snapshot in a file; raises InputError with file, what is wrong and what to do."""
    data = read_file(path, MAX_FLEET_BYTES)
    text = _decode(data, path) if _MESSAGE.match(data) else ""
    value = None if text else json_value(data, path)
    if text or (isinstance(value, dict) and "schema" not in value):
        from multibot_rewrite.producers.rosgraph.reading import from_message, from_yaml, is_message

        if text:
            return from_yaml(text, path)
        if is_message(value):
            return from_message(cast("dict[str, Any]", value), path)
    system = from_value(value, path)
    if system.layout:
        raise InputError(f"{path}: {KINDS[PLAN].words}; {KINDS[PLAN].use}")
    # Return the system with what its ends show of the view; an older look may not have said it.
    around = system.environment
    known = {it.code for it in around.caveats}
    found = unfinished(system.nodes, system.ends, around.discovery_server) if around.rmw else ()
    new = tuple(it for it in found if it.code == WITHOUT_READERS and it.code not in known)
    return system._replace(environment=around._replace(caveats=(*around.caveats, *new)))


def read_snapshots(paths: Sequence[str]) -> System:
    """Return what any of these files has seen; raises InputError, and UsageError for two domains."""
    return merged([Look(path, read_snapshot(path)) for path in paths])


def read_by_domain(paths: Sequence[str]) -> dict[int, System]:
    """Return by domain what these files have seen; raises as ``read_snapshots``."""
    looks = (Look(path, read_snapshot(path)) for path in paths)
    by_domain = lists_by_key((it.snapshot.environment.domain, it) for it in looks)
    return {it: merged(by_domain[it]) for it in sorted(by_domain)}


def _decode(data: bytes, path: str) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: cannot be read: it is not UTF-8; save it as UTF-8") from None
