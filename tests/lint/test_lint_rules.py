"""Every rule finds its bad example, once, and leaves its good one alone."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import Any

import pytest

from multibot_rewrite.lint import rules
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.files.subjects import read_subjects
from multibot_rewrite.lint.records import LEVELS, SRDF, XACRO, LintFinding, Rule, Subject
from multibot_rewrite.lint.registry import GROUPS, RULES, rules_of
from multibot_rewrite.lint.rules.meshes.shared import used_files
from multibot_rewrite.lint.settings import Settings

XACRO_USED = "xmlns:xacro"
# No file holds them: a fault of the lint, and the end of its patience.
WITHOUT_EXAMPLES = {"MB001", "MB004"}
MESHES = b"""<robot name="r"><link name="a"><visual><geometry><mesh filename="a.stl"/></geometry>
</visual></link></robot>"""


def whole(example: str) -> str:
    """The document that an example stands for."""
    return (
        example
        if re.match(r"\W*(<\?xml|<robot)", example)
        else f'<robot name="r">{example}</robot>'
    )


def linted(rule: Rule, example: str, folder: Path) -> list[LintFinding]:
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
    assert getattr(rule.check, "func", rule.check).__doc__


def test_names_are_no_two_rules() -> None:
    assert len({rule.name for rule in RULES.values()}) == len(RULES)


def test_every_rule_is_in_its_group() -> None:
    homes = {rule.code: start for start, _, group in GROUPS for rule in rules_of(group)}
    assert homes == {code: code[:3] for code in RULES}


def test_no_file_of_rules_is_left_out_of_its_group() -> None:
    names = [it.name for it in walk_packages(rules.__path__, f"{rules.__name__}.")]
    written = (vars(import_module(name)).values() for name in names)
    declared = {it.code for values in written for it in values if isinstance(it, Rule)}
    assert declared == set(RULES)


def test_memos_are_of_one_subject_each() -> None:
    """Two documents that are alike are not one: what is found must be elements of the right one."""
    first, second = (next(read_subjects("a.urdf", MESHES, Settings())) for _ in range(2))
    assert isinstance(first, Subject)
    assert isinstance(second, Subject)
    found = used_files(first)
    assert [it.element for it in found] == list(first.document.root.iter("mesh"))
    assert used_files(first) is found
    assert [it.element for it in used_files(second)] == list(second.document.root.iter("mesh"))
