# SPDX-License-Identifier: Apache-2.0
"""The schema of ``urdf-lint.toml``: editors take what the reader takes, and say what it refuses; the
addresses of all schemas."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from paths import ROOT

from multibot_rewrite.base import editors
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.lint.config.configured import configured
from multibot_rewrite.lint.config.values import READERS
from multibot_rewrite.lint.registry import RULES
from tools.schemas.lint import schema

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

VALID = jsonschema.Draft7Validator(schema())
PAGE = (ROOT / "docs" / "lint.md").read_text()
EXAMPLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
SCHEMAS = (editors.FLEET, editors.NODES, editors.PLAN, editors.LINT)
URLS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["urls"]
HOME = URLS["Repository"].removeprefix("https://github.com/")


def faults(table: Any) -> list[str]:
    return [it.message for it in VALID.iter_errors(table)]


def test_the_file_is_what_is_made() -> None:
    command = f"python -m tools.schemas.lint > multibot_rewrite/{editors.LINT}"
    assert json.loads(editors.schema_text(editors.LINT)) == schema(), command


def test_it_has_every_key_with_a_word_on_it() -> None:
    known = schema()["properties"]
    assert known.keys() == READERS.keys()
    assert all(10 < len(it["description"]) < 90 for it in known.values())


@pytest.mark.parametrize("name", SCHEMAS)
def test_a_schema_has_an_address_that_stays(name: str) -> None:
    """That of the file on the branch main: SchemaStore and editors read it there."""
    found = json.loads(editors.schema_text(name))
    raw = f"https://raw.githubusercontent.com/{HOME}/main/multibot_rewrite/{name}"
    assert found["$id"] == raw and found["title"]
    assert (ROOT / "multibot_rewrite" / name).is_file()
    # Nothing is fetched to judge by it.
    assert {it[0] for it in re.findall(r'"\$ref": "(.)', json.dumps(found))} <= {"#"}


@pytest.mark.slow
@pytest.mark.parametrize("name", SCHEMAS)
def test_a_schema_is_by_its_own_schema(name: str) -> None:
    command = [sys.executable, "-m", "check_jsonschema", "--check-metaschema"]
    path = ROOT / "multibot_rewrite" / name
    done = subprocess.run([*command, path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_examples_of_the_page_follow_it() -> None:
    tables = [tomllib.loads(it) for it in EXAMPLES]
    tables = [it.get("tool", {}).get("urdf-lint", it) for it in tables]
    assert len(tables) >= 2 and {key for it in tables for key in it} > {"levels", "xacro"}
    assert [faults(it) for it in tables] == [[] for _ in tables]


def test_every_code_and_name_of_a_rule_is_one() -> None:
    words = [word for code, it in RULES.items() for word in (code, code[:2], code[:3], it.name)]
    assert faults({"select": words}) == []


GOOD = (
    'select = ["MB1", "MG"]', 'levels = {MB501 = "off"}', "seconds = 0.5", "seconds = 86400",
    'separators = {link = "_"}', 'topics = "namespace"', 'shared-frames = ["world", ""]',
    'xacro = [{arguments = {a = 1, b = true, c = "x"}}]', 'fail-on = "note"', 'layout = "L3"',
    'per-file-ignores = {"*.srdf" = ["MB8", "unused-suppression"]}', "exclude = []",
)  # fmt: skip
BAD = (
    'select = "MB1"', 'select = ["x y"]', "select = [1]", 'levels = {MB501 = "loud"}', "seconds = 0",
    'seconds = "1"', "seconds = 86401", "seconds = true", 'separators = {lnk = "_"}',
    'topics = "name"', 'affix = "front"', 'groups = "drop"', 'distro = "foxy2"', "robots = 3",
    "xacro = [{files = 'a'}]", "xacro = [{arguments = {a = []}}]", "xacro = {arguments = {}}",
    "xacro = [{arguments = {}, file = 'a'}]", 'fail-on = "all"', 'targets = ["usd"]',
    'baseline = ""', "unknown = 1", 'roots = "src"', "layout = 1", "urdf = 1", "definitions = 'a'",
    "exclude = ['']", "per-file-ignores = {a = 'MB1'}",
)  # fmt: skip


def taken(text: str, folder: Path) -> bool:
    (folder / "urdf-lint.toml").write_text(text)
    try:
        configured(str(folder), None)
    except UsageError:
        return False
    return True


@pytest.mark.parametrize("text", GOOD)
def test_what_the_reader_takes_is_right(text: str, tmp_path: Path) -> None:
    assert taken(text, tmp_path) and faults(tomllib.loads(text)) == []


@pytest.mark.parametrize("text", BAD)
def test_what_the_reader_refuses_is_wrong(text: str, tmp_path: Path) -> None:
    assert not taken(text, tmp_path) and faults(tomllib.loads(text)) != []
