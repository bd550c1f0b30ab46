# SPDX-License-Identifier: Apache-2.0
"""Options mean the same on every command that has them, and a mistake says what was meant."""

from __future__ import annotations

import argparse
import io
import json
import random
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Sequence
from itertools import product
from pathlib import Path

import pytest
from paths import FIXTURES, ROOT

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, LAYOUTS, make_naming
from multibot_rewrite.base.nearest import typing_mistakes
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli import multibot, urdf_lint, urdf_postfix
from multibot_rewrite.cli.declared.commands import COMMANDS, PROGRAMS
from multibot_rewrite.cli.declared.options import Command
from multibot_rewrite.cli.hints import option_hint
from multibot_rewrite.cli.parser import make_parser, parsed
from multibot_rewrite.cli.report import check_report
from multibot_rewrite.cli.usage import check_xacro, policy, robots, separators, xacro_args
from multibot_rewrite.cli.values import MAX_DOMAIN
from multibot_rewrite.lint.catalogue import rules
from multibot_rewrite.planning.table_formats import FORMS
from multibot_rewrite.system import environment

ROVER = str(FIXTURES / "robots" / "rover.urdf")
ARM = str(FIXTURES / "xacros" / "arm.urdf.xacro")
FLEET = str(ROOT / "examples" / "launch_tutorial" / "fleet.yaml")
PARAMS = str(ROOT / "examples" / "namespace_and_prefix" / "nav2_params.yaml")
ALL = {**COMMANDS, **PROGRAMS}
EVERY = {"-q", "--quiet", "-v", "--verbose", "--color", "--version", "-h", "--help"}
OUTPUT = {"-o", "--output"}
NAMING = {"--layout", "--affix", "--topics", "--separator", "--shared"}
FINDINGS = {"--select", "--ignore", "--fail-on", "--format"}
DESCRIPTION = ("urdf-postfix", "urdf-lint", "plan", "rehearse")
# The options of a command; `help` has no result.
HAS = {**{name: EVERY | OUTPUT for name in ALL if name != "help"}, "help": EVERY}
REPORTS = (*DESCRIPTION, "build", "check")

# A letter that lacks, is too many, is another, or is swapped with the next.
MISTAKES: tuple[Callable[[str, int], str], ...] = (
    lambda it, at: it[:at] + it[at + 1 :],
    lambda it, at: f"{it[:at]}x{it[at:]}",
    lambda it, at: f"{it[:at]}x{it[at + 1 :]}",
    lambda it, at: it[:at] + it[at + 1] + it[at] + it[at + 2 :],
)


def names(command: Command) -> set[str]:
    return set(make_parser(command).known())


@pytest.mark.parametrize("name", ALL)
def test_a_command_has_the_options_that_all_have(name: str) -> None:
    wanted = set(HAS[name])
    wanted |= NAMING | {"--robots", "--definitions"} if name in DESCRIPTION else set()
    wanted |= FINDINGS if name in REPORTS else set()
    assert wanted - names(ALL[name]) == set()


def test_an_option_has_one_help_wherever_it_is() -> None:
    texts: dict[str, set[str]] = defaultdict(set)
    for command in ALL.values():
        for action in make_parser(command)._actions:
            for option in action.option_strings:
                texts[option].add(str(action.help))
    # What is written or suggested differs with the command; --node-set learns or uses one; init has
    # a layout of its own; check takes several domains.
    own = OUTPUT | {
        "--domain", "--output-kind", "--node-set", "--diff", "--suggest", "--layout", "--force",
        "--undo", "-n", "--count",
    }  # fmt: skip
    assert [it for it, told in texts.items() if len(told) > 1 and it not in own] == []
    assert all(text.endswith("missing folders are made") for text in texts["--output"])


def test_the_choices_are_those_of_the_modules_that_know_them() -> None:
    forms = COMMANDS["plan"].option("--output-kind").keywords["choices"]
    assert ("plan", "table", *FORMS, "bridge", "sros2") == forms
    assert MAX_DOMAIN == environment.MAX_DOMAIN
    layouts = {name for it in LAYOUTS for name in (it.name, it.short)}
    for name in DESCRIPTION:
        (action,) = (
            it for it in make_parser(ALL[name])._actions if "--layout" in it.option_strings
        )
        assert set(action.choices or ()) == layouts
        assert f"default: {DEFAULT_LAYOUT}" in str(action.help)


def test_the_default_of_what_is_shared_may_be_given() -> None:
    text = COMMANDS["plan"].option("--shared").help
    words = policy(given("plan", ROVER, "--shared", text.rpartition("default: ")[2]))
    assert make_naming(**words) == make_naming()


def given(name: str, *words: str) -> argparse.Namespace:
    return parsed(make_parser(ALL[name]), words)


@pytest.mark.parametrize("name", ["urdf-postfix", "plan", "rehearse"])
@pytest.mark.parametrize(
    "words",
    [
        ("a", "b", "c"),
        ("--robots", "a,b,c"),
        ("--robots", "a", "--robots", "b,c"),
        ("a", "--robots", "b, c"),
        ("a", "x:=1", "b", "--robots=c"),
    ],
)
def test_robots_are_words_or_a_list(name: str, words: Sequence[str]) -> None:
    assert robots(given(name, ROVER, *words)) == ["a", "b", "c"]


def test_robots_are_a_number_beside_arguments_of_a_xacro() -> None:
    options = given("urdf-postfix", ARM, "name:=a:=b", "-n", "3", "empty:=")
    assert robots(options) == ["robot1", "robot2", "robot3"]
    assert xacro_args(options) == {"name": "a:=b", "empty": ""}
    check_xacro(options, [ROVER, ARM])
    with pytest.raises(UsageError, match=r"a\.urdf is no xacro: leave out NAME:=VALUE"):
        check_xacro(options, ["a.urdf"])


@pytest.mark.parametrize("name", DESCRIPTION)
def test_the_naming_options_mean_the_same_everywhere(name: str) -> None:
    words = ["--layout", "L2", "--affix", "prefix", "--separator", "link=_,joint=/"]
    words += ["--shared", "world,/clock", "--shared", "odom", "--separator", "group=-"]
    assert policy(given(name, ROVER, *words)) == {
        "layout": "L2",
        "affix": "prefix",
        "separators": {"link": "_", "joint": "/", "group": "-"},
        "shared_frames": ["world", "odom"],
        "shared_topics": ["/clock"],
        "groups": "rename",
    }
    assert policy(given(name, ROVER)) == {}


def test_a_separator_alone_is_for_the_names_of_the_description() -> None:
    found = separators(given("urdf-postfix", "--separator", "_", "--separator", "joint=/"))
    assert found["joint"] == "/"
    assert {found[it] for it in ("link", "frame", "sensor", "model", "transmission")} == {"_"}
    assert not {"topic", "service", "node", "namespace"} & found.keys()
    assert "groups" not in policy(given("plan", ROVER, "--separator", "_"))


def said(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    """Exit code and output of one of the three programs, run in this process."""
    programs = {"urdf-postfix": urdf_postfix.main, "urdf-lint": urdf_lint.main}
    program = programs.get(words[0], multibot.main)
    capsys.readouterr()
    try:
        code = program(words[1:])
    except SystemExit as end:
        code = int(str(end.code))
    return code, *capsys.readouterr()


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("multibot remove", "unknown command 'remove'; see multibot --help"),
        ("multibot nodes", "use multibot snapshot"),
        ("urdf-lint a --tf_prefix x", "unknown option --tf_prefix; use --affix prefix"),
        ("urdf-lint a --xacro x", "unknown option --xacro; urdf-postfix takes it;"),
        ("multibot chek", "unknown command 'chek'; did you mean 'check'?"),
        ("multibot plan --form table", "unknown option --form; use --output-kind KIND"),
        ("multibot plan --layuot L1", "unknown option --layuot; did you mean '--layout'?"),
        ("urdf-postfix a b --udno", "unknown option --udno; did you mean '--undo'?"),
        ("urdf-lint a --formt json", "unknown option --formt; did you mean '--format'?"),
        ("multibot check p --format jsno", "'jsno' is not known"),
        ("multibot check p --format jsno", "did you mean 'json'?"),
        ("multibot plan a b --output-kind ros_args", "did you mean 'ros-args'?"),
        ("urdf-postfix a b --layout frames", "did you mean 'frames-per-robot'?"),
        ("urdf-postfix a b --fail-on eror", "did you mean 'error'?"),
        ("multibot build --color", "argument --color: expected one argument"),
        ("urdf-postfix a b --select MB9999", "did you mean 'MB9'?"),
        ("multibot plan a b --ignore undeclared-lnk", "did you mean 'undeclared-link'?"),
        ("multibot inspect MB20X", "did you mean 'MB20'?"),
        (f"multibot snapshot {PARAMS}", "a parameter file; rewrite it with urdf-postfix"),
        ("multibot snapshot --expect /a /b", "unexpected /b; a list is written A,B"),
        ("multibot build a.yaml b.yaml --select MB1", "unexpected b.yaml; see"),
        ("multibot build fleet.yaml 3", "unexpected 3; the number of robots is -n 3; see"),
        ("urdf-lint a --output-format github", "did you mean '--format'?"),
        ("multibot build --robots a,b", "write the key robots: into the fleet file"),
        ("multibot build --urdf a.urdf", "write the key description: into the fleet file"),
        ("multibot build --separator _", "write the key separators: into the fleet file"),
        (
            "multibot build --keep /scan",
            "write the key shared_frames: or shared_topics: or shared_nodes: into the fleet file",
        ),
        (f"multibot init {ROVER} -o new.yaml --node-set nav", "did you mean 'nav2'?"),
        ("multibot init a.urdf --prefix r_", "write the key affix: into the fleet file"),
        ("multibot init a.urdf --namespace r", "write the key topics: into the fleet file"),
        ("multibot init --urdf a.urdf", "use the file as a word: multibot init FILE"),
        ("multibot init a.urdf --rviz a.rviz", "use the file or its folder as a word"),
        ("multibot init a.urdf --names a,b", "use --robots A,B"),
        ("urdf-postfix a b --keep /scan", "use --shared FRAME,/TOPIC"),
        ("urdf-postfix a b --exclude /scan", "use --shared FRAME,/TOPIC"),
        ("urdf-lint a --severity error", "use --fail-on LEVEL"),
        (
            "multibot rviz f.yaml",
            "use multibot build FLEET: with layout: frames-per-robot it writes one fleet.rviz",
        ),
        (f"multibot plan r1 r2 {ROVER}", f"the file comes first: multibot plan {ROVER} r1 r2"),
        (f"multibot rehearse r1 {ROVER}", f"first: multibot rehearse {ROVER} r1"),
        ("urdf-lint a --list-rules", "use multibot inspect MB;"),
        ("urdf-lint a --rules", "use multibot inspect MB;"),
        ("urdf-lint a --disable MB211", "use --ignore CODES"),
        ("urdf-lint --explain MB211", "use multibot inspect CODE"),
        ("urdf-lint a -n 3", "use --robots robot1,robot2"),
        ("urdf-lint a --robot r1", "did you mean '--robots'?"),
        (
            "multibot inspect --strict",
            "--fail-on does that, which urdf-postfix, urdf-lint, multibot",
        ),
        ("urdf-postfix nosuch.yaml robot1", "nosuch.yaml is not there; correct the path\n"),
        (
            "multibot plan nosuch.yaml",
            "nosuch.yaml is not there; multibot init PATH... writes a fleet",
        ),
        (
            f"urdf-postfix {ROVER} robot1 -n 2",
            "--count 2 and robot1: give a number of robots, or their",
        ),
        (f"urdf-postfix {ROVER} -n 0", "--count 0: a fleet has at least one robot"),
        (f"urdf-postfix {ROVER} -n 10001", "--count 10001: a fleet has at least one robot"),
        (f"multibot build {FLEET} -n 0", "--count 0: a fleet has at least one robot"),
        (f"multibot plan {FLEET} -n 0", "--count 0: a fleet has at least one robot"),
        ("urdf-postfix a --separator link=_ frame=_", "write --separator link=_,frame=_"),
        ("urdf-postfix a b --separator link", "write KIND=SEP, for example link=_"),
        ("urdf-postfix a b --separator lnk=_", "'link'"),
        ("multibot help chek", "did you mean 'check'?"),
        ("multibot rehearse", "required: INPUT; see"),
        ("multibot rename a b", "required: FOLDER; see"),
        (f"multibot plan {FLEET} --layout L1", "leave out --layout"),
        (f"multibot plan {FLEET} robot1", "leave out ROBOT"),
        (f"multibot plan {PARAMS} robot1", "a parameter file; rewrite it with urdf-postfix"),
        ("multibot check p --watch --format json", "leave out --select, --ignore and --format"),
        (f"urdf-postfix {ROVER} r1 --format json", "name a file for the result with -o"),
        (f"multibot plan {ROVER} r1 --format sarif", "name a file for the result with -o"),
    ],
)
def test_a_mistake_is_one_line_with_a_hint(
    line: str, hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = said(capsys, *line.split())
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert hint in err


@pytest.mark.parametrize("name", ALL)
def test_a_mistyped_option_has_a_hint(name: str) -> None:
    """Each pair of typing mistakes in each option of five letters or more."""
    known = make_parser(ALL[name], name).known()
    drawn = random.Random(name)
    for option in (it for it in known if len(it) > 6):
        for mistakes in product(MISTAKES, repeat=2):
            wrong = option
            for mistake in mistakes:
                wrong = mistake(wrong, drawn.randrange(3, min(len(option), len(wrong)) - 1))
            hint = option_hint(wrong, name.rpartition(" ")[2], known, has_fleet=False)
            is_another = wrong in known or typing_mistakes(wrong[2:], option[2:]) > 2
            assert hint or is_another, (option, wrong)


@pytest.mark.parametrize(
    ("one", "other", "mistakes"),
    [("", "", 0), ("quite", "quiet", 1), ("disabel", "disable", 1), ("lyout", "layout", 1),
     ("formatt", "format", 1), ("stirkt", "strict", 2), ("a", "abcd", 3), ("abc", "xyz", 3)],
)  # fmt: skip
def test_typing_mistakes_are_counted(one: str, other: str, mistakes: int) -> None:
    assert (typing_mistakes(one, other), typing_mistakes(other, one)) == (mistakes, mistakes)


def test_a_person_can_read_the_options_of_all_commands() -> None:
    """What the parsers take, ``--help`` and ``--version`` among it; none is hidden."""
    every = [it for command in ALL.values() for it in make_parser(command)._actions]
    assert len({it.option_strings[-1] for it in every if it.option_strings} - {"-h"}) <= 61
    assert [it for it in every if it.help == argparse.SUPPRESS] == []
    # A shell asks for one of them: completion.
    assert len({*COMMANDS} - {"completion"}) <= 12


def test_an_unknown_layout_is_refused_by_the_library_too() -> None:
    from multibot_rewrite.base.naming import make_naming

    with pytest.raises(UsageError, match="frames-per-robot"):
        make_naming("frames")


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "words",
    [
        ("urdf-postfix", ROVER, "r1"),
        ("urdf-lint", ROVER),
        ("multibot", "plan", ROVER, "r1"),
        ("multibot", "plan", "--output-kind=table", ROVER, "r1"),
        ("multibot", "inspect", ARM),
        ("multibot", "inspect", "--suggest", ROVER),
        ("multibot", "inspect", "MB202"),
    ],
    ids=" ".join,
)
def test_o_makes_folders_and_holds_what_would_be_printed(
    words: Sequence[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, printed, _ = said(capsys, *words)
    target = tmp_path / "new" / "deep" / "result"
    assert said(capsys, *words, "-o", str(target))[:2] == (code, "")
    # A file is for an editor, too, which reads where its schema is.
    assert re.sub(r"^# yaml-language-server: .*\n", "", target.read_text()) == printed
    assert said(capsys, *words, "-o", "-")[:2] == (code, printed)
    code, out, err = said(capsys, *words, "-o", str(target), "-v", "-q")
    assert (out, "wrote" in err) == ("", False)
    assert f"wrote {target}" in said(capsys, *words, "-o", str(target), "-v")[2]


def test_a_folder_holds_a_file_of_each_robot_and_no_list_of_changes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = str(tmp_path)
    assert said(capsys, "urdf-postfix", ROVER, "r1", "-q", "-o", folder) == (0, "", "")
    (made,) = (it for it in tmp_path.rglob("*") if it.is_file())
    assert made == tmp_path / "r1" / Path(ROVER).name
    told = f"urdf-postfix: {folder}: cannot be written: it is a folder, name a file in it\n"
    words = ("urdf-postfix", ROVER, "r1", "--output-kind", "changes", "-o", folder)
    assert said(capsys, *words) == (2, "", told)


def test_standard_input_has_a_name_in_findings(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = '<robot name="r">\n<link name="a"/>\n<link name="b"/></robot>'
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    code, out, err = said(capsys, "urdf-lint", "-", "--select", "MB501")
    assert (code, out.partition(" ")[0]) == (1, "<stdin>:3:7:")
    assert err.startswith("urdf-lint: 1 file: 1 error")


def test_a_folder_is_not_left_behind_where_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    words = ("urdf-postfix", ROVER, "new/r1", "file", "-o", str(tmp_path / "{robot}/x.urdf"))
    assert said(capsys, *words)[0] == 2
    assert [it.name for it in tmp_path.iterdir()] == ["file"]


@pytest.mark.more
def test_the_plan_knows_the_names_that_a_rewrite_with_the_same_options_makes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ["--affix", "prefix", "--separator", "_", "--shared", "base_footprint"]
    assert said(capsys, "urdf-postfix", ROVER, "left", *options, "-o", str(tmp_path / "a"))[0] == 0
    assert 'name="left_base_link"' in (tmp_path / "a").read_text()
    code, out, _ = said(capsys, "multibot", "plan", ROVER, "left", *options, "--node-set", "nav2")
    assert code == 0
    assert "left_base_link" in out
    assert "left_base_footprint" not in out


def test_a_definitions_reaches_every_command_that_reads_a_description(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    more = tmp_path / "bad.vocab"
    more.write_text("[plugin acme]\nx uses wheel\n")
    for words in (
        ["plan", ROVER, "r"],
        ["plan", "--output-kind=table", ROVER, "r"],
        ["inspect", ARM],
    ):
        code, _, err = said(capsys, "multibot", *words, "--definitions", str(more))
        assert (code, "bad.vocab:2: unknown kind 'wheel'" in err) == (2, True), words


# ---------------------------------------------------------------- help, explain, start


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ALL)
def test_help_begins_with_an_example_that_the_parser_takes(name: str) -> None:
    command = ALL[name]
    text = make_parser(command).format_help()
    first = command.examples[0].command
    assert text.index(first) < text.index("\ngeneral:") < text.index("exit codes:")
    for example in command.examples:
        # cat and grep are beside it in a pipe.
        pipe = (it.split() for it in example.command.split(" | "))
        program, *words = next(it for it in pipe if it[0] in ("multibot", *ALL))
        called = COMMANDS[words.pop(0)] if program == "multibot" else ALL[program]
        assert parsed(make_parser(called), [it.strip("'") for it in words])


@pytest.mark.parametrize("width", [60, 100])
def test_help_is_as_wide_as_the_terminal(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    text = make_parser(ALL["plan"]).format_help()
    options = text.partition("\ninput:")[2].partition("\nexit codes:")[0]
    longest = max(map(len, options.splitlines()))
    assert width - 12 < longest <= width


def test_help_in_colour(capsys: pytest.CaptureFixture[str]) -> None:
    plain = said(capsys, "multibot", "plan", "--help")[1]
    painted = said(capsys, "multibot", "plan", "--color", "always", "--help")[1]
    assert "\033[1mexamples:\033[0m" in painted
    assert "\033[36m  -o, --output\033[0m PATH" in painted
    assert "\033" not in plain


@pytest.mark.parametrize("name", [*COMMANDS, *PROGRAMS])
def test_the_short_help_fits_a_screen_and_names_every_option(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("multibot", name) if name in COMMANDS else (name,)
    code, shown, err = said(capsys, *words, "-h")
    assert (code, err) == (0, "")
    lines = shown.splitlines()
    assert len(lines) <= 24 and max(map(len, lines)) <= 80
    assert lines[0].startswith(f"usage: {' '.join(words)} ")
    assert sum(line.startswith("  ") and words[-1] in line for line in lines) >= 2
    names = [it.names[-1] for group in ALL[name].groups for it in group.options]
    assert [it for it in names if it.startswith("-") and f" {it}" not in shown] == []
    assert len(said(capsys, *words, "--help")[1]) > len(shown)


def test_the_list_of_commands_is_their_help_line_by_line() -> None:
    assert multibot.overview("never").splitlines() == [
        "usage: multibot COMMAND [options]",
        "Many robots in one ROS 2 system: rewrite, plan, build and check a fleet.",
        "",
        "examples:",
        "  multibot init rover.urdf",
        "  multibot build fleet.yaml",
        "",
        "commands:",
        *(f"  {it.name}{' ' * (14 - len(it.name))}{it.about}" for it in COMMANDS.values()),
        "",
        "multibot COMMAND -h shows more. Also: urdf-postfix, urdf-lint.",
    ]


def test_the_list_of_commands_fits_a_screen(capsys: pytest.CaptureFixture[str]) -> None:
    lines = said(capsys, "multibot", "-h")[1].splitlines()
    assert len(lines) <= 24 and max(map(len, lines)) <= 80


def test_help_of_a_command_by_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert said(capsys, "multibot", "help", "plan") == said(capsys, "multibot", "plan", "--help")
    assert said(capsys, "multibot", "help") == said(capsys, "multibot", "--help")


@pytest.mark.more
def test_every_code_is_explained_by_code_name_and_beginning(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for rule in rules().values():
        code, out, _ = said(capsys, "multibot", "inspect", rule.code)
        assert (code, out.startswith(f"{rule.code} {rule.name} (")) == (0, True)
        assert all(text in out for text in (rule.what, rule.why, rule.fix))
    one = said(capsys, "multibot", "inspect", "MB202")
    assert said(capsys, "multibot", "inspect", "undeclared-link") == one
    group = said(capsys, "multibot", "inspect", "MB20")[1]
    assert group.count("\nWhy: ") == sum(code.startswith("MB20") for code in rules()) > 2
    many = said(capsys, "multibot", "inspect", "MB2,MB501")[1].splitlines()
    codes = [it for it in rules() if it.startswith("MB2") or it == "MB501"]
    assert [line.split()[0] for line in many] == ["code", *codes]
    listed = said(capsys, "multibot", "inspect")[1].partition("\ncode  ")[2].splitlines()[1:]
    assert [line.split()[0] for line in listed] == list(rules())
    shown = json.loads(said(capsys, "multibot", "inspect", "mb202", "--output-kind", "json")[1])
    assert [it["code"] for it in shown["rules"]] == ["MB202"]


def python(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout


def test_the_package_is_a_program() -> None:
    command = [sys.executable, "-m", "multibot_rewrite", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("multibot ")


@pytest.mark.more
@pytest.mark.sample(5)
@pytest.mark.parametrize("name", ALL)
def test_help_imports_nothing_heavy(name: str) -> None:
    """A help text needs the options alone: not the modules that do the work."""
    own = name not in COMMANDS
    module = name.replace("-", "_") if own else "multibot"
    words = ["--help"] if own else [name, "--help"]
    code = (
        f"import sys, contextlib\nfrom multibot_rewrite.cli.{module} import main\n"
        f"with contextlib.suppress(SystemExit): main({words})\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    there = set(done.stderr.split())
    assert f"multibot_rewrite.cli.{module}" in there
    heavy = {"lxml", "yaml", "rich", "json", "xacro", "multibot_rewrite.description.library"}
    rooms = {"lint", "rules", "planning", "fleet", "related_files", "description", "producers"}
    assert there & (heavy | {f"multibot_rewrite.{room}" for room in rooms}) == set()


def test_nothing_is_imported_before_ctrl_c_is_quiet() -> None:
    """Ctrl-C while a module is imported is a traceback, until the program's first line."""
    code = (
        "import __future__, sys\nbefore = {*sys.modules}\nimport multibot_rewrite.cli.entry\n"
        "print(*sorted({*sys.modules} - before))"
    )
    own = {f"multibot_rewrite{it}" for it in ("", ".version", ".cli", ".cli.entry")}
    assert {*python(code).split()} - {*sys.builtin_module_names} == own


# In a callback of a weak reference an exception is printed and forgotten.
FORGOTTEN = """
import signal, time, weakref
from multibot_rewrite.cli.process import guarded
def run():
    gone = weakref.ref(type('A', (), {})(), lambda _: signal.raise_signal(signal.SIGINT))
    time.sleep(20)
    return 0
signal.signal(signal.SIGINT, signal.default_int_handler)
guarded('multibot', run, True)"""
BEFORE_A_COMMAND = """
import signal, sys
from types import SimpleNamespace
from multibot_rewrite.cli import entry
main = lambda: signal.raise_signal(signal.SIGINT)
sys.modules['multibot_rewrite.cli.multibot'] = SimpleNamespace(main=main)
entry.multibot()"""


@pytest.mark.slow
@pytest.mark.parametrize("code", [FORGOTTEN, BEFORE_A_COMMAND])
def test_ctrl_c_ends_with_one_line(code: str) -> None:
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=15)
    told = "multibot: interrupted; no half-written file is left\n"
    assert (done.returncode, done.stderr) == (130, told)


# ---------------------------------------------------------------- counts and colour


@pytest.mark.more
def test_one_is_not_many(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert (plural(1, "robot"), plural(2, "robot"), plural(0, "file")) == (
        "1 robot",
        "2 robots",
        "0 files",
    )
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(f"robots:\n  - {{name: robot1, description: {ROVER}}}\n")
    code, _, err = said(capsys, "multibot", "build", str(fleet), "-o", str(tmp_path / "out"))
    assert (code, err.startswith("multibot: 1 robot, ")) == (0, True), err


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("environment", "option", "coloured"),
    [
        ({}, [], False),
        ({"FORCE_COLOR": "1"}, [], True),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, [], False),
        ({"NO_COLOR": "1"}, ["--color", "always"], True),
        ({"FORCE_COLOR": "1"}, ["--color", "never"], False),
    ],
)
def test_colour_is_asked_for_or_not(
    environment: dict[str, str],
    option: list[str],
    coloured: bool,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    for name in ("FORCE_COLOR", "NO_COLOR"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    lines = (
        ("urdf-postfix", ROVER, "r", "--diff"),
        ("urdf-lint", ROVER),
        ("multibot", "inspect", "gazebo"),
    )
    for words in lines:
        assert ("\033[" in said(capsys, *words, *option)[1]) == coloured, words


def test_json_goes_to_a_file_as_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "lint.json"
    words = ("urdf-lint", ROVER, "--format", "json", "--color", "always", "-o", str(target))
    assert said(capsys, *words)[0] == 0
    assert json.loads(target.read_text())["tool"] == "urdf-lint"


@pytest.mark.parametrize(
    ("words", "answer"),
    [
        (("multibot", "strip"), "use urdf-postfix FILE ROBOT --undo"),
        (("multibot", "postfix", "r.urdf"), "use urdf-postfix INPUT ROBOT..."),
        (("multibot", "lint"), "use urdf-lint"),
        (("multibot", "doctor"), "use multibot check"),
        (("multibot", "init", "--undo"), "multibot build FLEET --undo"),
        (("multibot", "check", "--fleeet", "f"), "use the fleet file as the first word"),
        (("urdf-postfix", "r.urdf", "a", "--stripp"), "use urdf-postfix FILE ROBOT --undo"),
        (("urdf-lint", "--disabel=MG102"), "unknown option --disabel; use --ignore CODES; see"),
        (("urdf-lint", "-quiet", "a"), "unknown option -quiet; did you mean '--quiet'?"),
        (("multibot", "check", "--layuot", "L1"), "and 3 more take --layout; see"),
        (("multibot", "build", "--lay", "L1"), "write the key layout: into the fleet file"),
        (("multibot", "check", "--norm"), "unknown option --norm; see"),
        (("urdf-postfix", "r.urdf", "a", "--strip"), "use urdf-postfix FILE ROBOT --undo"),
    ],
)
def test_wrong_words_are_answered_by_the_right_ones(
    words: tuple[str, ...], answer: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, _, err = said(capsys, *words)
    assert code == 2 and answer in err and len(err.splitlines()) == 1


def test_the_name_of_a_rule_selects_and_ignores_it() -> None:
    words = ("--select", "undeclared-link,MG1", "--ignore", "several-roots,MB3")
    options = given("plan", ROVER, *words)
    check_report(options, printed=False)
    assert (options.select, options.ignore) == (["MB202", "MG1"], ["MB501", "MB3"])
