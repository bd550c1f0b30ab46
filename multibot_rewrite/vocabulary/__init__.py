"""The vocabulary: which tag of which plugin holds which name. Data in ``*.vocab``, read lazily.

A file is a list of sections. The whole grammar:

    # a comment
    [element sensor]                     an XML element; names after the first are aliases
    at: gazebo link                      the elements it may stand in ("/" is the document)
    @name        declares sensor         the value at this path declares a name of this kind
    plugin/frame uses frame              the value refers to one (kinds are tried in order)
    @type        keep an enumeration     the value is never renamed, and why

A path is child steps, then ``@attribute`` for an attribute; a step may ask for an attribute:
``param[@name=mimic]``. After the kinds may stand ``form=NAME`` (where in the value the names are)
and ``default=TEXT`` (the literal the consumer falls back to; ``topic/../x`` is the value at ``topic``
with its last segment replaced) and ``when=SIBLING=TEXT`` (else it is no name of ours), then
``# a note``.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.model import Site, VocabularyError
from multibot_rewrite.naming import SEPARATORS

TYPES = ("element", "plugin", "hardware", "sensor", "block")
SETTINGS = (
    "at",
    "about",
    "source",
    "with",
    "select",
    "ros",
    "publishes",
    "subscribes",
    "serves",
    "insert",
)
ROLES = ("declares", "uses", "keep")
KINDS = (*SEPARATORS, "collision")
OPTIONS = ("form", "default", "when")
FORMS = ("whole", "list", "scoped", "prefix", "remap", "argument", "collision")
HERE = os.path.dirname(__file__)


class Rewriter(NamedTuple):
    """One section: what is known about an element, a plugin, a hardware class or a shared block.

    ``publishes``, ``subscribes`` and ``serves`` are topics and services that no element controls:
    only a remap rule moves them.
    ``inserts`` is false where the consumer throws on children it does not know.
    """

    type: str
    names: tuple[str, ...]
    sites: tuple[Site, ...]
    at: tuple[str, ...]
    blocks: tuple[str, ...]
    select: str
    ros: str
    publishes: tuple[str, ...]
    subscribes: tuple[str, ...]
    serves: tuple[str, ...]
    inserts: bool
    about: str
    source: str
    file: str
    line: int

    @property
    def name(self) -> str:
        """The name reports and case files use: ``plugin gazebo_ros_diff_drive``."""
        flavour = f" (ROS {self.ros})" if self.ros else ""
        return f"{self.type} {self.names[0]}{flavour}"

    @property
    def topics(self) -> tuple[str, ...]:
        """All names that only a remap rule moves."""
        return self.publishes + self.subscribes + self.serves


class Vocabulary:
    """The sections of several files, parsed on demand; build with ``load_vocabulary``."""

    def __init__(self, texts: Mapping[str, str]) -> None:
        self._raw: dict[tuple[str, str], list[tuple[str, int, str]]] = {}
        self._parsed: dict[tuple[str, int], Rewriter] = {}
        for file, text in texts.items():
            self._index(file, text)

    def _index(self, file: str, text: str) -> None:
        preamble, *chunks = ("\n" + text).split("\n[")
        if any(row and not row.startswith("#") for row in preamble.split("\n")):
            raise VocabularyError(f"{file}:1: text before the first [section]")
        line = preamble.count("\n") + 1
        for chunk in chunks:
            self._enter(file, line, chunk.partition("]")[0].split(), chunk)
            line += chunk.count("\n") + 1

    def _enter(self, file: str, line: int, words: list[str], chunk: str) -> None:
        if len(words) < 2 or words[0] not in TYPES:
            raise VocabularyError(
                f"{file}:{line}: section [{' '.join(words)}] must be [TYPE NAME...], "
                f"TYPE one of {', '.join(TYPES)}"
            )
        for name in words[1:]:
            self._raw.setdefault((words[0], name), []).append((file, line, chunk))

    def find(self, type_: str, name: str) -> list[Rewriter]:
        """The rewriters of that type under that name: more than one where ROS 1 and 2 differ."""
        return [self._parse(*raw) for raw in self._raw.get((type_, name), ())]

    def names(self, type_: str) -> list[str]:
        """Every name and alias of that type."""
        return [name for kind, name in self._raw if kind == type_]

    def rewriters(self, *types: str) -> list[Rewriter]:
        """All rewriters of these types, parsed and checked, in file order."""
        unique = {
            raw[:2]: raw for key, raws in self._raw.items() if key[0] in types for raw in raws
        }
        return [self._parse(*raw) for raw in unique.values()]

    def _parse(self, file: str, line: int, chunk: str) -> Rewriter:
        known = self._parsed.get((file, line))
        if known is None:
            known = self._parsed[file, line] = self._read(file, line, chunk)
        return known

    def _read(self, file: str, line: int, chunk: str) -> Rewriter:
        rows = chunk.split("\n")
        type_, *names = rows[0].partition("]")[0].split()
        settings: dict[str, str] = {}
        sites: dict[str, Site] = {}
        for number, row in enumerate(rows[1:], line + 1):
            words = row.split()
            if not words or row.startswith("#"):
                continue
            if words[0].endswith(":"):
                _setting(settings, f"{file}:{number}", words)
                continue
            site = _site(f"{file}:{number}", f"{type_} {names[0]}", number, row)
            if site.path in sites:
                raise VocabularyError(
                    f"{file}:{number}: {site.path} is there already, at line "
                    f"{sites[site.path].line}"
                )
            sites[site.path] = site
        blocks = [self._block(f"{file}:{line}", name) for name in settings.get("with", "").split()]
        return _assemble(file, line, (type_, *names), settings, sites, blocks)

    def _block(self, place: str, name: str) -> Rewriter:
        found = self.find("block", name)
        if not found:
            raise VocabularyError(f"{place}: with: {name}: there is no [block {name}]")
        return found[0]


def _assemble(
    file: str,
    line: int,
    header: tuple[str, ...],
    settings: dict[str, str],
    sites: dict[str, Site],
    blocks: list[Rewriter],
) -> Rewriter:
    merged = {site.path: site for block in blocks for site in block.sites} | sites
    namespaced = any("namespace" in site.kinds for site in merged.values())
    own = tuple(site._replace(namespaced=namespaced) for site in merged.values())
    return Rewriter(
        header[0],
        header[1:],
        own,
        tuple(settings.get("at", "").split()),
        tuple(settings.get("with", "").split()),
        settings.get("select", ""),
        settings.get("ros", ""),
        tuple(settings.get("publishes", "").split()),
        tuple(settings.get("subscribes", "").split()),
        tuple(settings.get("serves", "").split()),
        settings.get("insert", "yes") == "yes",
        settings.get("about", ""),
        settings.get("source", ""),
        file,
        line,
    )


def _setting(settings: dict[str, str], place: str, words: list[str]) -> None:
    key = words[0][:-1]
    if key not in SETTINGS:
        raise VocabularyError(f"{place}: unknown setting {key!r}, use one of {', '.join(SETTINGS)}")
    value = " ".join(words[1:])
    allowed = {"ros": ("1", "2"), "insert": ("yes", "no")}.get(key)
    if not value or (allowed and value not in allowed):
        raise VocabularyError(
            f"{place}: {key}: is {value!r}, use {' or '.join(allowed or ('text',))}"
        )
    settings[key] = f"{settings[key]} {value}" if key in settings else value


def _site(place: str, section: str, line: int, row: str) -> Site:
    spec, _, note = row.partition(" # ")
    path, *words = spec.split()
    _check_path(place, path)
    if not words or words[0] not in ROLES:
        raise VocabularyError(f"{place}: {path} needs one of {', '.join(ROLES)} after it")
    role, *rest = words
    if role == "keep":
        return Site(path, role, (), "whole", "", False, section, " ".join(rest), line)
    options = dict(word.split("=", 1) for word in rest if "=" in word)
    kinds = tuple(word for word in rest if "=" not in word)
    _check_words(place, path, kinds, options)
    form, default = options.get("form", "whole"), options.get("default", "")
    plain = kinds[0] if form == "whole" and kinds in (("link",), ("joint",)) else ""
    when = options.get("when", "")
    return Site(path, role, kinds, form, default, False, section, note.strip(), line, plain, when)


def _check_words(place: str, path: str, kinds: Iterable[str], options: dict[str, str]) -> None:
    kinds = list(kinds)
    if not kinds:
        raise VocabularyError(f"{place}: {path} has no kind, use one of {', '.join(KINDS)}")
    checks = ((kinds, KINDS, "kind"), (options, OPTIONS, "option"))
    for words, allowed, what in (*checks, ([options.get("form", "whole")], FORMS, "form")):
        for word in words:
            if word not in allowed:
                raise VocabularyError(
                    f"{place}: unknown {what} {word!r}, use one of {', '.join(allowed)}"
                )


def split_path(path: str) -> tuple[list[str], str]:
    """The child steps of a path, and the attribute at its end or an empty string."""
    bracket = path.rfind("]") + 1
    steps, _, attribute = path[bracket:].partition("@")
    whole = path[:bracket] + steps
    return (whole.split("/") if whole else []), attribute


def split_step(step: str) -> tuple[str, str, str]:
    """Tag, attribute and wanted value of a step: ``param[@name=mimic]``; empty where not asked."""
    tag, _, ask = step.partition("[@")
    attribute, _, value = ask.rstrip("]").partition("=")
    return tag, attribute, value


def _check_path(place: str, path: str) -> None:
    # Nearly every path is of this kind, and this is the start-up of the command.
    simple = path.replace("/", "x").replace("_", "x").replace("@", "x", 1).isalnum()
    if simple and path[-1] not in "@/" and path[0] != "/" and "//" not in path:
        return
    steps, attribute = split_path(path)
    words = [word for step in steps for word in split_step(step) if word or "[" in step]
    tags = [split_step(step)[0] for step in steps]
    bad = not all(tags) or not all(words) or set("".join(tags) + attribute) & set("@[]=<>\"'|()")
    if bad or not (steps or attribute) or path.endswith("@"):
        raise VocabularyError(f"{place}: bad path {path!r}: write a/b, a@x, @x or a[@x=y]/b")


@lru_cache(maxsize=8)
def load_vocabulary(extra: tuple[str, ...] = ()) -> Vocabulary:
    """The built-in vocabulary and the files named in ``extra``.

    Raises VocabularyError, naming file and line, when a section that is used has a mistake;
    ``check_vocabulary`` reads every section.
    """
    builtin = sorted(name for name in os.listdir(HERE) if name.endswith(".vocab"))
    texts = {name: _text(f"{HERE}/{name}") for name in builtin}
    texts |= {sys.intern(path): _text(path) for path in extra}
    return Vocabulary(texts)


def _text(path: str) -> str:
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise VocabularyError(f"{path}: cannot be read: {error}") from None


def check_vocabulary(vocabulary: Vocabulary) -> list[Rewriter]:
    """Parse every section; raises VocabularyError for the first mistake."""
    return vocabulary.rewriters(*TYPES)
