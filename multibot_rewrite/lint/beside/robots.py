"""What the descriptions of a file's package declare."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.model import Claim, InputError
from multibot_rewrite.description.sources.packages import entries, package_of
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.lint.files.named import robot_name
from multibot_rewrite.lint.files.pairing import described
from multibot_rewrite.lint.files.subjects import make_subject
from multibot_rewrite.rules.settings import Settings
from multibot_rewrite.rules.subject import NO_ROBOTS, Robots, Subject

_ENDINGS = (".urdf", ".xacro")
# A package's folders, how deep, and how many descriptions are read.
_SKIPPED = frozenset(("meshes", "mesh", "test", "tests", "build", "install", "log", "worlds"))
_DEEP, _MOST, _TRIED = 3, 60, 6
_DESCRIPTION = "_description"
_KINDS = ("link", "frame", "joint", "sensor", "gpio", "hardware")


def robots_of(file: str, settings: Settings) -> Robots:
    """The descriptions of the file's package, else of the description packages beside it, else those
    that are linted with it."""
    own = package_of(file)
    folder = own[1] if own else os.path.dirname(os.path.abspath(file))
    paths = _descriptions(folder)
    if not paths and own:
        above = os.path.dirname(folder)
        others = sorted(it for it in entries(above) if it.endswith(_DESCRIPTION))
        paths = [path for it in others for path in _descriptions(os.path.join(above, it))]
    paths = paths or [path for _, path in settings.urdfs]
    return _together(paths, settings) if len(paths) > 0 else NO_ROBOTS


def _descriptions(folder: str) -> list[str]:
    """The files below a folder with a robot that has a name: others are parts of these."""
    files = [path for path, _ in zip(_files(folder, _DEEP), range(_MOST), strict=False)]
    return [path for path in files if robot_name(path)]


def _files(folder: str, deep: int) -> Iterator[str]:
    inner = []
    for name in sorted(entries(folder)):
        if name.endswith(_ENDINGS):
            yield os.path.join(folder, name)
        elif "." not in name and name not in _SKIPPED:
            inner.append(os.path.join(folder, name))
    for it in inner if deep else ():
        yield from _files(it, deep - 1)


def _together(paths: Sequence[str], settings: Settings) -> Robots:
    found: dict[str, dict[str, Claim]] = {kind: {} for kind in _KINDS}
    subjects: list[Subject] = []
    for path in paths[:_TRIED]:
        try:
            data, name = described(path, settings)
            subjects.append(make_subject(read_document(data, name), settings))
        except InputError:  # it is told where it is linted
            continue
        for kind in _KINDS:
            found[kind] |= subjects[-1].inventory.declared.get(kind, {})
    return Robots(found, tuple(subjects), len(subjects) == len(paths))
