# SPDX-License-Identifier: Apache-2.0
"""What pages, help texts and docstrings name is there; what stands at the top of the repository."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from paths import ROOT

from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.cli.declared.options import Command
from multibot_rewrite.cli.parser import make_parser

PAGES = sorted((*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")))
MODULES = sorted((ROOT / "multibot_rewrite").rglob("*.py"))
EVERY_COMMAND = (*PROGRAMS.values(), *COMMANDS.values())
FENCE = re.compile(r"^( *)(`{3,}).*?^\1\2`*$", re.MULTILINE | re.DOTALL)
# A path in the repository: its first folder is one of the repository or of the package.
PATH = re.compile(r"`([a-z_]\w*/[\w./-]*)(?:#[\w-]+)?`")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
# What stands at the top of the repository; who adds a file there writes it here, with a reason.
TOP = {
    *(".ci", ".devcontainer", ".dockerignore", ".github", ".gitignore", ".pre-commit-hooks.yaml"),
    *("CHANGELOG.rst", "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "README.md", "SECURITY.md"),
    *("LICENSES", "REUSE.toml"),  # where REUSE looks for licences
    *("MANIFEST.in", "package.xml", "pyproject.toml", "setup.cfg", "setup.py", "resource", "share"),
    *("action.yml", "benchmarks", "conftest.py", "docs", "examples", "fixtures"),
    *("multibot_rewrite", "tests", "tools"),
}
# Paths that are those of other repositories, of a reader's own files, or of any code.
ELSEWHERE = {
    "rules/pages/CODE.md",
    "description/urdf/arm.xacro",
    "docs/design.md",
    "share/NAME",
    "share/ament_index/resource_index/packages/NAME",
}


def test_the_repository_holds_what_is_meant_to_be_there_and_is_small() -> None:
    done = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if done.returncode:
        pytest.skip("no clone: git knows no files here")
    files = done.stdout.splitlines()
    assert {it.partition("/")[0] for it in files} == TOP
    sizes = {it: (ROOT / it).stat().st_size for it in files if (ROOT / it).exists()}
    assert sum(sizes.values()) < 18_000_000 and max(sizes.values()) < 250_000


def named_paths(text: str) -> Iterator[str]:
    roots = {it.name for base in (ROOT, ROOT / "multibot_rewrite") for it in base.iterdir()}
    for path in PATH.findall(text):
        if path.partition("/")[0] in roots and path not in ELSEWHERE:
            yield path


@pytest.mark.parametrize("file", [*PAGES, *MODULES], ids=lambda it: str(it.relative_to(ROOT)))
def test_a_file_that_is_named_is_there(file: Path) -> None:
    text = FENCE.sub("", file.read_text())
    bases = (ROOT, ROOT / "multibot_rewrite", file.parent)
    gone = [it for it in named_paths(text) if not any((base / it).exists() for base in bases)]
    # Pages that add a file show it in a code block before.
    made = [it for it in gone if it in file.read_text().replace(f"`{it}`", "")]
    assert [it for it in gone if it not in made and not Path(it).name.startswith("acme_")] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda it: str(it.relative_to(ROOT)))
def test_a_heading_stands_once(page: Path) -> None:
    headings = re.findall(r"^#+ .*$", FENCE.sub("", page.read_text()), re.MULTILINE)
    assert len(headings) == len({*headings})


@pytest.mark.parametrize("command", EVERY_COMMAND, ids=lambda it: it.name)
def test_a_help_text_names_only_options_that_there_are(command: Command) -> None:
    """Its own in the explanations; another command's only where that one is named."""
    own = {*make_parser(command).known()}
    others = {it.name: {*make_parser(it).known()} for it in EVERY_COMMAND}
    for group in command.groups:
        for option in group.options:
            for name in OPTION.findall(option.help):
                elsewhere = any(word in option.help and name in has for word, has in others.items())
                assert name in own or elsewhere, f"{command.name} {option.names[0]}: {name}"


COUNTED = re.compile(r"\ball (two|three|four|five|six|seven|\d+) layouts\b")
NUMBERS = ("", "", "two", "three", "four", "five", "six", "seven")


@pytest.mark.parametrize("page", PAGES, ids=lambda it: str(it.relative_to(ROOT)))
def test_pages_count_the_layouts_as_there_are(page: Path) -> None:
    found = COUNTED.findall(page.read_text())
    assert {*found} <= {NUMBERS[len(LAYOUTS)], str(len(LAYOUTS))}
