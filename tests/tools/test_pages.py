# SPDX-License-Identifier: Apache-2.0
"""The pages that are made with the site: each thing that is known stands on one."""

from __future__ import annotations

import re
from functools import cache

import pytest
from paths import ROOT

from multibot_rewrite.base.findings.codes import examples
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.description.rewriters.plugin_definitions import TYPES, load_definitions
from multibot_rewrite.lint import catalogue
from tools.pages.__main__ import main
from tools.pages.every import SECTIONS, STANDS_FOR, every_page, meant

pytestmark = pytest.mark.slow

made = cache(every_page)
WRITTEN = (ROOT / "docs" / STANDS_FOR).read_text()


def rows(page: str) -> list[list[str]]:
    """Return the cells of the rows of tables."""
    return [line.split(" | ") for line in page.splitlines() if line.startswith("| ")]


def test_every_code_has_a_page_that_says_all_of_it() -> None:
    for code, rule in catalogue.rules().items():
        page = made()[f"findings/{code}.md"]
        assert page.startswith(f"# {code} {rule.name}\n\n*{rule.level}*. ")
        assert "**Why.** " in page and "**Fix.** " in page
        assert page.count("```") == 2 * len(examples(rule))
    assert sum(it.startswith("findings/M") for it in made()) == len(catalogue.rules())


def test_the_list_of_findings_leads_to_each_page_once() -> None:
    listed = re.findall(r"\[(M\w+)\]\(\1\.md\)", made()["findings/index.md"])
    assert sorted(listed) == sorted(catalogue.rules())


def test_every_group_of_codes_has_a_heading() -> None:
    heads = re.findall(r"^## (M\w\d): ", made()["findings/index.md"], re.MULTILINE)
    assert {code[:3] for code in catalogue.rules()} == set(heads)


def test_examples_are_coloured_as_what_they_are() -> None:
    assert "```yaml\namcl:\n" in "".join(made().values())
    assert "```xml\n<link" in made()["findings/MB202.md"]


def test_text_is_no_html() -> None:
    """A tag in words would be one of the page, and lost."""
    for name, page in made().items():
        words = re.sub(r"```.*?```|`[^`]*`", "", page, flags=re.DOTALL)
        found = [it for it in re.findall(r"(?<!\\)<([a-z_]+)", words) if it != "br"]
        assert found == [], name


def test_every_section_of_the_definitions_is_on_its_page() -> None:
    for it in load_definitions((), "", packages=False).sections(*TYPES):
        page = made()[f"plugins/{it.file.removesuffix('.vocab')}.md"]
        assert f"\n## {it.name}\n" in page


def test_every_command_and_option_is_on_the_page() -> None:
    page = made()["commands.md"]
    for command in (*PROGRAMS.values(), *COMMANDS.values()):
        assert f" {command.name}\n" in page
        for option in (it for group in command.groups for it in group.options):
            assert f"`{', '.join(option.names)}" in page or option.keywords["metavar"] in page


@pytest.mark.parametrize(
    ("page", "words"),
    [
        # clients of AMCL and the base frame of it: nav2_amcl/src/amcl_node.cpp
        ("known-nodes.md", ("### amcl\n", "`initialpose`", "### joint_trajectory_controller\n")),
        ("known-parameters.md", ("`amcl` (nav2_amcl)", "`base_frame_id`")),
        ("fleet-keys.md", ("`robots`", "`related_files`", "required")),
        ("interfaces.md", ("## Endpoints", "## Parameters and launch files", "navigation2")),
        ("lint-triage.md", ("## MB202 ", "true: ")),
        ("upstream.md", ("```diff\n--- a/", "Revision `")),
    ],
)
def test_a_page_has_what_it_is_for(page: str, words: tuple[str, ...]) -> None:
    assert made()[page].startswith("# ")
    assert [it for it in words if it not in made()[page]] == []


def test_rows_have_as_many_cells_as_their_table() -> None:
    assert {len(it) for it in rows(made()["known-parameters.md"])} == {3}


def test_no_page_is_in_the_repository_as_well() -> None:
    assert [it for it in made() if (ROOT / "docs" / it).exists()] == []


def test_the_written_page_has_a_section_for_each() -> None:
    heads = re.findall(r"^## (.*)$", WRITTEN, re.MULTILINE)
    assert [it.lower().replace(" ", "-") for it in heads] == list(SECTIONS)
    assert {*SECTIONS.values()} <= made().keys()


def test_a_link_leads_to_what_it_means() -> None:
    assert meant("MG102", "findings", made()) == "findings/MG102.md"
    assert meant("findings", "findings", made()) == "findings/index.md"
    assert meant("MG999", "findings", made()) == "findings/index.md"
    assert meant("x", "nowhere", made()) == ""


def test_they_can_be_written_without_the_site(tmp_path) -> None:  # type: ignore[no-untyped-def]
    main(tmp_path)
    written = {it.relative_to(tmp_path).as_posix(): it.read_text() for it in tmp_path.rglob("*.md")}
    assert written == made()
