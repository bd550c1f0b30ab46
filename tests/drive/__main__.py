# SPDX-License-Identifier: Apache-2.0
"""Whether a built folder starts, drives, sees and plans: ``python tests/drive FOLDER``.

A line for each robot, then what is wrong. It ends with 0 where all is well, 1 where something is
wrong, 2 where something is not known, 3 where the folder cannot be judged.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

import fleet
import verdict

FINE, WRONG, UNKNOWN, REFUSED = range(4)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python tests/drive", description=__doc__)
    parser.add_argument("folder", type=Path, help="what multibot build wrote")
    parser.add_argument("--release", help="the release of ROS, where the folder does not say it")
    parser.add_argument(
        "--sources", type=Path, nargs="*", default=[], help="folders of the vendor's packages"
    )
    parser.add_argument("--json", action="store_true", help="print one line of JSON")
    return parser.parse_args()


def release_of(folder: Path) -> str:
    """Return the release that a folder was built for, as its list of files says."""
    return str(json.loads((folder / "manifest.json").read_text())["distro"])


def judged(
    folder: Path, release: str, sources: tuple[Path, ...] = ()
) -> tuple[int, dict[str, object]]:
    """Return the exit code, and what is printed."""
    found = fleet.read(folder.resolve(), release, sources)
    robots, wrong = verdict.done(found), verdict.judged(found)
    unsure = any(word.startswith("unknown") for it in robots.values() for word in it.values())
    code = WRONG if wrong else UNKNOWN if unsure else FINE
    return code, {"robots": robots, "wrong": [it._asdict() for it in wrong]}


def printed(found: dict[str, object]) -> str:
    robots: dict[str, dict[str, str]] = found["robots"]  # type: ignore[assignment]
    wrong: list[dict[str, str]] = found["wrong"]  # type: ignore[assignment]
    width = max((len(it) for it in robots), default=0)
    lines = [f"{robot:{width}}  {verdict.said(it)}" for robot, it in robots.items()]
    lines += [f"{it['robot'] or 'all'}: no {it['what']}: {it['why']}" for it in wrong]
    return "\n".join(lines)


def main() -> int:
    given = arguments()
    try:
        release = given.release or release_of(given.folder)
        code, found = judged(given.folder, release, tuple(given.sources))
    except Exception as error:  # A folder that the referee cannot read is said, whatever it is.
        print(f"{given.folder}: not judged: {type(error).__name__}: {error}", file=sys.stderr)
        return REFUSED
    print(json.dumps(found) if given.json else printed(found))
    return code


if __name__ == "__main__":
    sys.exit(main())
