# SPDX-License-Identifier: Apache-2.0
"""Prepares a release, and says what is new in it.

    python .ci/release.py prepare 0.3.0     writes the version and its date wherever they are said
    python .ci/release.py notes v0.3.0      prints the release notes, in Markdown
    python .ci/release.py hook v0.3.0       tags hook-v0.3.0: what pre-commit installs, and nothing else

``notes`` ends with 1 where a file says another version than the tag. catkin_prepare_release changes
package.xml and a literal in setup.py alone: it cannot be used here.
"""

from __future__ import annotations

import datetime
import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CHANGES = "CHANGELOG.rst"
LABEL = "Forthcoming"
VERSION = r"\d+\.\d+\.\d+"
# What has the version in it and is made anew: manual pages, and the badges of the README.
MAKERS = ("share/make.py", "docs/site/badges.py")
# What pre-commit installs the hook from; the rest of the repository is as much again, twice.
HOOK = (
    *(".pre-commit-hooks.yaml", "pyproject.toml", "setup.py", "setup.cfg", "MANIFEST.in"),
    *("README.md", "LICENSE", "package.xml", "multibot_rewrite", "resource", "share"),
)
# Where the version is said.
PLACES = {
    "pyproject.toml": rf'(?m)^(version = "){VERSION}(")$',
    "package.xml": rf"(<version>){VERSION}(</version>)",
    "CITATION.cff": rf"(?m)^(version: ){VERSION}()$",
    "multibot_rewrite/version.py": rf'(?m)^(__version__ = "){VERSION}(")$',
    "docs/lint.md": rf"([@ `-]v){VERSION}()",
}


def prepare(version: str, root: Path, day: str) -> None:
    """Give the version to all files, and to what is new a heading; ValueError where it cannot be."""
    if not re.fullmatch(VERSION, version):
        raise ValueError(f"{version}: a version is three numbers, as 0.3.0")
    texts = {name: (root / name).read_text() for name in (*PLACES, CHANGES)}
    for name, pattern in PLACES.items():
        texts[name], count = re.subn(pattern, rf"\g<1>{version}\g<2>", texts[name])
        if not count:
            raise ValueError(f"{name}: no version was found")
    texts[CHANGES] = released(texts[CHANGES], version, day)
    for name, text in texts.items():
        (root / name).write_text(text)


def released(text: str, version: str, day: str) -> str:
    """Return the change log with the forthcoming section called by its version."""
    if sections(text).get(version) is not None:
        raise ValueError(f"{CHANGES}: {version} is released already")
    title = f"{version} ({day})"
    text, count = re.subn(rf"(?m)^{LABEL}\n-+$", f"{title}\n{'-' * len(title)}", text)
    if count != 1:
        raise ValueError(f"{CHANGES}: {count} sections {LABEL!r} and not one; nothing is new")
    return text


def sections(text: str) -> dict[str, str]:
    """Return the notes of each version."""
    parts = re.split(r"(?m)^(\S+)(?: \([\d-]+\))?\n-{3,}$\n", text)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def notes(tag: str, root: Path) -> str:
    """Return the notes of a tag; raises ValueError where a file says another version."""
    version = tag.removeprefix("v")
    for name, pattern in PLACES.items():
        said = {it[0] for it in re.finditer(pattern, (root / name).read_text())}
        others = sorted(it for it in said if version not in re.findall(VERSION, it))
        if others or not said:
            raise ValueError(
                f"{name}: the tag is {tag}, but this says {', '.join(others) or 'none'}"
            )
    found = sections((root / CHANGES).read_text()).get(version)
    if found is None:
        raise ValueError(f"{CHANGES}: no section for {version}")
    return re.sub(r"\n  +", " ", found.strip()).replace("``", "`")


def hook(tag: str, root: Path) -> str:
    """Tag what pre-commit installs of this revision, a commit without a parent; returns the tag."""

    def git(*words: str, given: str = "") -> str:
        who = ("-c", "user.name=release", "-c", "user.email=release@users.noreply.github.com")
        command = ["git", "-C", str(root), *who, *words]
        done = subprocess.run(command, input=given, capture_output=True, text=True, check=False)
        if done.returncode:
            raise ValueError(done.stderr.strip())
        return done.stdout.strip()

    tree = git("mktree", given=git("ls-tree", "HEAD", *HOOK) + "\n")
    commit = git("commit-tree", tree, "-m", f"What pre-commit installs of {tag}")
    git("tag", f"hook-{tag}", commit)
    return f"hook-{tag}"


def main(words: list[str]) -> int:
    """Do what the words say."""
    if len(words) != 2 or words[0] not in ("prepare", "notes", "hook"):
        print(__doc__)
        return 2
    try:
        if words[0] in ("notes", "hook"):
            print((notes if words[0] == "notes" else hook)(words[1], ROOT))
            return 0
        if not find_spec("shtab"):
            raise ValueError("manual pages are made by shtab: pip install -e '.[test]'")
        prepare(words[1], ROOT, datetime.date.today().isoformat())
    except (ValueError, OSError) as error:
        print(f"release.py: {error}", file=sys.stderr)
        return 1
    # The sources that were changed, not an installed package.
    environ = {**os.environ, "PYTHONPATH": str(ROOT)}
    made = (subprocess.run([sys.executable, ROOT / it], env=environ, check=False) for it in MAKERS)
    return max(it.returncode for it in made)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
