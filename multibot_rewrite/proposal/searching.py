# SPDX-License-Identifier: Apache-2.0
"""Finds the files of robots in folders, by what they are for.

A xacro counts as a description if it names a robot and no other file includes it.
"""

import os
import re
import shlex
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from itertools import permutations
from typing import Any, NamedTuple

from multibot_rewrite import fleet
from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.file_kinds import (
    DESCRIPTIONS,
    SDF,
    SRDF,
    WORLD,
    recognised,
    refuse_others,
)
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.left_out import source_folders
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.sources.included_by import (
    MOST_FILES,
    TESTS,
    data_of_file,
    includers,
    parts_among,
)
from multibot_rewrite.description.sources.packages import (
    MANIFEST as PACKAGE,
    package_of,
    packages_below,
)
from multibot_rewrite.description.sources.release_said import MANIFEST
from multibot_rewrite.fleet.outputs.output_file import PLAN
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder
from multibot_rewrite.proposal.launches import Reading, order_text, read_any, read_named

# Files that are shown where nothing says which is meant.
MOST_SHOWN = 6
# Files that go with a description, never one themselves.
_BESIDE = (".yaml", ".yml", ".rviz", ".srdf")
_ROBOT = re.compile(rb"<robot\b[^<>]*\sname\s*=")
# What urdf-postfix has written is made of the robot that is meant.
_REWRITTEN = re.compile(rb"<!-- multibot (\S+) \+\d|^[^\S\n]*# multibot: ", re.MULTILINE)
_WORDS, _PARTS = re.compile(rb"[\w/.-]+"), re.compile(rb"[\s/_]+")
_XML = (".urdf", ".sdf")
_LINK = re.compile(rb"<link\b[^<>]*")
# So many files of as many words are compared.
MOST_FILES_ALIKE = 20
_STATIC = re.compile(rb"<static>\s*(?:true|1)\s*</static>")
_BRIDGE = re.compile(
    rb"^[^\S\n]*(?:- *)?(?:ros_topic_name|gz_topic_name|topic_name) *:", re.MULTILINE
)
# What launch files begin with, in a folder of theirs: many are called up.py.
_LAUNCH = re.compile(rb"^def generate_launch_description|^[^\S\n]*<launch\b", re.MULTILINE)


@cache
def known_names() -> Mapping[str, Any]:
    """Return the names of ``names.yaml``."""
    return load_own_yaml(fleet.__file__, "names.yaml")  # type: ignore[no-any-return]


class Found(NamedTuple):
    """Files by what they are for, each sorted; ``srdf`` are xacros, too. ``folders`` were searched.

    ``descriptions`` are those that were named, if any were; ``every`` are all that are there,
    ``parts`` are those that another one includes. ``meant`` are related files that were named,
    ``follows`` those with the description that was named before each, ``named`` is the launch file
    that was."""

    descriptions: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    rviz: tuple[str, ...] = ()
    bridge: tuple[str, ...] = ()
    moveit: tuple[str, ...] = ()
    behavior_trees: tuple[str, ...] = ()
    srdf: tuple[str, ...] = ()
    launch: tuple[str, ...] = ()
    worlds: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    every: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()
    meant: tuple[str, ...] = ()
    follows: tuple[tuple[str, str], ...] = ()
    named: tuple[LaunchOrder, ...] = ()

    @property
    def words(self) -> list[str]:
        """The arguments that name the launch files, ``--launch FILE ...``; raises nothing."""
        words = (shlex.split(order_text(it, os.curdir)) for it in self.named)
        return [word for it in words for word in ("--launch", *it)]

    @property
    def read(self) -> list[Reading]:
        """What its launch files start: the named ones with their arguments, or all others with any.

        Raises InputError for a named one that cannot be read."""
        return [*map(read_named, self.named)] or read_any(self.launch)


def search(paths: Sequence[str], launch: Sequence[LaunchOrder] = ()) -> Found:
    """Return the files of named descriptions and folders, or of the only ``launch`` file.

    A description brings the files of its package. Raises UsageError for a path that does not
    exist, InputError for a file of another kind."""
    for path in paths:
        if not os.path.exists(path):
            link = os.path.islink(path)
            what = "it is a link to nothing" if link else "there is no such file or folder"
            inside = [*map(os.path.relpath, packages_below((os.getcwd(),)).get(path, ()))]
            hint = f"did you mean {inside[0]}?" if inside else "give a description or a folder"
            raise UsageError(f"{path or repr(path)}: {what}; {hint}")
        if not _can_be_named(path):
            raise UsageError(f"{path}: its name is not UTF-8, and YAML takes no other; rename it")
    named = [*dict.fromkeys(os.path.normpath(it) for it in paths if not os.path.isdir(it))]
    meant = [it for it in named if it.endswith(_BESIDE)]
    files = [it for it in named if it not in meant]
    folders = [os.path.normpath(it) for it in paths if os.path.isdir(it)]
    # What goes with a description is none: without one it is told by what it is.
    for path in files if files or folders else meant:
        refuse_others(data_of_file(path), path, *DESCRIPTIONS)
    apart = (it for it in files if not any(is_below(it, folder) for folder in folders))
    homes = dict.fromkeys((*folders, *map(home_of, apart)))
    below = (path for home in homes for path in _candidates(home, home in folders))
    every = dict.fromkeys((*below, *meant))
    told = dict(_with_kinds(every, [*map(read_named, launch)]))
    written = {*_rewritten_files(told)} - {*named}
    kinds = lists_by_key((kind, path) for path, kind in told.items() if path not in written)
    kinds["every"] = kinds.get("descriptions", [])
    if files:
        kinds["descriptions"] = files
    fields: dict[str, Any] = {kind: tuple(its) for kind, its in kinds.items() if kind}
    if launch:
        fields["launch"] = tuple(it.file for it in launch)
    above = ((it, [one for one in named[:at] if one in files]) for at, it in enumerate(named))
    follows = tuple((it, before[-1]) for it, before in above if it in meant and before)
    fields |= {"meant": tuple(meant), "follows": follows, "named": tuple(launch)}
    return Found(**fields, folders=tuple(homes))


def loaded_by(graph: LaunchGraph, found: Found) -> Mapping[str, str]:
    """Return by real path the descriptions that a launch file reads, gives or puts in a world."""
    # By real path; the path is as the search found it, otherwise relative.
    known = {os.path.realpath(it): it for it in found.every}
    ends = tuple(known_names()["ends"])
    words = (it for node in graph.nodes for it in node.arguments if it.endswith(ends))
    real = dict.fromkeys((*(it.file for it in graph.read), *map(os.path.realpath, words)))
    texts = [text_of(it) for it in real if it in map(os.path.realpath, found.worlds)]
    uris = {it: f"model://{os.path.basename(os.path.dirname(it))}<" for it in known}
    models = (it for it, uri in uris.items() if any(uri in text for text in texts))
    own = {it: known.get(it) or os.path.relpath(it) for it in (*real, *models)}
    there = (it for it in own if it not in known and os.path.isfile(it))
    read = {it for it in there if _field_of(it, data_of_file(it)) == "descriptions"}
    return {it: path for it, path in own.items() if it in known or it in read}


class Undecided(UsageError):
    """Nothing says which of some files is meant: ``files`` have what is to be said of each."""

    def __init__(self, what: str, files: Mapping[str, str], found: Found, *before: str) -> None:
        """``before`` are files that are named before the choice, as are those named already."""
        self.files = files
        named = [*before, *found.meant, next(iter(files))]
        home = os.path.abspath(home_of(named[0]))
        folders = [it for it in found.folders if os.path.abspath(it) != home]
        shown = shorten(map(self.said, files), MOST_SHOWN)
        command = f"multibot init {shlex.join([*folders, *named, *found.words])}"
        super().__init__(f"{what}: {shown}; name one: {command}")

    def said(self, path: str) -> str:
        """Return a file as a message shows it."""
        return f"{path} ({self.files[path]})" if self.files[path] else path


def without(found: Found, paths: Container[str]) -> Found:
    """Return what was found, without some files of whatever kind."""
    kept = {
        kind: tuple(it for it in its if it not in paths) for kind, its in found._asdict().items()
    }
    return found._replace(**kept)


def home_of(file: str) -> str:
    """Return the package of a file, as a path like the file's; its folder where it is in none."""
    package = package_of(file)
    return os.path.relpath(package[1]) if package else os.path.dirname(file) or os.curdir


def is_below(path: str, folder: str) -> bool:
    """Return whether a path is in the folder, however both are written."""
    above = os.path.join(os.path.abspath(folder), "")
    return os.path.abspath(path).startswith(above)


def _candidates(folder: str, with_packages: bool) -> Iterator[str]:
    """Yield the files below a folder that may be a robot's, not those of other packages in it."""
    seen = 0
    ends = tuple(known_names()["ends"])
    for above, folders, names in os.walk(folder):
        # What a build has written is made of the robots that are meant.
        is_package = PACKAGE in names and not with_packages
        if above != folder and (is_package or {MANIFEST, PLAN} <= {*names}):
            folders[:] = []
            continue
        folders[:] = (it for it in source_folders(above, folders) if it not in TESTS)
        for name in sorted(names):
            seen += 1
            if seen > MOST_FILES:
                hint = "name the folder of one package"
                raise UsageError(f"{folder}: it has more than {MOST_FILES} files; {hint}")
            path = os.path.normpath(os.path.join(above, name))
            if name.endswith(ends) and name[0] != "." and _can_be_named(path):
                yield path


def _can_be_named(path: str) -> bool:
    """Return whether a fleet file, which is UTF-8, can name a path."""
    return path.isascii() or not any("\ud800" <= it <= "\udfff" for it in path)


def _with_kinds(paths: Iterable[str], named: Sequence[Reading]) -> Iterator[tuple[str, str]]:
    """Yield each path with its kind; files that are only included are parts."""
    kinds: dict[str, str] = {}

    def texts() -> Iterator[tuple[str, bytes]]:
        """Yield path and bytes of each file, and note its kind."""
        for path in paths:
            data = data_of_file(path)
            kinds[path] = _field_of(path, data)
            yield path, data

    parts = parts_among(kinds, includers(texts()))
    # One that a launch file expands by itself is a robot.
    launch = [it for it, kind in kinds.items() if kind == "launch"] if parts else []
    read = named or read_any(launch)
    loaded = {one.file for it in read for one in it.graph.read}
    parts = {it for it in parts if os.path.realpath(it) not in loaded}
    for it, kind in kinds.items():
        yield it, "parts" if kind == "descriptions" and it in parts else kind


def _rewritten_files(paths: Iterable[str]) -> Iterator[str]:
    """Yield the files that urdf-postfix has written, by its comments or the robot's names."""
    # Such a description has the name at each link; what goes with descriptions is known by it.
    texts = {it: data_of_file(it) for it in sorted(paths, key=lambda it: not it.endswith(_XML))}
    marked = {it: found for it, text in texts.items() if (found := _REWRITTEN.search(text))}
    yield from marked
    tags = {it[1] for it in marked.values()}
    for alike in lists_by_key((text.count(b"\n"), it) for it, text in texts.items()).values():
        for source, path in permutations(alike[:MOST_FILES_ALIKE], 2):
            both = (_WORDS.finditer(texts[it]) for it in (source, path))
            words = ((one[0], other[0]) for one, other in zip(*both, strict=False))
            old, new = next((it for it in words if it[0] != it[1]), (b"", b""))
            affix = new.replace(old.strip(b"/"), b"", 1) if old in new else b""
            tag = affix.strip(b"/_")
            links = _LINK.findall(texts[path]) if tag != affix and tag[:1].isalpha() else []
            if not (all(tag in it for it in links) if links[1:] else tag in tags):
                continue
            if len({_PARTS.sub(b"", texts[it].replace(tag, b"")) for it in (source, path)}) == 1:
                tags.add(tag)
                yield path


@lru_cache(maxsize=512)
def text_of(path: str) -> str:
    """Return the text of a file such as a launch file; empty where it cannot be read."""
    return data_of_file(path).decode("utf-8", "replace")


def _field_of(path: str, data: bytes) -> str:
    """Return the field of ``Found`` that a file goes into; empty for none."""
    stem, end = os.path.splitext(os.path.basename(path))
    above = os.path.basename(os.path.dirname(path))
    if stem.endswith((".launch", "_launch")) or (above == "launch" and _LAUNCH.search(data)):
        return "launch"
    if end in _BY_NAME:
        return _BY_NAME[end]
    read = _BY_TEXT.get(end)
    kind = read(stem, data) if read else ""
    return "" if kind == "descriptions" and _REWRITTEN.search(data) else kind


def _kind_of_model(_: str, data: bytes) -> str:
    """Return the kind of a file by its contents, as for a named file."""
    kind = recognised(data)
    if kind == SDF and (b"<model" not in data or _STATIC.search(data)):
        return ""
    return _BY_KIND.get(kind, "")


def _kind_of_xacro(stem: str, data: bytes) -> str:
    """Return the kind of a xacro; one that names no robot is a part of others."""
    kind = _kind_of_model(stem, data)
    if kind != "descriptions" or recognised(data) == SDF:
        return kind
    if not _ROBOT.search(data):
        return ""
    return "srdf" if ".srdf" in stem or b"<group " in data else kind


def _kind_of_yaml(stem: str, data: bytes) -> str:
    """Return the kind of a YAML file: params, bridge or moveit; empty for none."""
    if b"ros__parameters" in data:
        return "params"
    if _BRIDGE.search(data) and _is_list(data):
        return "bridge"
    return "moveit" if stem in known_names()["moveit"] else ""


def _is_list(data: bytes) -> bool:
    """Return whether a YAML text is a list, as those of bridges are."""
    lines = (it.strip() for it in data.splitlines())
    first = next((it for it in lines if it and not it.startswith((b"#", b"%", b"---"))), b"")
    return first.startswith((b"-", b"["))


_BY_NAME = {".srdf": "srdf", ".rviz": "rviz"}
_BY_KIND = {WORLD: "worlds", SRDF: "srdf", **dict.fromkeys(DESCRIPTIONS, "descriptions")}
_BY_TEXT: Mapping[str, Callable[[str, bytes], str]] = {
    **dict.fromkeys((".urdf", ".sdf", ".model", ".world"), _kind_of_model),
    ".xacro": _kind_of_xacro,
    ".yaml": _kind_of_yaml, ".yml": _kind_of_yaml,
    ".xml": lambda _, data: "behavior_trees" if b"<BehaviorTree" in data else "",
}  # fmt: skip
