# SPDX-License-Identifier: Apache-2.0
"""The text of one NoDL 2 document -> a record; errors name file and line.

What is allowed is what ``nodl_schema/schemas/nodl.schema.yaml`` and ``parameter.schema.yaml`` of
ros-tooling/nodl (main, 915a4da) say.
"""

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.rosnames import check_name_in_code
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    entries_of,
    read_yaml_with_lines,
    table,
    table_of,
    word,
    word_of,
    wrong,
)
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
)

VERSION = "2"
# Key of a document -> kind and role of its endpoints.
SECTIONS = {
    "publishers": (TOPIC, PUBLISHES),
    "subscriptions": (TOPIC, SUBSCRIBES),
    "service_servers": (SERVICE, SERVES),
    "service_clients": (SERVICE, CALLS),
    "action_servers": (ACTION, SERVES),
    "action_clients": (ACTION, CALLS),
}
KEYS = ("nodl_version", "description", "codegen", "include", "parameters", *SECTIONS)
GROUP = {TOPIC: "msg", SERVICE: "srv", ACTION: "action"}
ENDPOINT_KEYS = {
    TOPIC: ("name", "type", "qos", "description"),
    SERVICE: ("name", "type", "qos", "description"),
    ACTION: ("name", "type", "description"),
}
PARAMETER_KEYS = (
    *("type", "default_value", "description", "read_only"),
    *("additional_constraints", "validation"),
)
HISTORY = ("KEEP_LAST", "KEEP_ALL", "SYSTEM_DEFAULT")
_ANY = ("SYSTEM_DEFAULT", "BEST_AVAILABLE")
POLICIES = {
    "history": HISTORY,
    "reliability": ("RELIABLE", "BEST_EFFORT", *_ANY),
    "durability": ("TRANSIENT_LOCAL", "VOLATILE", *_ANY),
    "liveliness": ("AUTOMATIC", "MANUAL_BY_TOPIC", *_ANY),
}
NUMBERS = ("depth", "deadline_ns", "lifespan_ns", "liveliness_lease_duration_ns")
_NAME = lazy_compile(r"[A-Za-z]|[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]")
_TYPE = lazy_compile(r"([A-Za-z][A-Za-z0-9_]*)/(?:(msg|srv|action)/)?([A-Z][A-Za-z0-9]*)")
_PARAMETER_TYPE = lazy_compile(
    r"bool|int|double|string|none|(?:bool|byte|int|double|string)_array"
    r"|(?:string|(?:int|double|string)_array)_fixed_[1-9][0-9]*"
)
_REFERENCE = lazy_compile(r"[a-z][a-z0-9+.-]*://[^\s/]\S*")
_WHOLE = lazy_compile(r"\d+")


class Parameter(NamedTuple):
    """A parameter that the node declares; ``default`` is empty without one, or for a list."""

    name: str
    type: str
    default: str


class Include(NamedTuple):
    """A document whose contents are part of another one; ``where`` is ``file:line``."""

    ref: str
    where: str


class Document(NamedTuple):
    """What a NoDL document says; a document does not say which node it is for."""

    file: str
    endpoints: tuple[Endpoint, ...]
    parameters: tuple[Parameter, ...]
    includes: tuple[Include, ...] = ()


# A fleet asks for the same documents once for each robot.
@lru_cache(maxsize=512)
def parse(text: str, file: str) -> Document:
    """Return the document in a NoDL text; raises UsageError with file and line."""
    item = read_yaml_with_lines(text, file)
    if text.lstrip("\ufeff \t\r\n").startswith("<"):
        wrong(item, "NoDL 1, which is XML, is not read; write the interface in NoDL 2 (YAML)")
    if not isinstance(item.value, Mapping):
        wrong(item, "not a NoDL document; write nodl_version: 2 and the interface as keys")
    top = table(item, "the document", KEYS)
    given = top.get("nodl_version")
    if given is None:
        wrong(item, "nodl_version is missing; write nodl_version: 2")
    if given.value != VERSION:
        wrong(given, f"nodl_version {given.value!r} is not read; only version 2 is")
    word_of(top, "description")
    for key, entry in table_of(top, "codegen").items():
        table(entry, f"codegen {key}")
    endpoints: list[Endpoint] = []
    for section, (kind, role) in SECTIONS.items():
        # One endpoint for two of a name, as two publishers of a node may have.
        found: dict[str, Endpoint] = {}
        for entry in _listed_entries(top, section):
            end = _read_endpoint(entry, section, kind, role)
            first = found.setdefault(end.name, end)
            if end.type not in (first.type, *first.also):
                found[end.name] = first._replace(also=(*first.also, end.type))
        endpoints += found.values()
    parameters = tuple(_read_parameters(table_of(top, "parameters")))
    includes = []
    for entry in _listed_entries(top, "include"):
        ref = word_of(table(entry, "an include", ("ref",)), "ref")
        if not _REFERENCE.fullmatch(ref):
            wrong(entry, f"include {ref!r}: write ref: nodl://PACKAGE/NAME or local://FILE")
        includes.append(Include(ref, entry.where))
    return Document(file, tuple(endpoints), parameters, tuple(includes))


def _listed_entries(top: Mapping[str, YamlItem], key: str) -> tuple[YamlItem, ...]:
    if key in top and isinstance(top[key].value, str):
        wrong(top[key], f"{key} is the text {top[key].value!r}; write a list")
    return entries_of(top, key)


def _read_endpoint(item: YamlItem, section: str, kind: str, role: str) -> Endpoint:
    keys = table(item, f"an entry of {section}", ENDPOINT_KEYS[kind])
    if not keys:
        wrong(item, f"an entry of {section} is empty; write name and type")
    needed = ("name", "type", "qos") if kind == TOPIC else ("name", "type")
    for key in needed:
        if key not in keys:
            wrong(item, f"an entry of {section} has no {key}; write it")
    name = word(keys["name"], "name")
    if not _NAME.fullmatch(name):
        hint = "write letters, digits, _ and /, a letter, / or ~ first"
        wrong(keys["name"], f"name {name!r} is not a name in NoDL; {hint}")
    if fault := check_name_in_code(name):
        wrong(keys["name"], f"name {name!r}: {fault.reason}")
    if "qos" in keys:
        _check_qos(keys["qos"])
    note = word_of(keys, "description")
    type_ = word(keys["type"], "type")
    found = _TYPE.fullmatch(type_)
    if not found:
        wrong(keys["type"], f"{type_!r} is not a ROS type; write it like std_msgs/msg/String")
    if found[2] not in (None, GROUP[kind]):
        wrong(keys["type"], f"{type_} is not the type of {kind} but of a {found[2]}")
    # A document may leave out the group of a type.
    full_type = f"{found[1]}/{GROUP[kind]}/{found[3]}"
    return Endpoint(kind, role, name, full_type, note=note, source=(item.where,))


def _check_qos(item: YamlItem) -> None:
    keys = table(item, "qos", (*POLICIES, *NUMBERS))
    for key in ("history", "reliability"):
        if key not in keys:
            wrong(item, f"qos has no {key}; write one of {', '.join(POLICIES[key])}")
    for key, known in POLICIES.items():
        if key in keys and keys[key].value not in known:
            wrong(keys[key], f"{key} {keys[key].value!r} is not one of {', '.join(known)}")
    for key in NUMBERS:
        if key in keys and not _WHOLE.fullmatch(str(keys[key].value)):
            wrong(keys[key], f"{key} {keys[key].value!r} is not a whole number")
    if keys["history"].value == "KEEP_LAST" and "depth" not in keys:
        wrong(item, "qos with history KEEP_LAST has no depth; write it")
    if "depth" in keys and not str(keys["depth"].value).strip("0"):
        wrong(keys["depth"], "depth is 0; write 1 or more")


def _read_parameters(found: Mapping[str, YamlItem]) -> Iterator[Parameter]:
    for name, item in found.items():
        keys = table(item, f"parameter {name!r}", PARAMETER_KEYS)
        if "type" not in keys:
            wrong(item, f"parameter {name!r} has no type; write one, such as string")
        type_ = word_of(keys, "type")
        if not _PARAMETER_TYPE.fullmatch(type_):
            wrong(keys["type"], f"parameter {name!r}: {type_!r} is no type; write one like string")
        default = keys["default_value"].value if "default_value" in keys else ""
        yield Parameter(name, type_, default if isinstance(default, str) else "")
