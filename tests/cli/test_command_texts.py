# SPDX-License-Identifier: Apache-2.0
"""What commands print, from records made by hand: the view of a graph, reports, help, exit codes."""

from __future__ import annotations

import argparse
import signal
from pathlib import Path
from typing import Any

import pytest
from graph_cases import environment, qos

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, ProofError, Unusable, UsageError
from multibot_rewrite.cli import (
    adopt,
    fleet as commands_of_fleets,
    inspect,
    live,
    parser,
    plan,
    process,
    rehearse,
    rename,
    rewrite_file,
    snapshot,
    unplanned,
)
from multibot_rewrite.cli.declared.options import (
    Command,
    Example,
    OptionGroup,
    argument,
    choice,
    switch,
)
from multibot_rewrite.cli.multibot import MultibotCommand
from multibot_rewrite.cli.tables import Grid, render
from multibot_rewrite.description.reports.xacro_arguments import Argument, Use, XacroArguments
from multibot_rewrite.description.rewriters.lookup import look_up
from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions
from multibot_rewrite.knowledge.nodl.writing import NodlFile
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.library.one_file import RewrittenFile
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.live.learning.learn import LearnedNode
from multibot_rewrite.system.records import (
    PUBLISHES,
    SERVES,
    SERVICE,
    TOPIC,
    Caveat,
    Edge,
    End,
    Node,
    System,
)


def options(**given: Any) -> argparse.Namespace:
    return argparse.Namespace(**given)


def end(kind: str, role: str, node: str = "/a") -> End:
    return End(kind, role, "/x", "t", "", node, None, "")


# ---------------------------------------------------------------- multibot snapshot


def test_a_graph_with_nothing_is_its_headline() -> None:
    around = environment()._replace(
        domain=7, range="", static_peers=("a", "b"), settled="timeout", participants=1, seconds=0.06
    )
    assert render(snapshot.report(System(environment=around))) == (
        "0 nodes in 1 participant after 0.1 s (timeout); domain 7, peers a b, rmw_fastrtps_cpp\n"
    )
    router = environment()._replace(rmw="rmw_zenoh_cpp", discovery_server="tcp/a:1", range="")
    line = next(snapshot.report(System((Node("/a"),), environment=router)))
    assert line == (
        "1 node in 4 participants after 3.5 s (no change any more);"
        " domain 0, router tcp/a:1, rmw_zenoh_cpp"
    )


# ---------------------------------------------------------------- multibot inspect


def test_arguments_of_a_xacro() -> None:
    uses = (Use("link", "prefix", "_", 3, 4, "r_base"), Use("topic", "whole", "", 1, 1, "r"))
    found = XacroArguments(
        "a b.xacro",
        (
            Argument("name", "robot", uses, 0, ""),
            Argument("size", "", (), 0, ""),
            Argument("bad", "x", (), 0, "it breaks"),
        ),
        ("late",),
    )
    parts = render(inspect.arguments_report(found)).splitlines()
    assert [it.split() for it in parts[:4]] == [
        ["argument", "default", "goes", "into", "as", "count", "example"],
        ["name", "robot", "link", "prefix", "_", "3", "of", "4", "r_base"],
        ["topic", "whole", "1", "of", "1", "r"],
        [],
    ]
    assert parts[4:7] == [
        "go into no names: size", "take no name of a robot: bad", "too many to try: late",
    ]  # fmt: skip
    assert parts[8].startswith("  urdf-postfix 'a b.xacro' robot1 robot2 -o 'out/{robot}.urdf'")


SECTION = """\
[plugin mine acme::Mine]
about: a camera
source: acme/camera 1.0
ros: 2
releases: jazzy+
insert: {}
frame       uses frame default={{link}} when=on=true   # the note
words/word  uses topic form=list releases=jazzy
"""


def test_a_section_of_the_definitions_as_docs_node_sets_md_has_it(tmp_path: Path) -> None:
    for insert in ("yes", "no"):
        file = tmp_path / f"{insert}.vocab"
        file.write_text(SECTION.format(insert))
        known = load_definitions((str(file),), "jazzy")
        (section,) = look_up(known, "mine", ("plugin",))
        frame = {
            "path": "frame", "role": "uses", "kinds": ("frame",), "form": "whole", "default": "{link}",
            "inserted": insert == "yes", "when": "on=true", "note": "the note", "releases": "",
            "block": "", "file": str(file), "line": 7,
        }  # fmt: skip
        words = {
            "path": "words/word", "role": "uses", "kinds": ("topic",), "form": "list", "default": "",
            "inserted": False, "when": "", "note": "", "releases": "jazzy", "block": "",
            "file": str(file), "line": 8,
        }  # fmt: skip
        assert inspect.as_json(section) == {
            "type": "plugin", "names": ("mine", "acme::Mine"), "ros": "2", "about": "a camera",
            "source": "acme/camera 1.0", "releases": "jazzy+", "file": str(file), "line": 1, "at": (),
            "blocks": (), "remap_only": (), "topics": [], "rows": [frame, words],
        }  # fmt: skip
        default = "{link}" if insert == "yes" else "{link} (not inserted)"
        *lines, grid = inspect.details([section])
        never = "  never inserted into: it throws on unknown children"
        assert [it for it in lines if it != never] == [
            f"plugin mine (ROS 2)  {file}:1", "  about: a camera", "  in: jazzy+",
            "  also called: acme::Mine", "  source: acme/camera 1.0",
        ]  # fmt: skip
        assert (never in lines) == (insert == "no")
        columns = ("path", "role", "kinds", "form", "default", "note", "from")
        assert grid == Grid(columns, [
            ("frame", "uses", "frame", "", default, "the note (when on=true)", f"{file}:7"),
            ("words/word", "uses", "topic", "list", "", "in jazzy:", f"{file}:8"),
        ])  # fmt: skip
        columns = ("type", "name", "ROS", "also called", "rows", "source")
        row = ("plugin", "mine", "2", "acme::Mine", "2", "acme/camera 1.0")
        assert [*inspect._section_table([section])] == [Grid(columns, [row])]
    assert "" in [*inspect.details([section, section])], "an empty line is between two"
    said = "no plugin, node, class, element, sensor type, rule or file has this name"
    for name, hint in (
        ("qqqqqq", "multibot inspect lists all"), ("mines", "the nearest known: mine"),
        ("undeclared-lnk", "the nearest known: undeclared-link"),
    ):  # fmt: skip
        text = str(inspect._unknown_name(known, name, ("plugin",)))
        assert text == f"{name!r} is not known: {said}; {hint}"
    later = load_definitions((str(file),), "humble")
    text = str(inspect._unknown_name(later, "mine", ("plugin",)))
    assert text.startswith("'mine' is not in humble, only in jazzy, kilted, lyrical, rolling; ")


# ---------------------------------------------------------------- described nodes


def learned(seen: str, name: str, *remarks: str) -> LearnedNode:
    return LearnedNode(seen, NodeFacts(name, "", ()), (), (), remarks)


def test_what_is_left_out_is_noted() -> None:
    helper = Node("/transform_listener_impl_55d0", "alone")
    graph = System((Node("/r/a", "p"), helper, Node("/rviz2")))
    below = learned("/r/a", "r/a", "is odd")
    assert [*snapshot._notes(graph, [below], None, False)] == [
        "/r/a: is odd",
        "whose helpers these are is not seen, they are left out: /transform_listener_impl_55d0",
        "left out as tools: /rviz2; to learn one give its name to --node",
        "all are below /r; if that is the robot's namespace, add --namespace /r",
    ]
    quiet = System((Node("/r/a"),))
    assert [*snapshot._notes(quiet, [below], "/r", False)] == ["/r/a: is odd"]
    both = [learned("/r/a", "r/a"), learned("/b", "b")]
    assert [*snapshot._notes(quiet, both, None, False)] == []
    assert [*snapshot._notes(quiet, [both[0], learned("/q/a", "q/a")], None, False)] == []
    assert [*snapshot._notes(System((Node("/rviz2"),)), both[1:], None, True)] == []


def test_how_many_nodes_answered(capsys: pytest.CaptureFixture[str]) -> None:
    """Of those that have the service of a state under their name."""
    state = "lifecycle_msgs/srv/GetState"
    ends = (End(SERVICE, SERVES, f"{it}/get_state", state, "", it, None, "") for it in ("/a", "/b"))
    graph = System((Node("/a", lifecycle="active"), Node("/b"), Node("/c")), tuple(ends))
    for asked in (True, False):
        live.note_answers(options(state=asked, quiet=False, program="multibot"), graph)
    assert capsys.readouterr().err == "multibot: 1 of 2 nodes answered --state\n"
    given = options(state=False)
    assert live.with_states(given, graph) is graph


def test_nodl_is_written_to_a_file_or_below_a_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    a, b = NodlFile("a", "A\n", ()), NodlFile("r/b", "B\n", ("/x", "/y"))
    usual: dict[str, Any] = {"verbose": False, "program": "multibot", "quiet": False}
    assert [*snapshot._write_nodl(options(output=None, **usual), [a])] == []
    assert capsys.readouterr().out == "A\n"
    file = str(tmp_path / "b.nodl.yaml")
    told = ["r/b: NoDL has no form for /x, /y; left out"]
    assert [*snapshot._write_nodl(options(output=file, **usual), [b])] == told
    assert Path(file).read_text() == "B\n"
    assert [*snapshot._write_nodl(options(output=str(tmp_path / "f"), **usual), [a, b])] == told
    assert (tmp_path / "f" / "a.nodl.yaml").read_text() == "A\n"
    assert (tmp_path / "f" / "r" / "b.nodl.yaml").read_text() == "B\n"
    for output in (None, "-", file):
        with pytest.raises(UsageError) as caught:
            [*snapshot._write_nodl(options(output=output, **usual), [a, b])]
        hint = "name one with --node, or a folder with -o"
        assert str(caught.value) == f"a NoDL file is for one node, here are 2; {hint}"


# ---------------------------------------------------------------- a file beside a description


def test_the_summary_of_a_file_beside_a_description() -> None:
    words = {
        "params": "a parameter file", "rviz": "a config of RViz", "moveit": "a file of MoveIt",
        "bridge": "a file of ros_gz_bridge", "tree": "a behavior tree", "lua": "a Lua file",
    }  # fmt: skip
    for kind, text in words.items():
        made = [RewrittenFile("r1", kind, b"", (), ())]
        assert rewrite_file.summary(made, ["r1"], "", "") == f"r1: rewrote {text}. Verified"
    kept = [
        RewrittenFile(it, "lua", b"", (), why) for it, why in (("a", ("x", "y")), ("b", ("y",)))
    ]
    assert rewrite_file.summary(kept, ["a", "b"], "jazzy", "it is set") == (
        "2 robots: rewrote a Lua file. Not verified: x, y (ROS 2 jazzy: it is set)"
    )


def test_a_caveat_is_a_note_or_makes_the_view_incomplete(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for incomplete in (True, False):
        given = options(quiet=False, program="multibot")
        snapshot._remark(given, Caveat("a", incomplete, "is odd"))
    assert capsys.readouterr().err == "multibot: incomplete: is odd\nmultibot: note: is odd\n"


# ---------------------------------------------------------------- a fleet


def test_what_a_fleet_was_made_from_is_not_written_over(tmp_path: Path) -> None:
    read = str(tmp_path / "rover.xacro")
    fleet: Any = argparse.Namespace(read=[read])
    for name in ("output", "save_snapshot", "report"):
        with pytest.raises(UsageError) as caught:
            commands_of_fleets.check_unread(options(**{name: read}), fleet)
        option = f"--{name.replace('_', '-')}"
        said = f"{read} is a file that is read; choose another one for {option}"
        assert str(caught.value) == said
        commands_of_fleets.check_unread(options(**{name: str(tmp_path / "out")}), fleet)


def test_what_a_fleet_file_says_itself() -> None:
    names = (
        "robots", "node_set", "nodes", "layout", "affix", "topics", "separator", "shared",
        "definitions", "launch", "roots",
    )  # fmt: skip
    assert {
        "words": "ROBOT", **{it: f"--{it}".replace("_", "-") for it in names},
    } == commands_of_fleets.OF_FLEET_FILE  # fmt: skip


# ---------------------------------------------------------------- plan, rehearse, check


@pytest.mark.parametrize(
    ("name", "it_is"),
    [("a.launch.py", True), ("a.py", True), ("a.launch.xml", True), ("a_launch.yaml", True),
     ("a.launch", True),
     ("system_model.yaml", True), ("my_system_model.yaml", True), ("a.urdf", False),
     ("launch.yaml", False),
     ("a.launch.x.y", False), ("fleet.yaml", False)],
)  # fmt: skip
def test_a_launch_file_is_told_by_its_name(name: str, it_is: bool) -> None:
    assert bool(plan._LAUNCH.fullmatch(name)) is it_is


def test_options_that_a_plan_of_a_launch_file_has_not() -> None:
    assert plan.NOT_OF_LAUNCH == {
        "robots": "--robots", "count": "--count", "node_set": "--node-set", "launch": "--launch",
        "layout": "--layout",
        "affix": "--affix", "topics": "--topics", "separator": "--separator", "shared": "--shared",
    }  # fmt: skip


def test_what_stubs_do_not_send_is_not_kept() -> None:
    graph = System(
        ends=(end(TOPIC, PUBLISHES)._replace(qos=qos()),),
        edges=(Edge("a", "b", "/tf", False, (), transform=(1.0,)),),
    )
    made = rehearse._without_places(graph)
    assert (made.ends[0].qos, made.edges[0].transform) == (None, ())


def test_types_that_are_replaced_are_noted(capsys: pytest.CaptureFixture[str]) -> None:
    given = options(quiet=False, program="multibot")
    rehearse._note_substitutes(given, {})
    rehearse._note_substitutes(given, {"b/B": "x"})
    rehearse._note_substitutes(given, dict.fromkeys("gfedcb", "x"))
    end = "not installed here and replaced by others: {}; this does not change the names\n"
    assert capsys.readouterr().err == (
        f"multibot: note: 1 type is {end.format('b/B')}"
        f"multibot: note: 6 types are {end.format('b, c, d, e, f and 1 more')}"
    )


def test_a_graph_of_tools_alone_has_nothing_to_judge() -> None:
    said = ["no node of a robot is in this graph, so there is nothing to judge"]
    for graph, reasons in (
        (System(), said), (System((Node("/rviz2"),)), said), (System((Node("/rviz2"), Node("/a"))), []),
    ):  # fmt: skip
        seen = diagnose(graph)
        assert [*unplanned._nothing_seen(seen)] == reasons
        # What is found between tools was judged.
        found = seen._replace(findings=(Finding("MG306", "error", "differs"),))
        assert [*unplanned._nothing_seen(found)] == []


def test_what_a_rename_changes_and_leaves(capsys: pytest.CaptureFixture[str]) -> None:
    given = options(
        quiet=False, verbose=True, program="multibot", kind="link", old="a", new="b"
    )  # fmt: skip
    usual: dict[str, Any] = {
        "places": 3,
        "after": {"x": b"", "y": b""},
        "unread": {},
        "left": (),
    }
    rename._print_result(given, options(**usual))  # type: ignore[arg-type]
    assert capsys.readouterr().err == "multibot: link a -> b: 3 places in 2 files; verified\n"
    few = ", ".join(f"f:{at}" for at in range(5))
    left = [options(place=f"f:{at}", why="odd") for at in range(60)]
    more = {**usual, "unread": {"p": "p: odd", "q": ""}, "left": left}
    rename._print_result(given, options(**more))  # type: ignore[arg-type]
    assert capsys.readouterr().err.splitlines() == [
        "multibot: link a -> b: 3 places in 2 files; verified, 2 descriptions not read",
        "multibot: not checked: p: odd", "multibot: not checked: q",
        f"multibot: left as they are: {len(left)} lines with 'a': {few} and {len(left) - 5} more",
        *(f"multibot:   f:{at}: odd" for at in range(60)),
    ]  # fmt: skip
    rename._print_result(options(**{**vars(given), "verbose": False}), options(**more))  # type: ignore[arg-type]
    assert capsys.readouterr().err.endswith(f": {few} and {len(left) - 5} more\n")


def test_what_a_package_takes_from_now_on(capsys: pytest.CaptureFixture[str]) -> None:
    given = options(quiet=False, program="multibot")
    usual: dict[str, Any] = {
        "argument": "prefix", "verified": ("a",), "configurations": (), "after": {"f": b""},
        "namespace": "", "spaced": (), "launches": (), "already": {}, "left": (), "unread": {},
        "bare": {},
    }  # fmt: skip
    top = "a: it takes the argument; verified"

    def told(**more: Any) -> list[str]:
        adopt._print_result(given, options(**{**usual, **more}))  # type: ignore[arg-type]
        return [it.removeprefix("multibot: ") for it in capsys.readouterr().err.splitlines()]

    assert told() == ["argument prefix: 1 description in 1 file; verified", top]
    assert told(verified=()) == [
        "argument prefix: 0 descriptions in 1 file; not verified, see what is left"
    ]
    assert told(verified=("a", "b"), configurations=("c",)) == [
        "argument prefix: 2 descriptions and 1 other configuration in 1 file; verified",
        top,
        "b: it takes the argument; verified",
    ]
    assert told(already={"a": "own"}, bare={"c": ("x", "y")})[1:] == [
        "a: its argument own reaches all its names; verified",
        "c: error: 'x', 'y' stay without the prefix; put the argument before them by hand",
    ]
    assert told(unread={"u": "u: odd"}) == [
        "argument prefix: 1 description in 1 file; verified, 1 description not read",
        top,
        "not checked: u: odd",
    ]
    files = {"l": b"<arg prefix:= />", "m": b"<arg ns:= prefix:= />"}
    kept = {"argument": "", "verified": (), "already": {"x": "tf_prefix"}}
    assert told(**kept, unread={"u": "u: odd", "v": ""}) == [
        "x: it has such an argument already: tf_prefix", "not checked: u: odd", "not checked: v",
    ]  # fmt: skip
    left = (options(place="f:3", why="it is odd"),)
    assert told(
        namespace="ns", spaced=("a", "b"), launches=("l", "m"), after=files, left=left
    ) == [
        "argument prefix: 1 description in 2 files; verified", top,
        "argument ns: namespaces and topics in 2 descriptions; verified",
        "l: it hands prefix on; verified", "m: it hands prefix and ns on; verified",
        "left as they are: 1 place", "f:3: left as it is: it is odd",
    ]  # fmt: skip


# ---------------------------------------------------------------- help and mistakes


COMMAND = Command(
    "do", "done", "%(prog)s FILE [options]", "Do it.",
    (Example("multibot do a", "as it is"), Example("multibot do " + "b" * 60, "long"),
     Example("x" * 79)),
    (
        OptionGroup("input, and more", (argument("the file", "file", "FILE"),)),
        OptionGroup("output", (
            choice("100 % of it", "--output-kind", "FORM", "a|b"),
            switch("say less", "-q,--quiet"),
        )),
    ),
    "0 done; 2 wrong", "One paragraph.\n\n  as it is", fail_on="error",
)  # fmt: skip


def test_headings_and_names_are_painted() -> None:
    text = "usage: x\noptions:\n  -q, --quiet  less\n  --output-kind F\nNo: x\n"
    assert parser.painted(text, False) == text
    assert parser.painted(text, True) == (
        "\033[1musage:\033[0m x\n\033[1moptions:\033[0m\n\033[36m  -q, --quiet\033[0m  less\n"
        "\033[36m  --output-kind\033[0m F\nNo: x\n"
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--quite"], "unknown option --quite; did you mean '--quiet'?"),
        (["--from=a"],
         "unknown option --from; multibot check, multibot snapshot, multibot view take it"),
        (["--changed"], "unknown option --changed; urdf-lint takes --changed-since"),
        (["--dry-run"],
         "unknown option --dry-run; --diff does that,"
         " which urdf-postfix, urdf-lint, multibot rename take"),
        (["--xyzabc"], "unknown option --xyzabc"),
        (["--github"],
         "unknown option --github; --format does that,"
         " which urdf-postfix, urdf-lint, multibot build and 5 more take"),
        # Dashes are not counted.
        (["--oxtput-kxnd"], "unknown option --oxtput-kxnd; did you mean '--output-kind'?"),
        (["a", "b"], "unexpected b"),
        # A part of it says what it is, another first letter of a short one does not.
        (["--form", "b"], "unknown option --form; use --output-kind KIND"),
        (["--stack", "b"],
         "unknown option --stack; --node-set does that,"
         " which multibot init, multibot plan, multibot rehearse and 1 more take"),
        (["--output-form", "b"], "unknown option --output-form; did you mean '--output-kind'?"),
        (["--norm"], "unknown option --norm"),
        # A short option, alone or with its value; what is no option is a value.
        (["-n", "3"],
         "unknown option -n; urdf-postfix, multibot build, multibot init and 3 more take it"),
        (["-x3"], "unknown option -x3"),
        (["a", "-0.5"], "unexpected -0.5"),
    ],
)  # fmt: skip
def test_a_mistake_is_one_line(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as caught:
        parser.parsed(parser.make_parser(COMMAND, "multibot do"), words)
    assert caught.value.code == 2
    assert capsys.readouterr().err == f"multibot do: {said}; see multibot do --help\n"


def test_what_a_command_is_told() -> None:
    made = parser.parsed(
        parser.make_parser(COMMAND, "multibot do"), ["a", "--output-kind", "b", "-q"]
    )
    assert vars(made) == {
        "file": "a", "output_kind": "b", "quiet": True, "command": "do", "findings_first": False,
        "fail_on": "error", "program": "multibot", "h": None,
    }  # fmt: skip
    assert parser._colour_asked(["--color", "always", "--color=never"]) == "never"
    assert (parser._colour_asked([]), parser._colour_asked(["--color", "always"])) == (
        "auto",
        "always",
    )
    assert parser._first_unknown_option(["--", "--odd"], ["--output-kind"]) == ""
    assert parser._first_unknown_option(["-qv", "-q", "-q3", "-"], ["-q"]) == ""


def test_the_command_of_ros2() -> None:
    """ros2cli asks for add_arguments and main."""
    made = argparse.ArgumentParser(
        prog="ros2 multibot", formatter_class=argparse.RawTextHelpFormatter
    )
    MultibotCommand().add_arguments(made, "ros2 multibot")
    given = made.parse_args(["check", "--watch", "a"])
    assert (given.command, given.words) == ("check", ["--watch", "a"])
    lines = str(made.epilog).splitlines()
    assert lines[0] == "commands:" and any(it.startswith("  build       ") for it in lines)
    assert lines[-2:] == ["", "ros2 multibot COMMAND --help shows the options of each"]
    assert MultibotCommand.NAME == "multibot"


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (
            ProofError("x"), 1,
            "verification failed, nothing was written; this is a fault of the tool, report it: x",
        ),
        (UsageError("x"), 2, "x"), (InputError("x"), 2, "x"), (Unusable("x"), 4, "x"),
        (KeyboardInterrupt(), 130, "interrupted; no half-written file is left"),
    ],
)  # fmt: skip
def test_an_error_is_a_line_and_an_exit_code(
    error: BaseException, code: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails() -> int:
        raise error

    assert process.guarded("p", fails, False) == code
    assert capsys.readouterr().err == f"p: {said}\n"
    assert process.guarded("p", lambda: 3, False) == 3


def test_a_closed_pipe_is_no_finding(capsys: pytest.CaptureFixture[str]) -> None:
    """``| head`` has read enough: the code that a shell gives for SIGPIPE, and no word."""

    def writes() -> int:
        raise BrokenPipeError

    assert process.guarded("p", writes, False) == 128 + signal.SIGPIPE
    assert capsys.readouterr() == ("", "")
