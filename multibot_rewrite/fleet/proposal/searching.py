"""Folders -> the files of robots in them, by what they are for, and which belong to another
description, by place and by what they name.

A xacro counts as a description if it names a robot and no other file includes it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.fleet.proposal.looking import Looked

# Files that are looked at; of a larger one nothing is read.
MOST_FILES, MOST_BYTES = 20_000, 4_000_000
_SKIPPED = frozenset(("build", "install", "log", "node_modules", "test", "tests", "__pycache__"))
_ENDS = (".urdf", ".sdf", ".xacro", ".srdf", ".yaml", ".yml", ".rviz", ".xml", ".py")
_ROBOT = re.compile(rb"<robot\b[^>]*\sname\s*=")
_INCLUDED = re.compile(rb"""<(?:\w+:)?include\b[^>]*\bfilename\s*=\s*["'][^"']*?([^/"']+)["']""")
_BRIDGE = re.compile(rb"^\s*(?:- *)?(?:ros_topic_name|gz_topic_name|topic_name) *:", re.MULTILINE)
# MoveIt's own files, by the names that its setup assistant gives them.
_MOVEIT = frozenset(
    (
        "kinematics",
        "joint_limits",
        "ompl_planning",
        "moveit_controllers",
        "sensors_3d",
        "moveit_servo",
    )
)


class Found(NamedTuple):
    """Files by what they are for, each sorted; ``srdf`` are xacros, too. ``folders`` were searched.

    ``descriptions`` are those that were named, if any were; ``every`` are all that are there.
    """

    descriptions: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    rviz: tuple[str, ...] = ()
    bridge: tuple[str, ...] = ()
    moveit: tuple[str, ...] = ()
    behavior_trees: tuple[str, ...] = ()
    srdf: tuple[str, ...] = ()
    launch: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    every: tuple[str, ...] = ()


def search(paths: Sequence[str]) -> Found:
    """What there is for the descriptions and folders that are named.

    With a description goes what is in its package; raises UsageError for a path that is not there.
    """
    for path in paths:
        if not os.path.exists(path):
            raise UsageError(
                f"{path}: there is no such file or folder; give a description or a folder"
            )
    files = [os.path.normpath(it) for it in paths if not os.path.isdir(it)]
    folders = [os.path.normpath(it) for it in paths if os.path.isdir(it)]
    homes = dict.fromkeys((*folders, *(home_of(it) for it in files)))
    every = dict.fromkeys(path for home in homes for path in _files(home))
    kinds: dict[str, list[str]] = {}
    for path, kind in _sorted(every):
        kinds.setdefault(kind, []).append(path)
    kinds["every"] = kinds.get("descriptions", [])
    if files:
        kinds["descriptions"] = files
    named = {kind: tuple(its) for kind, its in kinds.items() if kind}
    return Found(**named, folders=tuple(homes))


def without(found: Found, paths: Container[str]) -> Found:
    """The same without some files, of whatever kind."""
    kept = (tuple(it for it in its if it not in paths) for its in found)
    return Found(*kept)


def home_of(file: str) -> str:
    """The package of a file, as a path like the file's; its folder where it is in none."""
    package = package_of(file)
    return os.path.relpath(package[1]) if package else os.path.dirname(file) or os.curdir


def _files(folder: str) -> Iterator[str]:
    seen = 0
    for above, folders, names in os.walk(folder):
        folders[:] = sorted(it for it in folders if it[0] != "." and it not in _SKIPPED)
        for name in sorted(names):
            seen += 1
            if seen > MOST_FILES:
                hint = "name the folder of one package"
                raise UsageError(f"{folder}: it has more than {MOST_FILES} files; {hint}")
            if name.endswith(_ENDS):
                yield os.path.normpath(os.path.join(above, name))


def _sorted(paths: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Each path with its kind; those that others include are none."""
    kinds, included = {}, set()
    for path in paths:
        data = _data(path)
        kinds[path] = _kind(path, data)
        if path.endswith(".xacro"):
            included |= {it.decode("utf-8", "replace") for it in _INCLUDED.findall(data)}
    for path, kind in kinds.items():
        if kind != "descriptions" or os.path.basename(path) not in included:
            yield path, kind


def _data(path: str) -> bytes:
    try:
        return read_bytes(path, MOST_BYTES)
    except OSError:
        return b""


def _kind(path: str, data: bytes) -> str:
    """The field of ``Found`` that a file goes into; empty for none."""
    stem, end = os.path.splitext(os.path.basename(path))
    if stem.endswith((".launch", "_launch")):
        return "launch"
    if end in _BY_NAME:
        return _BY_NAME[end]
    read = _BY_TEXT.get(end)
    return read(stem, data) if read else ""


def _of_urdf(_: str, data: bytes) -> str:
    return "descriptions" if b"<robot" in data else ""


def _of_sdf(_: str, data: bytes) -> str:
    return "descriptions" if b"<model" in data and b"<world" not in data else ""


def _of_xml(_: str, data: bytes) -> str:
    return "behavior_trees" if b"<BehaviorTree" in data else ""


def _of_xacro(stem: str, data: bytes) -> str:
    if not _ROBOT.search(data):
        return ""
    return "srdf" if ".srdf" in stem or b"<group " in data else "descriptions"


def _of_yaml(stem: str, data: bytes) -> str:
    if b"ros__parameters" in data:
        return "params"
    if _BRIDGE.search(data):
        return "bridge"
    return "moveit" if stem in _MOVEIT else ""


_BY_NAME = {".srdf": "srdf", ".rviz": "rviz"}
_BY_TEXT = {
    ".urdf": _of_urdf, ".sdf": _of_sdf, ".xacro": _of_xacro,
    ".yaml": _of_yaml, ".yml": _of_yaml, ".xml": _of_xml,
}  # fmt: skip


# Descriptions whose names are looked at.
MOST = 60
_NAMED = re.compile(rb"""<(?:link|joint)\b[^>]*?\bname\s*=\s*["']([^"']+)["']""")
_FILLED_IN = re.compile(r"\$[({][^)}]*[)}]")
_KEY = re.compile(rb"^[ \t-]*[\w./-]+:", re.MULTILINE)
_WORD = re.compile(r"[\w.-]+")
# How many names of a file another description has to have for each that is the robot's own: the files
# of a robot name more than a variant of it has.
_MORE = 2


class _Words(NamedTuple):
    """The words of a file, and those of its values alone."""

    all: frozenset[str]
    values: frozenset[str]


def of_others(robot: Looked, found: Found) -> dict[str, str]:
    """The files that belong to another description than the robot's, each with what says so."""
    near = dict(_nearer_to_others(robot.path, found))
    rest = [path for path in _companions(found) if path not in near]
    return {**near, **dict(_naming_others(robot, found, rest))}


def _companions(found: Found) -> Iterator[str]:
    for kind in ("params", "rviz", "bridge", "moveit", "behavior_trees", "srdf"):
        yield from getattr(found, kind)


def _near(folder: str, file: str) -> int:
    return len(os.path.commonpath((os.path.abspath(folder), os.path.abspath(file))))


def _nearer_to_others(robot: str, found: Found) -> Iterator[tuple[str, str]]:
    """Files of the description's package that are nearer to another one: a folder of examples has files
    of several robots."""
    others = {os.path.dirname(it): it for it in reversed(found.every)}
    own, base = os.path.dirname(robot), home_of(robot)
    for file in _companions(found):
        if _near(base, file) == len(os.path.abspath(base)):
            at = max(others, key=lambda it: _near(it, file), default=own)
            if _near(at, file) > _near(own, file):
                yield file, f"it is beside {os.path.basename(others[at])}"


def _naming_others(robot: Looked, found: Found, files: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Files that are not nearer to the robot, and name links and joints of another description."""
    own = frozenset(_expanded(robot)) | _names_in(robot.path)
    names = {it: _names_in(it) for it in found.every[:MOST] if it != robot.path}
    others = {path: its for path, its in names.items() if not its <= own}
    for file in files if others else ():
        words = _words(file)
        mine = _known(words, own)
        rivals = {path: _known(words, its) for path, its in others.items()}
        best = max(rivals, key=lambda it: (len(rivals[it]), it))
        theirs = rivals[best]
        at = _near(os.path.dirname(best), file)
        if at >= _near(os.path.dirname(robot.path), file) and (
            len(theirs) > max(1, _MORE * len(mine))
        ):
            named = ", ".join(sorted(theirs - mine)[:3])
            yield file, f"it is for {os.path.basename(best)}, which has {named}"


def _known(words: _Words, names: frozenset[str]) -> frozenset[str]:
    """The names that a file has: a plain word such as camera only as a value."""
    return frozenset(it for it in names & words.all if it in words.values or _is_specific(it))


def _is_specific(name: str) -> bool:
    return "_" in name or any(map(str.isdigit, name))


def _expanded(robot: Looked) -> Iterator[str]:
    for it in robot.root.iter("link", "joint") if robot.root is not None else ():
        yield it.get("name", "")


def _names_in(path: str) -> frozenset[str]:
    """The links and joints of a description as they are written, without what a xacro fills in."""
    written = (it.decode("utf-8", "replace") for it in _NAMED.findall(_data(path)))
    names = (_FILLED_IN.sub("", it).strip("_/ ") for it in written)
    return frozenset(it for it in names if it) - {*SENT_FRAMES}


def _words(path: str) -> _Words:
    data = _data(path)
    texts = data, _KEY.sub(b"", data)
    found = (frozenset(_WORD.findall(it.decode("utf-8", "replace"))) for it in texts)
    return _Words(*found)


def moveit_of_others(srdf: str, found: Found) -> Mapping[str, str]:
    """MoveIt's files that are nearer to another SRDF than to the one that is taken."""
    left = {}
    for file in found.moveit:
        best = max(found.srdf, key=lambda it: _near(os.path.dirname(it), file))
        if _near(os.path.dirname(best), file) > _near(os.path.dirname(srdf), file):
            left[file] = f"it is beside {os.path.basename(best)}"
    return left
