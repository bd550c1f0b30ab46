# SPDX-License-Identifier: Apache-2.0
"""What ``benchmarks/house.py`` counts, on a small checkout."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import write_files

from benchmarks import house

FILES = {
    "multibot_rewrite/__init__.py": "from multibot_rewrite.public import f\n",
    "multibot_rewrite/public.py": "def f() -> None: ...\n",
    "multibot_rewrite/system/records.py": "class End: ...\nclass Node: ...\nclass System: ...\n",
    "multibot_rewrite/system/json.py": "def read(data: bytes) -> System: ...\n",
    "multibot_rewrite/system/other.py": "def read(data: str) -> System: ...\n",
    "multibot_rewrite/lint/catalogue.py": "class Home: ...\n",
    "multibot_rewrite/cli/multibot.py": "class Start: ...\n",
    "tests/test_seam.py": (
        "from multibot_rewrite import f\nfrom multibot_rewrite.cli.multibot import main\n"
        "from multibot_rewrite.public import f\n"
    ),
    "tests/a/test_one.py": "from multibot_rewrite.system import records\n",
    "tests/a/test_several.py": (
        "from multibot_rewrite.system import json, other\n"
        "from multibot_rewrite.system.records import End\n\nONE = 1\n"
    ),
    "tests/support/other.py": "from multibot_rewrite.system import records\n",
}


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    write_files(tmp_path, FILES)
    return tmp_path


def test_the_records_of_a_thing_are_found_where_their_names_mean_it(checkout: Path) -> None:
    assert house.shapes(house.modules(checkout)) == {
        "an end": ["End (system/records.py)"],
        "a node": ["Start (cli/multibot.py)", "Node (system/records.py)"],
        "a finding": [],
    }


def test_a_serialiser_makes_a_system_of_bytes(checkout: Path) -> None:
    assert house.serialisers(house.modules(checkout)) == ["system/json.py"]


def test_test_files_are_counted_by_the_inner_modules_that_they_import(checkout: Path) -> None:
    assert [*house.importing_rows(checkout, house.modules(checkout))] == [
        ("1 or 2 inner modules", 1, 1),
        ("3 inner modules or more", 1, 4),
        ("commands and public names alone", 1, 3),
    ]


def test_a_command_is_counted_with_its_modules_and_records(tmp_path: Path) -> None:
    said = house._run(house.ROOT, house.COMMANDS["lint"], str(tmp_path))
    functions, modules, records = (int(it.strip("(),")) for it in said.split())
    assert functions > max(modules, records)
    assert min(modules, records) > 20
