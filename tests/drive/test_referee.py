# SPDX-License-Identifier: Apache-2.0
"""The referee is not the judged: nothing of the package is loaded while it judges a folder."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
FILES = sorted(it for it in HERE.glob("*.py") if not it.name.startswith("test_"))
LOADED = """
import runpy, sys
sys.argv = ["drive", "--help"]
try:
    runpy.run_path(sys.argv.pop(0) and DRIVE, run_name="__main__")
except SystemExit:
    pass
print([it for it in sys.modules if it.split(".")[0] == "multibot_rewrite"])
"""


@pytest.mark.parametrize("file", FILES, ids=[it.name for it in FILES])
def test_no_room_of_the_package_is_imported(file: Path) -> None:
    names = []
    for it in ast.walk(ast.parse(file.read_text())):
        if isinstance(it, ast.ImportFrom):
            names.append(it.module or "")
        elif isinstance(it, ast.Import):
            names += [each.name for each in it.names]
    assert [it for it in names if it.split(".")[0] == "multibot_rewrite"] == []


@pytest.mark.more
def test_nothing_that_is_imported_loads_it() -> None:
    code = LOADED.replace("DRIVE", repr(str(HERE)))
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout.splitlines()[-1] == "[]"


def test_its_facts_are_those_of_sources() -> None:
    """No file of the package is read either: neither its tables nor its plugin definitions."""
    words = [it for file in FILES for it in file.read_text().split() if "multibot_rewrite/" in it]
    assert words == []
