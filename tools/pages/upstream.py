# SPDX-License-Identifier: Apache-2.0
"""Errors of public descriptions, each with its fix, as a page for their maintainers."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from tools.pages.markdown import plain

DATA = Path(__file__).parents[2] / "fixtures" / "upstream.tsv"
_INERTIA = (
    "libsdformat (`src/Link.cc`, `has invalid inertia`) refuses the model, so Gazebo does "
    "not spawn the robot. `ign sdf -k` 12.3 says so of this link alone, and `Valid.` with "
    "the patch."
)
# What breaks, by rule, as the consumer's source has it.
BREAKS = {
    "MB101": "xacro reads with expat, which stops at this line: nothing that includes the file "
    "starts. XML has no `--` inside a comment, and a tag that ends with `/>` has no end "
    "tag.",
    "MB103": "xacro stops with `Invalid parameter` (`xacro/__init__.py`): there is no description. "
    "The macro `load_robot` has other parameters since, and some have no default.",
    "MB201": "`ros2_control_node` is given both arms in one description and throws `Hardware name "
    "UFRobotSystem is duplicated` (ros2_control, `resource_manager.cpp`, Humble to "
    "Rolling).",
    "MB501": "urdfdom refuses the file: `Two root links found: [base] and [env]` (urdfdom_headers, "
    "`model.h`; `check_urdf` says the same). robot_state_publisher does not start.",
    "MB606": _INERTIA,
    "MB701": "The file is not in the repository at this revision; one of that name is in another "
    "folder or format. RViz: `Could not load resource` (`rviz_rendering/mesh_loader.cpp`); "
    "the link has no shape.",
    "MB712": "Nothing replaces `$(find ...)` in a file that xacro does not expand: no program opens "
    "the mesh, the drone has no shape.",
}
WHY = {
    "kroshu/kuka_robot_descriptions": (
        "While the base stands, only rotation about the axis of joint 1 moves this link, so the"
        " other two moments change no motion: any value that makes the three possible will do."
    ),
    "ros-naoqi/naoqi_driver2": (
        "The products of inertia are larger than the moments allow; they are left out until "
        "they are known about the centre of mass."
    ),
    "Interbotix/interbotix_ros_manipulators": (
        "The products of inertia are larger than the moments allow; they are left out, as in "
        "the line that uxarm6 keeps as a comment."
    ),
    "ros-industrial/robotiq": (
        "One moment is about ten times as large as the size of the part and the others allow."
    ),
}
_HEAD = """\
# Errors in public descriptions

Made from `fixtures/upstream.tsv`.

{count} errors that `urdf-lint` finds in {repositories} public repositories, for their
maintainers: where, what breaks, and a patch. Each was read by hand against the source of the
program that reads the file; of each, the finding is gone with the patch (or with the same change
in the other places that are named). Values of inertia are proposals: a maintainer knows better
ones.

| repository | errors | rules |
|---|--:|---|
"""


class Error(NamedTuple):
    """One error: where it is at a revision, what is found, the patch, where else the same has to be
    changed."""

    repository: str
    revision: str
    file: str
    line: int
    rule: str
    finding: str
    patch: str
    more: str


def errors() -> list[Error]:
    """All of them, in the order of the page."""
    lines = DATA.read_text(encoding="utf-8").splitlines()[1:]
    return [_error(line.split("\t")) for line in lines]


def _error(words: list[str]) -> Error:
    repository, revision, file, line, rule, finding, patch, more = map(_plain, words)
    return Error(repository, revision, file, int(line), rule, finding, patch, more)


def _plain(text: str) -> str:
    return "\\".join(it.replace("\\n", "\n").replace("\\t", "\t") for it in text.split("\\\\"))


def page() -> str:
    """Return the page in Markdown."""
    groups = [
        (key, list(its))
        for key, its in groupby(errors(), key=lambda it: (it.repository, it.revision))
    ]
    rows = "".join(
        f"| [{repository}](#{repository.replace('/', '').lower()}) | {len(its)} | "
        f"{', '.join(dict.fromkeys(it.rule for it in its))} |\n"
        for (repository, _), its in groups
    )
    head = _HEAD.format(count=len(errors()), repositories=len(groups))
    parts = [
        part for (repository, revision), its in groups for part in _part(repository, revision, its)
    ]
    return head + rows + "".join(parts)


def _part(repository: str, revision: str, its: list[Error]) -> Iterator[str]:
    yield (
        f"\n## {repository}\n\nRevision `{revision[:10]}`. {WHY.get(repository, '')}".rstrip()
        + "\n"
    )
    for rule in dict.fromkeys(it.rule for it in its):
        yield f"\n{rule}: {BREAKS[rule]}\n"
        for it in its:
            if it.rule == rule:
                more = f" ({it.more})" if it.more else ""
                yield f"\n`{it.file}`, line {it.line}: {plain(it.finding)}{more}\n"
                yield f"\n```diff\n--- a/{it.file}\n+++ b/{it.file}\n{it.patch}\n```\n"
