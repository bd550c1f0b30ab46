# SPDX-License-Identifier: Apache-2.0
"""The plan of a fleet as a file: YAML, which people edit, or JSON, which is read faster.

Both have the same keys and values, and both are read with the same checks. A fleet file is
told from both.
"""

from __future__ import annotations

import json
import re
from codecs import BOM_UTF8
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from math import inf

from multibot_rewrite.base.bounded import QUOTED, load_json, load_yaml
from multibot_rewrite.base.file_kinds import PLAN, ROBOTS, refuse_others
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.spelling.plan_value import REMEDY, from_value, value_of
from multibot_rewrite.system.records import System

HEAD = """\
# What the graph of this fleet is to look like. Endpoints: [role, kind, name, type, name in the code].
# Take out what is not started, add what is: `multibot check` compares exactly this.
# optional: nodes that may be missing. other_frames: frames that may come besides. ignored_nodes:
# patterns of nodes that may come and go, beside the usual tools. sources: the plugin that starts a
# node. from: the file or stack that names a node. sends: the transforms that a node sends, but for
# those of its description. distro: the ROS 2 release that the nodes are of.
# spelled: what stands for a robot in its frames, where that is not its name. More can be said of a
# topic, `topics: {/robot1/cmd_vel: {senders: [/robot1/twist_mux], one_sender: true,
# qos: {durability: transient_local}}}`, and of nodes of which one runs, `one_of: [[/a, /b]]`.
# states: what nodes answer to `multibot check --state`, `{/robot1/amcl: {lifecycle: active,
# host: robot1_pc, parameters: {use_sim_time: false}}}`.
# open: what is read and not sent, claimed and not exported, by the robots' files; check reports it
# with the graph.
"""
Quote = Callable[[str], str]
# Text that YAML reads back unchanged without quotes, in brackets too.
_PLAIN = lazy_compile(r"[A-Za-z_/~](?:[A-Za-z0-9_./~-]|:(?=[A-Za-z0-9_/])| \| )*")


def to_yaml(plan: System) -> str:
    """The text of a YAML file."""
    return HEAD + "".join(_block(value_of(plan), "", cache(_quoted)))


def _block(value: Mapping[str, object], indent: str, quote: Quote) -> Iterator[str]:
    """A key a line; rows a line each, so that people find them."""
    for key, item in value.items():
        rows = isinstance(item, list | tuple) and item and not isinstance(item[0], str)
        if not (rows or (item and isinstance(item, dict))):
            yield f"{indent}{quote(key)}: {_plain(item, quote)}\n"
            continue
        yield f"{indent}{quote(key)}:\n"
        if isinstance(item, dict):
            yield from _block(item, f"{indent}  ", quote)
        elif isinstance(item, list | tuple):
            yield from (f"{indent}- {_plain(row, quote)}\n" for row in item)


def _plain(value: object, quote: Quote) -> str:
    if isinstance(value, str):
        return quote(value)
    if isinstance(value, list | tuple):
        return _flow(value, quote)
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_plain(it, quote)}' for key, it in value.items())}}}"
    return str(value).lower()


def to_json(plan: System) -> str:
    """The text of a JSON file, a robot a line."""
    top = value_of(plan)
    robots = top.pop("robots")
    assert isinstance(robots, dict)
    parts = [f"{_json(key)}: {_json(value)}" for key, value in top.items()]
    lines = ",\n".join(f"  {_json(name)}: {_json(value)}" for name, value in robots.items())
    return "{\n " + ",\n ".join([*parts, f'"robots": {{\n{lines}\n }}']) + "\n}\n"


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def _flow(values: Iterable[object], quote: Quote) -> str:
    return f"[{', '.join(_plain(it, quote) for it in values)}]"


def _quoted(value: str) -> str:
    if _PLAIN.fullmatch(value) and value.lower() not in QUOTED:
        return value
    import yaml

    return str(yaml.dump(value, default_style='"', width=inf)).rstrip("\n")


def read_plan(data: bytes, file: str) -> System:
    """Read what ``to_yaml`` or ``to_json`` wrote; raises InputError with file, place and what to write
    there."""
    refuse_others(data, file, PLAN)
    with gc_paused():
        return from_json(data, file) if is_json(data) else from_yaml(data, file)


def is_json(data: bytes) -> bool:
    """Whether a plan is JSON; a YAML file begins with a comment or a key."""
    return data.removeprefix(BOM_UTF8)[:1000].lstrip().startswith(b"{")


def is_plan(data: bytes) -> bool:
    """Whether a file is a plan, by its first key or its layout."""
    return re.search(rb'^[ {]*"?layout"?:', data[:10_000], re.MULTILINE) is not None


def from_json(data: bytes, file: str) -> System:
    """Read what ``to_json`` wrote; raises InputError."""
    try:
        return from_value(load_json(data), file)
    except json.JSONDecodeError as error:
        place = f"{file}:{error.lineno}:{error.colno}"
        raise InputError(f"{place}: not valid JSON: {error.msg}; {REMEDY}") from None
    except UnicodeDecodeError:
        raise InputError(f"{file}: not valid JSON: it is not UTF-8; {REMEDY}") from None


def from_yaml(data: bytes, file: str) -> System:
    """Read what ``to_yaml`` wrote; raises InputError."""
    try:
        return from_value(load_yaml(data.decode("utf-8-sig"), file, REMEDY), file)
    except UnicodeDecodeError:
        raise InputError(f"{file}: not valid YAML: it is not UTF-8; {REMEDY}") from None


# What follows ``robots:``, empty lines and comments aside.
_ROBOTS = lazy_compile(ROBOTS + rb"([^\s#])", re.MULTILINE)
_INCLUDE = lazy_compile(rb"^include:", re.MULTILINE)


def is_fleet(data: bytes) -> bool:
    """Is this a fleet file? Its robots are a list, or in files that it includes; in a plan they are
    keys."""
    found = _ROBOTS.search(data)
    return found[1] in (b"-", b"[") if found else bool(_INCLUDE.search(data))
