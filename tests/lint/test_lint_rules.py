"""Every rule finds its bad example, once, and leaves its good one alone."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite.findings.finding import LEVELS, Finding
from multibot_rewrite.findings.rule import SRDF, XACRO, Rule
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.registry import GROUPS, RULES
from multibot_rewrite.lint.settings import Settings

XACRO_USED = "xmlns:xacro"
# No file holds them: a fault of the lint, and the end of its patience.
WITHOUT_EXAMPLES = {"MB001", "MB004"}


def whole(example: str) -> str:
    """The document that an example stands for."""
    return (
        example
        if re.match(r"\W*(<\?xml|<robot)", example)
        else f'<robot name="r">{example}</robot>'
    )


def linted(rule: Rule, example: str, folder: Path) -> list[Finding]:
    for name, content in rule.beside.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)
    ending = "urdf.xacro" if XACRO in rule.formats or XACRO_USED in example else "urdf"
    ending = "srdf" if rule.formats == (SRDF,) else ending
    file = folder / f"example.{ending}"
    file.write_text(whole(example))
    options: dict[str, Any] = {"roots": (str(folder),), **rule.options}
    if "urdf" in options:
        options["urdf"] = str(folder / options["urdf"])
    found = lint_file(str(file), Settings(select=(rule.code,), **options))
    return [it for it in found if it.code == rule.code]


EXAMPLES = [code for code in RULES if code not in WITHOUT_EXAMPLES]


@pytest.mark.parametrize("code", EXAMPLES)
def test_the_bad_example_is_found_once(code: str, tmp_path: Path) -> None:
    (found,) = linted(RULES[code], RULES[code].bad, tmp_path)
    assert found.message
    assert (found.line, found.column) >= (1, 1)
    assert Path(found.file).parent == tmp_path


@pytest.mark.parametrize("code", EXAMPLES)
def test_the_good_example_is_left_alone(code: str, tmp_path: Path) -> None:
    assert linted(RULES[code], RULES[code].good, tmp_path) == []


@pytest.mark.parametrize("rule", RULES.values(), ids=RULES)
def test_the_words_of_a_rule_are_all_there(rule: Rule) -> None:
    assert rule.level in LEVELS
    assert all(text.endswith(".") for text in (rule.what, rule.why, rule.fix))
    assert re.fullmatch(r"[a-z]+(-[a-z0-9]+)*", rule.name)
    assert rule.check.__doc__


def test_names_are_no_two_rules() -> None:
    assert len({rule.name for rule in RULES.values()}) == len(RULES)


def test_every_rule_is_in_its_group() -> None:
    homes = {start: module.__name__ for start, _, module in GROUPS}
    assert {c: r.check.__module__ for c, r in RULES.items()} == {c: homes[c[:3]] for c in RULES}
