# SPDX-License-Identifier: Apache-2.0
"""Each file says its licence, as REUSE has it (reuse.software/spec-3.3): programs in a line, the rest
by REUSE.toml."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from paths import ROOT

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

LICENCE = re.findall(r'^license = "(.*)"$', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)[0]
KEY = "SPDX-License-Identifier"
LINE = f"# {KEY}: {LICENCE}\n"


def programs() -> list[str]:
    """Those of the clone, without fixtures (tests count their lines) and examples (pages show them)."""
    done = subprocess.run(
        ["git", "ls-files", "*.py", "*.sh", ".ci/run", "resource/bin", ":!fixtures", ":!examples"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode:
        pytest.skip("no clone: git knows no files here")
    return done.stdout.splitlines()


def says_the_licence(text: str) -> bool:
    """Its first line does, or the second of a script."""
    first, _, rest = text.partition("\n")
    return (rest if first.startswith("#!") else text).startswith(LINE)


def test_each_program_begins_with_the_licence() -> None:
    files = programs()
    missing = [it for it in files if not says_the_licence((ROOT / it).read_text())]
    assert len(files) > 1000 and {"conftest.py", "setup.py", ".ci/run"} <= {*files}
    assert missing == [], f"sed -i '1i {LINE.strip()}' {' '.join(missing)}"


def test_the_text_of_the_licence_is_where_readers_look() -> None:
    """GitHub and ROS take LICENSE, REUSE takes LICENSES/."""
    texts = [(ROOT / it).read_bytes() for it in ("LICENSE", f"LICENSES/{LICENCE}.txt")]
    assert texts[0] == texts[1] and len(texts[0]) > 10_000
    assert len([*(ROOT / "LICENSES").iterdir()]) == 1


def test_one_licence_holds_for_all_files() -> None:
    (every,) = tomllib.loads((ROOT / "REUSE.toml").read_text())["annotations"]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert (every["path"], every[KEY]) == ("**", LICENCE)
    assert every["SPDX-FileCopyrightText"] == project["authors"][0]["name"]


@pytest.mark.slow
def test_reuse_finds_nothing() -> None:
    pytest.importorskip("reuse", reason="no reuse: pip install '.[test]'")
    command = [sys.executable, "-m", "reuse", "--root", str(ROOT), "lint", "--lines"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
