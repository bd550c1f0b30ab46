# SPDX-License-Identifier: Apache-2.0
"""The packages of fixtures/adopted_packages.tsv under ``multibot adopt``, judged by xacro itself.

``python benchmarks/adopted_public.py MIRRORS [FIRST [LAST]]`` prints a row for each: xacro expands
every configuration before and after, without a prefix and with one. MIRRORS has clones,
``OWNER+NAME/repo``. docs/contributing/measurements.md has the table.
"""

from __future__ import annotations

import csv
import os
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import xacro
from adopted_packages import checkout
from lxml import etree

from multibot_rewrite import adopt
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.joining.part import prefixing
from multibot_rewrite.description.readback.xml import plain
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.refactor.adopt import Adopted
from multibot_rewrite.refactor.namespaces import spacing

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "support"))
from vendor_sources import install, packages_below  # as the tests have it

LIST = Path(__file__).parents[1] / "fixtures/adopted_packages.tsv"
PREFIX, SPACE, WANTED = "robot1_", "team1", 20
# What is left, by words of its reason.
KINDS = {
    "code": "code names",
    "data": "it names",
    "composed": "put together",
    "stays": "stays with",
    "unsaid": "where no element says",
    "launch": "by hand",
    "unproved": "not proved",
    "launch unread": "with --trust alone",
}


class Judged(NamedTuple):
    """Configurations that xacro makes the same of without a prefix, and what a rewrite makes with one,
    of how many; ``spaced`` with a namespace. ``wrong`` are those that it does not."""

    every: int
    same: int
    named: int
    spaced: int
    wrong: tuple[str, ...]


def rows() -> list[dict[str, str]]:
    lines = (it for it in LIST.read_text().splitlines() if not it.startswith("#"))
    return list(csv.DictReader(lines, delimiter="\t"))


def renamed(text: bytes, naming: Naming, word: str) -> list[object]:
    """Return the elements of a description with a prefix or namespace, as a rewrite makes them."""
    prepared = pipeline.prepare(text, "robot.urdf", naming, builtin_tree((), "jazzy"))
    return elements(next(pipeline.render(prepared, [word], again=True)))


def elements(text: bytes) -> list[object]:
    root = etree.fromstring(text)
    return [dict(root.attrib), *map(plain, root.iterchildren("*"))]


def expanded(path: str, arguments: Mapping[str, str]) -> bytes:
    """Return what xacro makes of a file."""
    with redirect_stderr(StringIO()):
        made = xacro.process_file(path, mappings=dict(arguments))
    return bytes(made.toprettyxml(indent="  ", encoding="utf-8"))


def judged(made: Adopted) -> Judged:
    """Every configuration of a package whose files are on the disk as they were."""
    given: list[tuple[str, dict[str, str]]] = [(it, {}) for it in made.verified]
    for it in made.configurations:
        path, *words = it.split(" ")
        given.append((path, dict(word.split(":=", 1) for word in words)))
    before = [_text(path, arguments) for path, arguments in given]
    for path, data in made.after.items():
        Path(path).write_bytes(data)
    same, named, spaced, wrong = 0, 0, 0, []
    for (path, arguments), old in zip(given, before, strict=True):
        new = expanded(path, arguments)
        # A URDF that becomes a xacro is written anew, with the same in it.
        whole = new == old if made.before.get(path, b"x") else elements(new) == elements(old)
        other = expanded(path, {**arguments, made.argument: PREFIX})
        is_srdf = path.removesuffix(".xacro").endswith(".srdf")
        equal = is_srdf or elements(other) == renamed(old, prefixing(), PREFIX)
        below = expanded(
            path, {**arguments, made.namespace: SPACE} if made.namespace else arguments
        )
        fits = is_srdf or elements(below) == renamed(old, spacing(), SPACE)
        same, named, spaced = same + whole, named + equal, spaced + fits
        if not whole or not equal or not fits:
            wrong.append(" ".join((os.path.basename(path), *arguments.values())))
    return Judged(len(given), same, named, spaced, tuple(wrong))


def _text(path: str, arguments: dict[str, str]) -> bytes:
    """Return a description before; a plain one becomes a xacro, and some have expressions already."""
    return expanded(path if os.path.exists(path) else path.removesuffix(".xacro"), arguments)


def one(row: Mapping[str, str], mirrors: Path) -> tuple[str, ...]:
    """Return what adopt makes of a package, and what xacro makes of that."""
    repo = mirrors / row["repository"].replace("/", "+") / "repo"
    with TemporaryDirectory() as at, TemporaryDirectory() as prefix:
        home = checkout(repo, row["commit"], Path(at))
        try:
            made = adopt(str(home / row["package"]))
        except MultibotError as error:
            return ("refused", str(error).replace(at, ""))
        if not made.argument:
            return ("has one", ", ".join(sorted(set(made.already.values()))))
        os.environ.update(install(packages_below(home), Path(prefix), {}))
        found = judged(made)
        left = Counter(
            next((k for k, word in KINDS.items() if word in it.why), "?") for it in made.left
        )
        return (
            "counts",
            made.argument,
            f"{len(made.verified)} descriptions",
            f"{len(made.configurations)} others",
            f"{len(made.after)} files",
            f"{found.same} of {found.every} the same",
            f"{found.named} of {found.every} as rewritten",
            f"{made.namespace or 'no namespace'}: {found.spaced} of {found.every} as rewritten",
            "left " + (", ".join(f"{n} {it}" for it, n in left.items()) or "nothing"),
            f"{len(made.unread)} unread, {len(made.already)} have one",
            *found.wrong,
        )


def every(mirrors: Path, first: int, last: int) -> Iterator[tuple[str, ...]]:
    many = 0
    for row in rows()[first:last]:
        found = one(row, mirrors)
        many += found[0] == "counts"
        yield row["repository"], row["commit"][:8], row["package"], *found
        if many == WANTED:
            return


if __name__ == "__main__":
    ends = [int(it) for it in sys.argv[2:]]
    for it in every(Path(sys.argv[1]), *(ends or [0]), *([] if len(ends) > 1 else [999])):
        print("\t".join(it), flush=True)
