# SPDX-License-Identifier: Apache-2.0
"""What the code of a plugin reads: type, words, range; and topics as ``odom=pkg/msg/Name``."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import DefinitionsError
from multibot_rewrite.base.releases import is_release_words

VALUE = "value"
TYPES = ("any", "boolean", "color", "integer", "number", "pose", "text", "vector")
# What any row may say of its value; the rest of a row says whose name it is.
OPTIONS = ("type", "read", "required", "one", "unit", "range", "above", "checked")
_ROW = lazy_compile(rf"\n\S+ +{VALUE} ")
_NAMED, _RELEASES = "param[@name=", "releases="


class Value(NamedTuple):
    """A value that code reads: ``place`` is where, ``words`` are the only ones it may be.

    A number is ``low`` to ``high``, above ``low`` where that ``is_open``; ``checked`` is where the
    source says so. ``releases`` as in ``Site``.
    """

    name: str
    type: str
    place: str
    releases: str = ""
    required: bool = False
    words: tuple[str, ...] = ()
    unit: str = ""
    low: float | None = None
    high: float | None = None
    is_open: bool = False
    checked: str = ""


class Values(NamedTuple):
    """All that a plugin reads, by name; ``is_open``: it takes anything else, too.

    ``a/b`` is what is read of what is in ``a``: ``blocks`` has the names that are read in each such
    ``a``, at "" those of the plugin itself, and ``blocks_of`` where each name is read.
    """

    names: tuple[str, ...]
    of_ros_1: bool
    is_open: bool
    rows: Mapping[str, Value]
    blocks: Mapping[str, Sequence[str]]
    blocks_of: Mapping[str, Sequence[str]]


def is_typed(word: str) -> bool:
    """Return whether an option of a row is about the value's type."""
    option, given, _ = word.partition("=")
    return bool(given) and option in OPTIONS


def has_values(chunk: str) -> bool:
    """Return whether a section that is not parsed yet may have rows of values."""
    return "\nread: " in chunk or " read=" in chunk or _ROW.search(chunk) is not None


def read_values(file: str, line: int, rows: Iterable[str]) -> Iterator[Value]:
    """Yield the values of a section whose first row is at ``line``; raises DefinitionsError."""
    for number, row in enumerate(rows, line):
        path, *words = row.partition(" # ")[0].split() or [""]
        if words and row[:1] != "#" and not path.endswith(":"):
            yield from _value_in_row(f"{file}:{number}", path, words)


def values_of(
    names: tuple[str, ...], of_ros_1: bool, is_open: bool, found: Iterable[Value]
) -> Values:
    """Return the values of a plugin, the first one of each name."""
    rows: dict[str, Value] = {}
    for it in found:
        rows.setdefault(it.name, it)
    places = [path.rpartition("/") for path in rows]
    blocks = {"": [], **lists_by_key((above, name) for above, _, name in places)}
    blocks_of = lists_by_key((name, above) for above, _, name in places)
    return Values(names, of_ros_1, is_open, rows, blocks, blocks_of)


def _value_in_row(place: str, path: str, words: list[str]) -> Iterator[Value]:
    role, *rest = words
    options = dict(it.split("=", 1) for it in rest if is_typed(it) or it.startswith(_RELEASES))
    if role == VALUE:
        strange = [it for it in rest[1:] if it.partition("=")[0] not in options]
        if strange:
            known = f"use one of {', '.join((*OPTIONS, 'releases'))}"
            raise DefinitionsError(f"{place}: {path}: unknown option {strange[0]!r}, {known}")
        options["type"] = rest[0] if rest else ""
    elif options.keys() <= {"releases"}:
        return
    type_, releases = options.get("type", "text"), options.get("releases", "")
    if type_ not in TYPES:
        raise DefinitionsError(f"{place}: {path} {type_} is no type, use one of {', '.join(TYPES)}")
    if releases and not is_release_words(releases):
        raise DefinitionsError(f"{place}: {path} releases={releases} has no releases: write jazzy+")
    # What it is called where values are looked up.
    name, is_attribute, _ = path.partition("@")
    if path.startswith(_NAMED):
        name, is_attribute = path[len(_NAMED) : -1], ""
    read = options.get("read", "").partition("@")[0]
    choices = options["one"].split("|") if "one" in options else ()
    limits = _range(place, options)
    checked = options.get("checked", read)
    own = (name, "any" if is_attribute else type_, read, releases, "required" in options)
    yield Value(*own, tuple(choices), options.get("unit", ""), *limits, checked)


def _range(place: str, options: Mapping[str, str]) -> tuple[float | None, float | None, bool]:
    """Return the least value, the greatest one, and whether the least one is excluded."""
    above, (low, _, high) = options.get("above", ""), options.get("range", "").partition("..")
    try:
        found = float(above or low) if above or low else None
        return found, float(high) if high else None, bool(above)
    except ValueError:
        raise DefinitionsError(f"{place}: write range=0..1, range=0.. or above=0") from None


ROLES = ("publishes", "subscribes", "serves")


class WiredTopic(NamedTuple):
    """An end of a topic or service: its role, its name in the code, its type, empty if not known.

    ``{PATH}`` in the name is the value at a path, and ``{PATH:TYPE}`` as the type the one that is
    written there, or TYPE. ``when`` are conditions, as before the ``?`` of a default.
    """

    role: str
    name: str
    type: str = ""
    when: str = ""

    @property
    def is_moved(self) -> bool:
        """Return whether a topic is below a parameter's value, so that no rule is needed to move it."""
        return "{" in self.name


def wired_topics(place: str, settings: Mapping[str, str]) -> Iterator[WiredTopic]:
    """Yield the topics of ``publishes:``, ``subscribes:`` and ``serves:``; raises DefinitionsError."""
    for role in ROLES:
        for word in settings.get(role, "").split():
            when, asked, topic = word.rpartition("?")
            name, given, type_ = topic.partition("=")
            usual = type_[1:-1].partition(":")[2] if type_[:1] + type_[-1:] == "{}" else type_
            known = is_type(usual) or not given
            if not (known and name and name.count("{") == name.count("}") and (when or not asked)):
                raise DefinitionsError(f"{place}: {role}: {word!r} is not TOPIC or TOPIC=TYPE")
            yield WiredTopic(role, name, type_, when)


def role_and_type(place: str, options: Mapping[str, str]) -> tuple[str, str]:
    """Return role and type of a row with a topic, ``publishes=TYPE``; raises DefinitionsError."""
    role = next((it for it in options if it in ROLES), "")
    type_ = options.get(role, "")
    if role and not is_type(type_):
        raise DefinitionsError(f"{place}: {role}={type_} is no type: write sensor_msgs/msg/Imu")
    return role, type_


def is_type(text: str) -> bool:
    """Return whether a text is the full name of a message or service type."""
    package, _, rest = text.partition("/")
    kind, _, name = rest.partition("/")
    return kind in ("msg", "srv") and package.isidentifier() and name.isidentifier()
