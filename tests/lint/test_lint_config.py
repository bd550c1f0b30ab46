# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint.toml``, ``[tool.urdf-lint]``: found, read, wrong ones named; the page's examples hold."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pytest
from paths import ROOT

from multibot_rewrite import UsageError
from multibot_rewrite.base.findings.selection import is_on
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.config.configured import (
    Configured,
    configured,
    is_excluded,
    with_options,
)
from multibot_rewrite.lint.config.values import READERS, find_lint_codes
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.settings import is_silent

PAGE = (ROOT / "docs" / "lint.md").read_text().partition("## pre-commit and CI")[0]
TWO_ROOTS = '<robot name="r"><link name="a"/><link name="b"/></robot>'
SECTION = "[plugin mine]\nmy_frame uses link frame\n"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Return what a configuration may name is there."""
    for folder in ("robots/deep", "vendor/acme", "data", "external"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "data" / "mine.vocab").write_text(SECTION)
    (tmp_path / "robots" / "rover.urdf").write_text(TWO_ROOTS)
    return tmp_path


def read(project: Path, text: str) -> Configured:
    (project / "urdf-lint.toml").write_text(text)
    return configured(str(project / "robots"), None)


def codes(path: Path, it: Configured) -> list[str]:
    return [finding.code for finding in lint_file(str(path), it.settings)]


# What its keys say.


# Pattern, path below the configuration's folder, is it matched; a folder counts with its content.
PATTERNS = [
    ("rover.urdf", "rover.urdf", True),
    ("rover.urdf", "robots/deep/rover.urdf", True),
    ("rover.urdf", "robots/big_rover.urdf", False),
    ("*.srdf", "robots/a.srdf", True),
    ("*.srdf", "a.srdf", True),
    ("*.srdf", "a.srdf.xacro", False),
    ("vendor", "vendor/acme/a.urdf", True),
    ("vendor", "robots/vendor/a.urdf", True),
    ("vendor/", "vendor/acme/a.urdf", True),
    ("vendor/", "vendored/a.urdf", False),
    ("vendor/acme", "vendor/acme/a.urdf", True),
    ("vendor/acme", "robots/vendor/acme/a.urdf", False),
    ("vendor/*/a.urdf", "vendor/acme/a.urdf", True),
    ("./vendor/*", "vendor/acme/a.urdf", True),
    ("**/acme/*.urdf", "vendor/acme/a.urdf", True),
    ("**/acme/*.urdf", "acme/a.urdf", True),
    ("**/acme/*.urdf", "vendor/acme2/a.urdf", False),
    ("a[12].urdf", "robots/a2.urdf", True),
    ("a[!12].urdf", "robots/a2.urdf", False),
    ("a?.urdf", "a2.urdf", True),
]


@pytest.mark.sample(1)
@pytest.mark.parametrize("outside", [".", "robots"])
@pytest.mark.parametrize(("pattern", "path", "hit"), PATTERNS)
def test_patterns_hang_on_the_folder_of_the_file(
    project: Path, monkeypatch: pytest.MonkeyPatch, pattern: str, path: str, hit: bool, outside: str
) -> None:
    """However the path is written and wherever the command runs."""
    found = read(project, f"exclude = ['{pattern}']\nper-file-ignores = {{'{pattern}' = ['MB5']}}")
    monkeypatch.chdir(project / outside)
    up = "../" if outside != "." else ""
    for written in (str(project / path), f"{up}{path}", f"./{up}{path}"):
        assert is_excluded(written, found) is hit
        assert is_silent(found.settings, written, "MB501") is hit
        assert not is_silent(found.settings, written, "MB115")


def test_folders_above_the_configuration_are_not_meant(tmp_path: Path) -> None:
    project = tmp_path / "build" / "project[1]"
    (project / "robots").mkdir(parents=True)
    found = read(project, 'exclude = ["build", "project*"]')
    assert not is_excluded(str(project / "robots" / "a.urdf"), found)
    assert is_excluded(str(project / "robots" / "build" / "a.urdf"), found)


# What is wrong with it.

WRONG = [
    ("ignore = [", ": broken TOML, correct it: "),
    ("ignore = ['MB5'\nx", "2:1: broken TOML"),
    ("ignore = ['MB5']\nignore = ['MB6']\n", "2:17: broken TOML"),
    ("a = " + "[" * 5000, "TOML that cannot be read"),
    pytest.param(
        "seconds = " + "1" * 5000,
        "TOML that cannot be read",
        marks=pytest.mark.skipif(
            not hasattr(sys, "get_int_max_str_digits"), reason="this Python reads any number"
        ),
    ),
    ("per-file-ignore = {}", "unknown key 'per-file-ignore', did you mean 'per-file-ignores'?"),
    ("fail_on = 'error'", "unknown key 'fail_on', did you mean 'fail-on'?"),
    ("xyzzy = 1", "unknown key 'xyzzy', use one of select, ignore, "),
    ("[tool.urdf-lint]\nignore = []", "unknown key 'tool'"),
    ("ignore = 'MB5'", "ignore is a string, write a list of texts"),
    ("ignore = ['MB5', 5]", "ignore holds a number, write texts in quotes"),
    ("ignore = ['MB99']", "ignore: no rule has the code 'MB99', and none begins with it; did you"),
    ("select = ['mb501']", "did you mean 'MB501'?"),
    ("select = ['MB5011']", "did you mean 'MB501'?"),
    ("select = ['several-rots']", "did you mean 'several-roots'?"),
    ("select = ['M']", "no rule has the code 'M'"),
    ("select = ['']", "no rule has the code ''"),
    ("select = ['E501']", "no rule has the code 'E501'"),
    ("per-file-ignores = ['MB5']", "per-file-ignores is a list, write a table"),
    (
        "per-file-ignores = {'a.urdf' = 'MB5'}",
        "per-file-ignores: 'a.urdf' is a string, write a list",
    ),
    ("per-file-ignores = {'a.urdf' = ['X1']}", "'a.urdf': no rule has the code 'X1'"),
    ("per-file-ignores = {'' = ['MB5']}", "a pattern is empty"),
    ("exclude = ['!a.urdf']", "takes no file back in"),
    ("exclude = ['{a,b}.urdf']", "one pattern each instead of {a,b}"),
    ("exclude = ['a[1.urdf']", "a bracket is not closed"),
    ("exclude = ['../a.urdf']", "leads out of the folder"),
    ("levels = 3", "levels is a number, write a table"),
    ("levels = {MB99 = 'note'}", "levels: no rule has the code 'MB99'"),
    ("levels = {MB5 = 'fatal'}", "levels: 'MB5' is 'fatal', use one of error, warning, note, off"),
    ("levels = {MB5 = false}", "levels: 'MB5' is a boolean, write a text in quotes"),
    ("robots = ['r1', 'r-2']", "robots: robot name 'r-2': character 2, '-'"),
    ("robots = ['r1', 'r1']", "robots: robot name 'r1' is given twice"),
    ("layout = 'L9'", "layout 'L9' is not known"),
    ("layout = ''", "layout is empty"),
    ("affix = 'infix'", "affix 'infix' is not known, use one of postfix, prefix"),
    ("separators = {links = '_'}", "separator kind 'links' is not known"),
    ("separators = {link = 1}", "separators: 'link' is a number"),
    ("separators = {node = '/'}", "separator node='/': use one of _"),
    ("targets = ['sdf']", "targets is 'sdf', use one of mjcf"),
    ("roots = ['nowhere']", "roots: there is no folder"),
    ("roots = ['robots/rover.urdf']", "roots: there is no folder"),
    ("urdf = 'nowhere.urdf'", "has no 'nowhere.urdf'; correct the path"),
    ("urdf = ['robots/rover.urdf']", "urdf is a list, write a text in quotes"),
    ("definitions = ['nowhere.vocab']", "definitions: no file 'nowhere.vocab' in"),
    ("xacro = {files = '*'}", "xacro is a table, write tables [[xacro]]"),
    ("xacro = ['a']", "xacro, number 1 is a string, write a table"),
    ("[[xacro]]\nfiles = '*'", "xacro, number 1: no arguments"),
    ("[[xacro]]\nargs = {}", "xacro, number 1: unknown key 'args', use files, arguments"),
    ("[[xacro]]\narguments = {a = [1]}", "number 1: 'arguments': 'a' is a list"),
    ("[[xacro]]\narguments = {}\nfiles = 3", "number 1: 'files' is a number"),
    ("baseline = true", "baseline is a boolean"),
    ("fail-on = 'never'", "fail-on is 'never', use one of error, warning, note"),
    ("seconds = 0", "seconds is 0, write more than 0"),
    ("seconds = nan", "seconds is nan"),
    ("seconds = inf", "seconds is inf"),
    ("seconds = true", "seconds is a boolean"),
    ("seconds = '5'", "seconds is a string"),
    ("seconds = 1979-05-27", "seconds is a date"),
]


@pytest.mark.parametrize(("text", "words"), WRONG)
def test_what_is_wrong_is_one_line(project: Path, text: str, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        read(project, text)
    message = str(caught.value)
    assert message.startswith(f"{project / 'urdf-lint.toml'}:")
    assert words in message
    assert "\n" not in message


def test_every_key_is_refused_what_it_cannot_mean(project: Path) -> None:
    for key in READERS:
        with pytest.raises(UsageError, match=rf"{key} is a date|{key} is 1979"):
            read(project, f"{key} = 1979-05-27")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[tool]\nurdf-lint = 3", "tool.urdf-lint is a number, write [tool.urdf-lint]"),
        ("[tool.urdf_lint]\nignore = []", "[tool.urdf_lint] is not read, write [tool.urdf-lint]"),
        ("[tool.urdf-lint]\nignor = []", "unknown key 'ignor', did you mean 'ignore'?"),
        ("# urdf-lint\n[tool\n", "2:6: broken TOML"),
    ],
)
def test_a_wrong_project_file_is_one_line(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "pyproject.toml").write_text(text)
    with pytest.raises(UsageError) as caught:
        configured(str(tmp_path), None)
    assert str(caught.value).startswith(f"{tmp_path / 'pyproject.toml'}:")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("none.toml", None, "cannot be read: No such file"),
        ("", None, "cannot be read: Is a directory"),
        ("pyproject.toml", b"[project]\n", "it has no table [tool.urdf-lint]; add it"),
        ("a.toml", b"# \xff", "1: it is not UTF-8"),
    ],
)
def test_a_given_file_that_is_no_configuration(
    tmp_path: Path, name: str, content: bytes | None, words: str
) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(UsageError) as caught:
        configured(str(tmp_path), str(path))
    assert str(caught.value).startswith(f"{path}:")
    assert words in str(caught.value)


# What the command adds.

OPTIONS: list[tuple[str, dict[str, Any], dict[str, bool]]] = [
    ("", {"select": ("MB5",)}, {"MB501": True, "MB201": False}),
    ('select = ["MB2"]', {"select": ("MB5",)}, {"MB501": True, "MB201": False}),
    ('ignore = ["MB501"]', {"select": ("MB5",)}, {"MB501": False, "MB502": True}),
    ('ignore = ["MB501"]', {"select": ("MB501",)}, {"MB501": True}),
    ('ignore = ["MB5"]', {"select": ("MB5",)}, {"MB501": True}),
    ('levels = {MB501 = "off"}', {"select": ("MB501",)}, {"MB501": True}),
    ('levels = {MB501 = "off"}', {"select": ("MB5",)}, {"MB501": False, "MB502": True}),
    ('ignore = ["MB2"]', {"ignore": ("MB5",)}, {"MB501": False, "MB201": False, "MB115": True}),
    ('select = ["MB5"]', {"ignore": ("MB501",)}, {"MB501": False, "MB502": True, "MB201": False}),
    ('select = ["MB5"]', {"select": (), "ignore": None}, {"MB501": True, "MB201": False}),
]


@pytest.mark.parametrize(("text", "given", "wanted"), OPTIONS)
def test_the_command_has_the_last_word_on_codes(
    project: Path, text: str, given: dict[str, Any], wanted: dict[str, bool]
) -> None:
    settings = with_options(read(project, text), **given).settings
    assert {code: is_on(settings, code) for code in wanted} == wanted


def test_the_command_replaces_or_adds(project: Path) -> None:
    text = """\
        robots = ["r1"]
        targets = []
        roots = ["external"]
        baseline = "a.json"
        layout = "L4"
        affix = "prefix"
        definitions = ["data/mine.vocab"]
        [[xacro]]
        arguments = {sim = "gz"}
    """
    it = with_options(
        read(project, text),
        robots=("r2", "r3"),
        target=("mjcf",),
        baseline="b.json",
        fail_on="note",
        layout="L1",
        definitions=("more.vocab",),
        arguments=(("fake", "true"),),
        urdf="other.urdf",
    )
    settings = it.settings
    assert (settings.robots, settings.targets) == (("r2", "r3"), ("mjcf",))
    assert (it.baseline, it.fail_on, settings.urdf) == ("b.json", "note", "other.urdf")
    assert settings.naming == make_naming("L1", "prefix")
    assert settings.roots == (str(project / "external"),)
    assert settings.definitions == (str(project / "data/mine.vocab"), "more.vocab")
    assert [str(given) for given in settings.arguments] == ["sim:=gz", "fake:=true"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"select": ("MB99",)}, "--select: no rule has the code 'MB99'"),
        ({"ignore": ("MB5", "")}, "--ignore: no rule has the code ''"),
        ({"target": ("sdf",)}, "--target is 'sdf', use one of mjcf"),
        ({"robots": ("a b",)}, "--robots: robot name 'a b'"),
        ({"fail_on": "never"}, "--fail-on is 'never', use one of"),
        ({"layout": "L9"}, "layout 'L9' is not known"),
    ],
)
def test_wrong_options_are_one_line(given: dict[str, Any], words: str) -> None:
    with pytest.raises(UsageError, match=re.escape(words)):
        with_options(Configured(), **given)


def test_every_code_and_every_beginning_is_one() -> None:
    beginnings = tuple(code[:size] for code in RULES for size in (2, 3, 4, 5))
    assert find_lint_codes(beginnings, "here") == beginnings
    with pytest.raises(UsageError, match="here: no rule has the code 'MB50x'"):
        find_lint_codes(["MB5", "MB50x"], "here")


def test_the_name_of_a_rule_stands_for_its_code(project: Path) -> None:
    it = read(
        project,
        "select = ['several-roots', 'MB2']\nignore = ['undeclared-link']\n"
        "levels = {several-roots = 'note'}\nper-file-ignores = {'a.urdf' = ['undeclared-link']}",
    )
    assert it.settings.select == ("MB501", "MB2") and it.settings.ignore == ("MB202",)
    assert it.settings.levels == {"MB501": "note"}
    assert {codes for _, codes in it.settings.per_file} == {("MB202",)}
    it = with_options(Configured(), select=("undeclared-link",), ignore=("several-roots", "MB3"))
    assert it.settings.select == ("MB202",) and it.settings.ignore == ("MB501", "MB3")
    assert find_lint_codes([*(rule.name for rule in RULES.values())], "here") == tuple(RULES)


# The page.

EXAMPLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize("text", EXAMPLES)
def test_an_example_of_the_page_is_read(project: Path, text: str) -> None:
    for name in ("robots/rover.urdf", "definitions/acme.vocab"):
        (project / name).parent.mkdir(exist_ok=True)
        (project / name).write_text("")
    (project / "src").mkdir()
    file = project / ("pyproject.toml" if "[tool.urdf-lint" in text else "urdf-lint.toml")
    file.write_text(text)
    found = configured(str(project), None)
    assert found.file == str(file)
    assert found != Configured(file=str(file))


def test_every_key_has_an_example_on_the_page() -> None:
    whole = "\n".join(EXAMPLES)
    missing = [
        key
        for key in READERS
        if not re.search(rf"^(\[*|\[tool.urdf-lint\.){key}\b", whole, re.MULTILINE)
    ]
    assert missing == []
    reported = re.findall(r"^\| `([a-z-]+)` \|", PAGE, re.MULTILINE)
    assert sorted(reported) == sorted(READERS)
