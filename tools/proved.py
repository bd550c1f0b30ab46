# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.proved FOLDER...``: of how many public descriptions is a rewrite proved, and why.

A folder is the corpus of the tests, or has checkouts of the repositories of ``proved.tsv``. Every
.urdf, .sdf and .xacro that makes a robot by itself is rewritten for two robots in each layout and
release. Printed is a table for each kind of robot, then the reasons, most frequent first.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import RewriteRefused
from multibot_rewrite.base.model import InputError, MultibotError
from multibot_rewrite.base.naming import LAYOUTS, WORLD_SYSTEMS
from multibot_rewrite.description.checks.meeting import REASONS
from multibot_rewrite.description.library import rewrite_all

# Kind of robot -> what its text has; the first that is there counts.
KINDS = {
    "Webots": r"<webots|type=\"\w+\.\w+",
    "ros2_control in gz-sim": r"(gz|ign)_ros2_control",
    "ros2_control in Classic": r"libgazebo_ros2_control",
    "plugins of ROS 1": r"libgazebo_ros_control|<robotNamespace|<updateRate|<bodyName",
    "plugins of Classic": r"filename=[\"']libgazebo_|filename=[\"']lib\w*[Gg]azebo\w*_?[Pp]lugin",
    "systems of gz-sim": r"filename=[\"'](lib)?(gz|ignition)-",
    "other plugins": r"<plugin[^>]*filename",
    "ros2_control, hardware": r"<ros2_control",
    "sensors alone": r"<sensor\b",
    "nothing that runs": r"",
}
PROVED, OPEN, REFUSED = "proved", "not proved", "refused"
# What says that something in the file is not known.
UNKNOWN = ("MB902", "MB903", "MB906", "MB219")
_NAME = re.compile(r"'[^']*'|/[\w/{}.-]+|\b\d+\b")


class Verdict(NamedTuple):
    """What is said of one file in one layout and release; ``why`` are code and message."""

    file: str
    kind: str
    layout: str
    release: str
    word: str
    why: tuple[tuple[str, str], ...] = ()

    @property
    def is_known(self) -> bool:
        """Return whether everything that runs in the file is known."""
        return self.word != REFUSED and all(code not in UNKNOWN for code, _ in self.why)


def descriptions(folders: Iterable[Path]) -> Iterator[Path]:
    """Yield the files below the folders that may be robots; reading shows which are macros."""
    for folder in folders:
        found = (it for it in sorted(folder.rglob("*")) if it.is_file())
        yield from (it for it in found if re.search(r"\.(urdf|sdf|xacro)$", it.name))


def kind_of(text: bytes) -> str:
    """Return the kind of robot, by what its text loads."""
    said = re.sub(r"<!--.*?-->", "", text.decode("utf-8", "replace"), flags=re.DOTALL)
    return next(kind for kind, words in KINDS.items() if re.search(words, said))


def judged(
    path: Path, layouts: Sequence[str], releases: Sequence[str], systems: str | None = None
) -> list[Verdict]:
    """Return the verdicts of one file; none for a macro, a world or a broken file."""
    found = [_verdict(path, layout, it, systems) for layout in layouts for it in releases]
    return [it for it in found if it is not None]


def _verdict(path: Path, layout: str, release: str, systems: str | None) -> Verdict | None:
    try:
        first, *_ = rewrite_all(
            path, ["robot1", "robot2"], layout=layout, distro=release, world_systems=systems
        )
    except RewriteRefused as error:
        if any(it.code == "MB109" for it in error.findings):
            return None
        why = tuple((it.code, it.message) for it in error.findings if it.level == "error")
        return Verdict(str(path), "refused", layout, release, REFUSED, why)
    except InputError:
        return None
    except MultibotError as error:
        return Verdict(str(path), "refused", layout, release, REFUSED, (("", str(error)),))
    if path.suffix == ".xacro" and b"<link" not in first.data:
        return None
    why = tuple((it.code, it.message) for it in first.findings if it.code in REASONS)
    word = OPEN if first.not_verified else PROVED
    return Verdict(str(path), kind_of(first.data), layout, release, word, why)


def _table(verdicts: Sequence[Verdict]) -> Iterator[str]:
    yield "| kind | layout | release | files | refused | known | proved | of known |"
    yield "|---|---|---|--:|--:|--:|--:|--:|"
    parts: dict[tuple[str, str, str], list[Verdict]] = defaultdict(list)
    for it in verdicts:
        release = it.release or "by evidence"
        parts[it.kind, it.layout, release].append(it)
        parts["all", it.layout, release].append(it)
    order = {kind: number for number, kind in enumerate([*KINDS, REFUSED, "all"])}
    for key, own in sorted(parts.items(), key=lambda it: (it[0][1], it[0][2], order[it[0][0]])):
        words = Counter(it.word for it in own)
        known = [it for it in own if it.is_known]
        share = 100 * words[PROVED] / len(known) if known else 0
        numbers = (len(own), words[REFUSED], len(known), words[PROVED], f"{share:.1f} %")
        yield f"| {' | '.join((*key, *map(str, numbers)))} |"


def _reasons(verdicts: Sequence[Verdict], most: int) -> Iterator[str]:
    """Each with the number of verdicts that have it, of those that have no other, and a file."""
    files: Counter[tuple[str, str]] = Counter()
    alone: Counter[tuple[str, str]] = Counter()
    example: dict[tuple[str, str], Verdict] = {}
    for it in verdicts:
        keys = {(code, _NAME.sub("*", message)) for code, message in it.why}
        files.update(keys)
        alone.update(keys if len({code for code, _ in keys}) == 1 else ())
        for key in keys:
            example.setdefault(key, it)
    for key, count in files.most_common(most):
        it = example[key]
        where = f"{it.layout} {it.release} {it.file}"
        said = next(message for code, message in it.why if (code, _NAME.sub("*", message)) == key)
        yield f"{count}\t{alone[key]}\t{key[0]}\t{said[:160]}\t{where}"


def main(words: Sequence[str]) -> int:
    """Print table and reasons; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", type=Path, nargs="+")
    parser.add_argument("--layouts", nargs="*", default=[it.name for it in LAYOUTS])
    parser.add_argument("--releases", nargs="*", default=[""], help="empty: by evidence")
    parser.add_argument("--world-systems", choices=WORLD_SYSTEMS)
    parser.add_argument("--every", type=int, default=1, help="each so manieth file alone")
    parser.add_argument("--only", default="", help="a kind of robot")
    parser.add_argument("--reasons", type=int, default=40)
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args(words)
    paths = list(descriptions(given.folders))[:: given.every]
    options = {"layouts": given.layouts, "releases": given.releases}
    one = partial(judged, systems=given.world_systems, **options)
    with ProcessPoolExecutor(given.jobs) as pool:
        found = [it for part in pool.map(one, paths, chunksize=8) for it in part]
    verdicts = [it for it in found if given.only in it.kind]
    print(*_table(verdicts), sep="\n")
    print(*_reasons(verdicts, given.reasons), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
