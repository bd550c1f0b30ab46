# SPDX-License-Identifier: Apache-2.0
"""One section of a definition file: its rows read, checked and made a ``PluginDefinition``.

``README.md`` has the grammar.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import DefinitionsError, SiteRow
from multibot_rewrite.base.naming import SEPARATORS
from multibot_rewrite.base.releases import RELEASES as KNOWN, is_release_words, share_release
from multibot_rewrite.description.rewriters.plugin_definitions.values import (
    ROLES as WIRES,
    VALUE,
    WiredTopic,
    is_typed,
    role_and_type,
    wired_topics,
)

TYPES = ("element", "plugin", "hardware", "sensor", "block")
# A section that names nothing: what some of the plugins of another section read, each for itself.
OF_VALUES = "values"
_WORDS = {name: tuple(words.split()) for name, words in own_rows(__file__, "grammar.schema")}
SETTINGS = (*_WORDS["settings"], *WIRES, *_WORDS["other settings"])
_HEADERS = (*TYPES, OF_VALUES)
# Settings that are one word out of few.
VALUES = {
    **dict.fromkeys(("insert", "open", "process_wide"), ("yes", "no")),
    "ros": ("1", "2"),
    "unique": tuple(SEPARATORS),
}
ROLES = ("declares", "uses", "keep")
KINDS = (*SEPARATORS, "collision")
OPTIONS = ("form", "default", "when", "empty", "fill", *WIRES)
RELEASES = "releases="
# A topic that comes from outside: the robot's own only where something in the file sends it.
SENT = "sent"
# Any model of the file, among the texts of a sibling on which a row depends.
MODEL = "{model}"
# What stands for it in a name that is made of one: no XML can hold that character.
SPAWNED = "\x01/"
EMPTY = ("default", "model", "itself")
FORMS = _WORDS["forms"]
# They have hundreds of paths, which are asked for again with every plugin.
PATHS = 4096
_NAME = r"[A-Za-z_][\w.:-]*"
_STEP = rf"{_NAME}(?:\[@{_NAME}=[^\[\]]+\])?"
_ONE_STEP = lazy_compile(_STEP)
_SWITCH = lazy_compile(rf"{_NAME}=[^\s=]+(?:=on)?")
_BARE_OPENS = ("nothing", "model", "namespace", "transforms", "world", "unknown")
_OPENS = lazy_compile(
    r"(address|device|port|file)(?:\+([1-9]\d*)(?:\.\.([1-9]\d*))?)?:"
    r"(?:([^\s?]+)\?)?((?:[^\s=\[]|\[@[^\]]*\])+)(?:=(\S+))?"
)
_PATH = lazy_compile(rf"(?=.)(?:{_STEP}(?:/{_STEP})*)?(?:@{_NAME})?")


class PluginDefinition(NamedTuple):
    """One section: what is known about an element, a plugin, a hardware class or a shared block.

    ``wired`` are topics and services that its code names. ``switches`` are parameters that turn one
    of them off, each as ``parameter=name``. ``inserts`` is false where the consumer throws on
    children it does not know. ``unique`` is a kind whose names the plugin looks up in the whole
    world. ``process_wide`` tells that its remap rules hold for every node of the process.
    ``hardwired`` are names it looks for whatever the file says, each as ``kind:name``.
    ``model_namespace`` are the releases in which its relative topics are below the namespace of the
    model. ``releases`` are the words for the only releases that have it. ``tags`` are those of the
    child elements that its rows know. ``opens`` is what it opens in addition to names, or that it
    opens nothing, or that this is not known. ``helper`` is a node that it starts in addition to its
    own, which only its namespace moves."""

    type: str
    names: tuple[str, ...]
    sites: tuple[SiteRow, ...]
    at: tuple[str, ...]
    blocks: tuple[str, ...]
    select: str
    ros: str
    wired: tuple[WiredTopic, ...]
    switches: tuple[str, ...]
    inserts: bool
    unique: str
    process_wide: bool
    hardwired: tuple[str, ...]
    model_namespace: str
    about: str
    source: str
    file: str
    line: int
    releases: str = ""
    tags: frozenset[str] = frozenset()
    opens: tuple[str, ...] = ()
    helper: str = ""

    @property
    def name(self) -> str:
        """The name reports and case files use: ``plugin gazebo_ros_diff_drive``."""
        flavour = f" (ROS {self.ros})" if self.ros else ""
        return f"{self.type} {self.names[0]}{flavour}"

    @property
    def topics(self) -> tuple[str, ...]:
        """All names that only a remap rule moves."""
        return tuple(it.name for it in self.wired if not it.is_moved)

    @property
    def publishes(self) -> tuple[str, ...]:
        """The ones of ``topics`` that it publishes."""
        return tuple(it.name for it in self.wired if it.role == WIRES[0] and not it.is_moved)


def read_header(place: str, row: str) -> tuple[str, ...]:
    """Return type and names of a section from its first row (without its ``[``)."""
    head, bracket, rest = row.partition("]")
    words = head.split()
    if not bracket or rest.strip() or len(words) < 2 or words[0] not in _HEADERS:
        raise DefinitionsError(
            f"{place}: section [{row.strip()} must be [TYPE NAME...], TYPE one of {', '.join(_HEADERS)}"
        )
    if len(set(words)) < len(words):
        raise DefinitionsError(f"{place}: section [{head}] has a name twice; remove one")
    return tuple(words)


def read_section(
    file: str, line: int, rows: list[str]
) -> tuple[dict[str, str], dict[str, SiteRow]]:
    """Return settings and sites of a section whose header is at ``line``.

    The sites are by path, and by release if one path has several.
    """
    section = " ".join(read_header(f"{file}:{line}", rows[0])[:2])
    settings: dict[str, str] = {}
    sites: dict[str, SiteRow] = {}
    at_path: dict[str, list[SiteRow]] = {}
    for number, row in enumerate(rows[1:], line + 1):
        words = row.split()
        if not words or row.startswith("#") or words[1:2] == [VALUE]:
            continue
        if words[0].endswith(":"):
            _add_setting(settings, f"{file}:{number}", words)
            continue
        site = _parse_site(f"{file}:{number}", section, number, row)
        before = at_path.setdefault(site.path, [])
        for other in before:
            if share_release(site.releases, other.releases):
                raise DefinitionsError(
                    f"{file}:{number}: {site.path} is in line {other.line} already; remove one"
                )
        before.append(site)
        sites[f"{site.path} {site.releases}".strip()] = site
    return settings, sites


def assemble(
    file: str,
    line: int,
    header: tuple[str, ...],
    settings: dict[str, str],
    sites: Sequence[SiteRow],
) -> PluginDefinition:
    """Return a section from its parts; ``sites`` include those of its blocks."""
    if header[0] == "element" and "at" not in settings:
        raise DefinitionsError(
            f"{file}:{line}: [{' '.join(header)}] needs at: the elements it is in"
        )
    namespaced = any("namespace" in site.kinds for site in sites)
    below = settings.get("model_namespace", "")

    def words(key: str) -> tuple[str, ...]:
        return tuple(settings.get(key, "").split())

    return PluginDefinition(
        header[0],
        header[1:],
        tuple(site._replace(namespaced=namespaced, below_model=below) for site in sites),
        words("at"),
        words("with"),
        settings.get("select", ""),
        settings.get("ros", ""),
        tuple(wired_topics(f"{file}:{line}", settings)),
        words("switches"),
        settings.get("insert", "yes") == "yes",
        settings.get("unique", ""),
        settings.get("process_wide", "no") == "yes",
        words("hardwired"),
        below,
        settings.get("about", ""),
        settings.get("source") or _checkout_source(settings.get("read", "")),
        file,
        line,
        settings.get("releases", ""),
        _first_tags(sites),
        words("opens"),
        settings.get("helper", ""),
    )


def _checkout_source(words: str) -> str:
    """Return the repository and path in the setting ``read``, without the tag."""
    repository, _, rest = words.partition(" ")
    return f"{repository} {rest.partition(' ')[2]}".strip()


def _first_tags(sites: Iterable[SiteRow]) -> frozenset[str]:
    paths = (split_path(site.path)[0] for site in sites if site.path[0] != "@")
    return frozenset(split_step(steps[0])[0] for steps in paths)


def _add_setting(settings: dict[str, str], place: str, words: list[str]) -> None:
    key = words[0][:-1]
    if key not in SETTINGS:
        raise DefinitionsError(
            f"{place}: unknown setting {key!r}, use one of {', '.join(SETTINGS)}"
        )
    value = " ".join([settings[key], *words[1:]] if key in settings else words[1:])
    allowed = VALUES.get(key)
    if not value or (allowed and value not in allowed):
        choice = " or ".join(allowed or ("text",))
        raise DefinitionsError(f"{place}: {key}: is {value!r}, use {choice}")
    if key in ("releases", "model_namespace") and not is_release_words(value):
        raise DefinitionsError(f"{place}: {key}: {_no_releases(value)}")
    if wrong := [it for it in words[1:] if key == "switches" and not _SWITCH.fullmatch(it)]:
        raise DefinitionsError(f"{place}: switches: {wrong[0]!r} is not PARAMETER=TOPIC[=on]")
    opened = [word for word in words[1:] if key == "opens" and word not in _BARE_OPENS]
    if wrong := [word for word in opened if not _OPENS.fullmatch(word)]:
        raise DefinitionsError(
            f"{place}: opens: {wrong[0]!r} is not {', '.join(_BARE_OPENS)}, "
            "address:PATH=DEFAULT, address+STEP..LAST:PATH=DEFAULT, device:PATH, port:PATH or file:PATH"
        )
    tuple(wired_topics(place, {key: value}))
    settings[key] = value


def _parse_site(place: str, section: str, line: int, row: str) -> SiteRow:
    file = place.rpartition(":")[0]
    spec, _, note = row.partition(" # ")
    path, *words = spec.split()
    if not _PATH.fullmatch(path):
        raise DefinitionsError(f"{place}: bad path {path!r}: write a/b, a@x, @x or a[@x=y]/b")
    if not words or words[0] not in ROLES:
        raise DefinitionsError(
            f"{place}: {path} needs one of {', '.join((*ROLES, VALUE))} after it"
        )
    role, *rest = words
    releases = next((it[len(RELEASES) :] for it in rest if it.startswith(RELEASES)), "")
    if releases and not is_release_words(releases):
        raise DefinitionsError(f"{place}: {path} releases={_no_releases(releases)}")
    rest = [word for word in rest if not (word.startswith(RELEASES) or is_typed(word))]
    if role == "keep":
        if not rest:
            raise DefinitionsError(f"{place}: {path} keep: say why it must stay")
        why = " ".join(rest)
        more = {"file": file, "releases": releases}
        return SiteRow(path, role, (), "whole", "", False, section, why, line, **more)
    options = dict(word.split("=", 1) for word in rest if "=" in word)
    kinds = tuple(word for word in rest if "=" not in word)
    _check_words(place, path, kinds, options)
    form, default = options.get("form", "whole"), options.get("default", "")
    plain = kinds[0] if form == "whole" and kinds in (("link",), ("joint",)) else ""
    when = options.get("when", "")
    empty = options.get("empty", "default" if kinds[0] == "namespace" else "itself")
    note = note.strip()
    own = (path, role, kinds, form, default, False, section, note, line)
    fill = options.get("fill", "")
    does, type_ = role_and_type(place, options)
    return SiteRow(*own, plain, when, file, empty, "", releases, fill, does, type_)


def _no_releases(words: str) -> str:
    return f"{words!r} names no releases, write jazzy, kilted+ or <=jazzy, of {', '.join(KNOWN)}"


def _check_words(place: str, path: str, kinds: Iterable[str], options: dict[str, str]) -> None:
    kinds = list(kinds)
    if not kinds:
        raise DefinitionsError(f"{place}: {path} has no kind, use one of {', '.join(KINDS)}")
    checks = (
        (kinds, KINDS, "kind"),
        (options, OPTIONS, "option"),
        ([options.get("form", "whole")], FORMS, "form"),
        ([options.get("empty", "itself")], EMPTY, "empty="),
    )
    for words, allowed, what in checks:
        for word in words:
            if word not in allowed:
                raise DefinitionsError(
                    f"{place}: unknown {what} {word!r}, use one of {', '.join(allowed)}"
                )


def is_step(text: str) -> bool:
    """Return whether a text is one step of a path, as a definition file may have it."""
    return _ONE_STEP.fullmatch(text) is not None


class Opened(NamedTuple):
    """A word of ``opens:``; numbers go by ``step`` up to ``last``. All empty without a path."""

    kind: str = ""
    step: str = ""
    last: str = ""
    when: str = ""
    path: str = ""
    default: str = ""

    @property
    def numbers(self) -> tuple[int, int]:
        """The step and the last number."""
        return int(self.step), int(self.last or 65535)


def split_opens(word: str) -> Opened:
    """Return the parts of an entry of ``opens:``."""
    found = None if word in _BARE_OPENS else _OPENS.fullmatch(word)
    return Opened(*found.groups(default="")) if found else Opened()


@lru_cache(maxsize=PATHS)
def split_path(path: str) -> tuple[tuple[str, ...], str]:
    """Return the child steps of a path, and the attribute at its end or an empty string."""
    bracket = path.rfind("]") + 1
    steps, _, attribute = path[bracket:].partition("@")
    whole = path[:bracket] + steps
    return (tuple(whole.split("/")) if whole else ()), attribute


@lru_cache(maxsize=PATHS)
def split_step(step: str) -> tuple[str, str, str]:
    """Return tag, attribute and wanted value of ``param[@name=mimic]``; empty where not given."""
    tag, _, ask = step.partition("[@")
    attribute, _, value = ask.rstrip("]").partition("=")
    return tag, attribute, value
