# SPDX-License-Identifier: Apache-2.0
"""``multibot join``: several descriptions become one robot, or are taken out of it again."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.output import deliver, goes_to_file, note, write_files
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.walk import check_link, check_target
from multibot_rewrite.description.joining.from_file import listed_in
from multibot_rewrite.description.joining.part import ZERO, Part, files_of
from multibot_rewrite.description.sources.read import JOIN
from multibot_rewrite.related_files.join import Joined, join, split

# Options that are written for each part.
_OF_PARTS = ("at", "pose", "prefix")


def run(options: argparse.Namespace) -> int:
    """Write the joined description, or its parts; returns the exit code."""
    options.definitions = [*configured_definitions(options.words[0]), *options.definitions]
    return (_split if options.undo else _join)(options)


def _join(options: argparse.Namespace) -> int:
    """Join the parts and write the robot; return the exit code."""
    first, *others = options.words
    if first.endswith(JOIN):
        more = [*others, *(f"--{it}" for it in _OF_PARTS if getattr(options, it))]
        if more:
            raise UsageError(f"{more[0]} cannot go with {first}: write it into the file")
        parts, samples = listed_in(first)
    else:
        parts, samples = tuple(_parts(options)), 0
    made = join(
        parts,
        definitions=options.definitions,
        trust=options.trust,
        distro=options.distro or "",
        samples=samples,
        output=options.output if goes_to_file(options) else "",
    )
    _deliver(options, made, parts)
    for it in (*map(str, made.findings), *made.notes):
        note(options, it)
    why = ", ".join(made.not_verified)
    end = f"joined, not verified: {why}" if why else "joined; verified"
    note(options, f"{', '.join(made.parts)}: {end}")
    return DONE


def _deliver(options: argparse.Namespace, made: Joined, parts: Sequence[Part]) -> None:
    """Write the description and the files that go with it."""
    moveit = ((f"_{name}", data) for name, data in made.moveit.items())
    first = ((".srdf", made.srdf), ("_controllers.yaml", made.controllers), (".rviz", made.rviz))
    more = [(ending, data) for ending, data in (*first, *moveit) if data]
    if more and not goes_to_file(options):
        raise UsageError("several files are made: name the description with -o robot.urdf")
    if not goes_to_file(options):
        deliver(options, made.data)
        return
    stem = options.output.removesuffix(".urdf")
    items = [(options.output, made.data), *((f"{stem}{it}", data) for it, data in more)]
    _write(options, items, [*options.words, *(file for it in parts for file in files_of(it))])


def _write(
    options: argparse.Namespace, items: Sequence[tuple[str, bytes]], read: Sequence[str]
) -> None:
    """Write all files or none, and none over a file that is read."""
    for path, _ in items:
        check_target(path, read)
        check_link(path)
    write_files(options, items)


def _split(options: argparse.Namespace) -> int:
    """Write the parts of a joined description; return the exit code."""
    if len(options.words) != 1:
        raise UsageError("--undo takes one file, which multibot join made")
    if given := next((it for it in _OF_PARTS if getattr(options, it)), None):
        raise UsageError(f"--{given} is for joining, it cannot go with --undo")
    if not goes_to_file(options):
        raise UsageError("several files are made: name a folder for them with -o parts/")
    made = split(options.words[0], definitions=options.definitions, distro=options.distro or "")
    items = [(os.path.join(options.output, f"{name}.urdf"), data) for name, data in made.items()]
    _write(options, items, options.words)
    note(options, f"{options.output}: {', '.join(os.path.basename(path) for path, _ in items)}")
    return DONE


def _parts(options: argparse.Namespace) -> list[Part]:
    """Return the parts on the command line, each file with the xacro arguments after it."""
    files: list[tuple[str, dict[str, str]]] = []
    for word in options.words:
        name, is_argument, text = word.partition(":=")
        if not is_argument:
            files.append((word, {}))
        elif not files:
            raise UsageError(f"{word}: write it behind the xacro that it is for")
        else:
            files[-1][1][name] = text
    many = len(files)
    ends = _values_for_parts("--at", options.at, many)
    poses = _values_for_parts("--pose", options.pose, many)
    prefixes = _values_for_parts("--prefix", options.prefix, many, of_all=True)
    every = zip(files, ends, poses, prefixes, strict=True)
    return [
        Part(file, at, _pose_numbers(pose), prefix, "", given)
        for (file, given), at, pose, prefix in every
    ]


def _values_for_parts(
    option: str, values: Sequence[str], many: int, of_all: bool = False
) -> list[str]:
    """Return the option's value for each part: those given from the second part on, or one for all."""
    if of_all and len(values) == many:
        return list(values)
    if not values or len(values) == many - 1:
        return ["", *(values or [""] * (many - 1))]
    parts = f"{plural(many - 1, 'part')} after the first"
    what = f"{option} is given {plural(len(values), 'time')} for {parts}"
    raise UsageError(f'{what}; write it once for each, in their order, {option} "" for none')


def _pose_numbers(pose: str) -> Sequence[float]:
    if not pose:
        return ZERO
    try:
        return tuple(map(float, pose.replace(",", " ").split()))
    except ValueError:
        raise UsageError(f'--pose "{pose}": write six numbers, "x y z roll pitch yaw"') from None
