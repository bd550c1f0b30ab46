# SPDX-License-Identifier: Apache-2.0
"""The command as a person meets it: what it prints, writes and returns, run as a process."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import stat
import subprocess
from collections import Counter
from pathlib import Path

import pytest
from lxml import etree
from paths import FIXTURES, ROBOTS
from postfix_command import (
    COMMAND,
    PATIENCE,
    TEN,
    Result,
    contents,
    run,
    run_on_terminal,
    temporaries,
)
from waiting import wait_until

import multibot_rewrite
from multibot_rewrite import rewrite_all

pytestmark = pytest.mark.slow

OPTIONS = (
    (),
    ("--affix", "prefix"),
    ("--layout", "tf-per-robot"),
    ("--layout", "L2", "--topics", "prefix"),
    ("--layout", "both"),
    ("--affix", "prefix", "--layout", "frames-per-robot", "--separator", "link=_"),
    ("--separator", "link=_,joint=/", "--shared", "odom"),
)


def run_shell(folder: Path, redirection: str, *words: str) -> Result:
    """Run the command with a shell's redirection of its streams."""
    line = ["sh", "-c", f'"$@" {redirection}', "sh", *COMMAND, *words]
    done = subprocess.run(line, cwd=folder, capture_output=True, check=False, timeout=PATIENCE)
    return Result(done.returncode, done.stdout, done.stderr.decode())


def names(data: bytes, tag: str) -> list[str]:
    """Return the names of the root's children of that tag."""
    return [str(element.get("name")) for element in etree.fromstring(data).findall(tag)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the fixture robots, where the command runs."""
    for path in ROBOTS.iterdir():
        shutil.copy(path, tmp_path)
    return tmp_path


@pytest.fixture
def rover(folder: Path) -> bytes:
    """Return the rover as it was given."""
    return (folder / "rover.urdf").read_bytes()


# ---------------------------------------------------------------- the main job


@pytest.mark.parametrize("file", ["rover.urdf", "rover_gz.urdf"])
def test_one_robot_to_standard_output(folder: Path, file: str) -> None:
    before = (folder / file).read_bytes()
    result = run(folder, file, "robot1")
    assert result.code == 0
    assert names(result.out, "link") == [f"{name}/robot1" for name in names(before, "link")]
    assert names(result.out, "joint") == [f"{name}_robot1" for name in names(before, "joint")]
    assert result.out.count(b"\n") >= before.count(b"\n")


def test_a_file_holds_what_standard_output_would(folder: Path) -> None:
    printed = run(folder, "rover.urdf", "robot1")
    result = run(folder, "rover.urdf", "robot1", "-o", "robot1.urdf")
    assert (result.code, result.out) == (0, b"")
    assert (folder / "robot1.urdf").read_bytes() == printed.out
    assert temporaries(folder) == []


@pytest.mark.parametrize(
    ("argument", "plugin"),
    [
        pytest.param("sim:=classic", b"libgazebo_ros_diff_drive.so", id="classic"),
        pytest.param("sim:=gz", b"gz-sim-diff-drive-system", id="gz"),
        pytest.param("use_sim:=true", b"gz-sim-diff-drive-system", id="not-declared"),
    ],
)
def test_several_robots_from_xacro(folder: Path, argument: str, plugin: bytes) -> None:
    (folder / "out").mkdir()
    words = ("rover.urdf.xacro", "robot1", "robot2", "-o", "out/{robot}.urdf", argument)
    result = run(folder, *words)
    assert (result.code, result.out) == (0, b"")
    one, two = ((folder / "out" / f"robot{number}.urdf").read_bytes() for number in (1, 2))
    assert plugin in one
    assert names(two, "link")[0] == "base_footprint/robot2"
    assert one.replace(b"robot1", b"robot2") == two
    assert sorted(contents(folder / "out")) == ["robot1.urdf", "robot2.urdf"]


@pytest.mark.sample(4)
@pytest.mark.parametrize("file", ["rover.urdf", "rover_gz.urdf"])
@pytest.mark.parametrize("options", OPTIONS, ids=lambda words: " ".join(words) or "defaults")
def test_strip_gives_the_original_back(folder: Path, file: str, options: tuple[str, ...]) -> None:
    assert run(folder, file, "robot1", "-o", "robot1.urdf", *options).code == 0
    result = run(folder, "robot1.urdf", "robot1", "--undo", *options)
    assert result.code == 0, result.err
    assert result.out == (folder / file).read_bytes()
    assert "robot1" in result.err


def test_standard_input(folder: Path, rover: bytes) -> None:
    printed = run(folder, "rover.urdf", "robot1")
    assert run(folder, "-", "robot1", stdin=rover).out == printed.out
    assert run(folder, "-", "robot1", "--undo", stdin=printed.out).out == rover


def test_diff_leads_from_the_input_to_the_result(folder: Path, rover: bytes) -> None:
    result = run(folder, "-", "robot1", "--diff", stdin=rover)
    lines = result.out.splitlines(keepends=True)
    after = run(folder, "rover.urdf", "robot1").out
    assert result.code == 0
    assert lines[:2] == [b"--- <stdin>\n", b"+++ <stdin> for robot1\n"]
    for sign, text in ((b"-", rover), (b"+", after)):
        said = Counter(line[1:] for line in lines[2:] if line.startswith(sign))
        other = after if text is rover else rover
        there, missing = (Counter(part.splitlines(keepends=True)) for part in (text, other))
        assert said - there == Counter()
        assert there - missing - said == Counter()


def test_diff_of_letters_a_locale_cannot_show(folder: Path) -> None:
    (folder / "rövér.urdf").write_text('<robot name="rövér">\n<link name="ü"/></robot>', "utf-8")
    ascii_only = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"}
    result = run(folder, "rövér.urdf", "robot1", "--diff", env=ascii_only)
    assert result.code == 0
    assert '+<robot name="rövér_robot1">\n' in result.out.decode()
    assert "\\ No newline at end of file\n" in result.out.decode()


def test_diff_of_a_stripped_pipe_reads_it_once(folder: Path) -> None:
    rewritten = run(folder, "rover.urdf", "robot1").out
    result = run(folder, "/dev/stdin", "robot1", "--undo", "--diff", stdin=rewritten)
    assert b'-<robot name="rover_robot1">' in result.out
    assert b'+<robot name="rover">' in result.out


def test_changes_are_those_of_the_library(folder: Path) -> None:
    words = ("rover.urdf", "robot1", "robot2", "--output-kind", "changes", "-o", "changes.json")
    assert run(folder, *words).code == 0
    table = json.loads((folder / "changes.json").read_bytes())
    assert table["file"] == "rover.urdf"
    made = rewrite_all(folder / "rover.urdf", ["robot1", "robot2"])
    assert table["robots"] == {it.robot: [one._asdict() for one in it.changes] for it in made}


def test_again_rewrites_what_is_rewritten(folder: Path) -> None:
    run(folder, "siblings.urdf", "robot1", "-o", "robot1.urdf")
    result = run(folder, "robot1.urdf", "robot1", "--force")
    assert result.code == 0
    assert all(name.endswith("/robot1/robot1") for name in names(result.out, "link"))


def test_the_examples_of_the_help_work(folder: Path) -> None:
    """In their order, as typed: the inverse needs the file an earlier one wrote."""
    text = run(folder, "--help").out.decode()
    lines = [line for line in text.splitlines() if re.match("  (urdf-postfix|cat) ", line)]
    assert len(lines) >= 6
    (folder / "out").mkdir()
    shutil.copytree(FIXTURES / "xacros", folder, dirs_exist_ok=True)
    (folder / "nav2_params.yaml").write_text(
        "amcl: {ros__parameters: {base_frame_id: base_link}}\n"
    )
    shim = folder / "urdf-postfix"
    shim.write_text(f'#!/bin/sh\nexec {" ".join(COMMAND)} "$@"\n')
    shim.chmod(0o755)
    path = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
    for line in lines:
        command = re.split(r"\s{3,}", line.strip())[0]
        done = subprocess.run(
            ["sh", "-c", command], cwd=folder, env=path, capture_output=True, check=False
        )
        assert done.returncode == 0, (command, done.stderr)
    names = ["left.urdf", "right.urdf", "robot1.urdf", "robot2.urdf", "robot3.urdf"]
    assert sorted(contents(folder / "out")) == names


def test_a_definitions_file_teaches_a_plugin(folder: Path) -> None:
    (folder / "in.urdf").write_text(
        '<robot name="a">\n<link name="base_link"/>\n<gazebo><plugin name="mine" '
        'filename="libmine.so"><my_frame>base_link</my_frame></plugin></gazebo>\n</robot>\n'
    )
    (folder / "mine.vocab").write_text("[plugin mine]\nopens: nothing\nmy_frame uses link frame\n")
    without = run(folder, "in.urdf", "robot1")
    assert b"<my_frame>base_link</my_frame>" in without.out
    assert [line.split(":")[1] for line in without.err.splitlines()[:2]] == ["3", "3"]
    taught = run(folder, "in.urdf", "robot1", "--definitions", "mine.vocab")
    assert b"<my_frame>base_link/robot1</my_frame>" in taught.out
    assert "warning" not in taught.err


# ---------------------------------------------------------------- report and exit code


def test_the_report_counts_by_kind(folder: Path, rover: bytes) -> None:
    result = run(folder, "rover.urdf", "robot1")
    links, joints = len(names(rover, "link")), len(names(rover, "joint"))
    start = f"urdf-postfix: robot1: renamed {links} links, {joints} joints, 3 sensors, 1 model"
    assert result.err.startswith(start)
    assert ", 5 nodes, 1 topic prefix, 2 topics; " in result.err
    why = "ROS 2 humble: it loads libgazebo_ros_diff_drive.so"
    assert result.err.endswith(f"; added 6 elements. Verified ({why})\n")
    assert result.err.count("\n") == 1


def test_quiet_leaves_only_findings(folder: Path) -> None:
    assert run(folder, "rover.urdf", "robot1", "--quiet").err == ""
    found = run(folder, "siblings.urdf", "robot1", "--quiet").err
    assert re.fullmatch(r"siblings\.urdf:\d+:\d+: warning: MB405 .+\n", found)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        pytest.param(("rover.urdf", "robot1"), 0, id="done"),
        pytest.param(
            ("rover.urdf", "robot1", "--fail-on", "warning"), 0, id="fail-on-nothing-found"
        ),
        pytest.param(("siblings.urdf", "robot1"), 0, id="warning"),
        pytest.param(("siblings.urdf", "robot1", "--fail-on", "warning"), 1, id="fail-on-warning"),
        pytest.param(
            ("siblings.urdf", "robot1", "--affix", "prefix", "--fail-on", "warning"),
            0,
            id="no-warning-left",
        ),
        pytest.param(("rover.urdf", "robot1", "--undo"), 1, id="not-rewritten"),
        pytest.param(("nothing.urdf", "robot1"), 2, id="unreadable"),
        pytest.param(("rover.urdf", "robot-1"), 2, id="wrong-use"),
        pytest.param(("--help",), 0, id="help"),
        pytest.param(("--version",), 0, id="version"),
    ],
)
def test_exit_codes_mean_what_the_help_says(
    folder: Path, words: tuple[str, ...], code: int
) -> None:
    result = run(folder, *words)
    assert result.code == code, result.err
    assert bool(result.out) == (code == 0)


def test_a_finding_at_the_level_of_fail_on_writes_nothing(folder: Path) -> None:
    words = ("--fail-on", "warning", "-o", "out.urdf")
    before = contents(folder)
    result = run(folder, "-", "robot1", *words, stdin=(folder / "siblings.urdf").read_bytes())
    assert result.code == 1
    assert result.err.startswith("<stdin>:")
    assert result.err.endswith("--fail-on warning: nothing was written\n")
    assert contents(folder) == before


def test_version_and_help(folder: Path) -> None:
    version = run(folder, "--version").out.decode()
    assert version == f"urdf-postfix {multibot_rewrite.__version__}\n"
    text = run(folder, "--help").out.decode()
    for word in ("examples:", "exit codes:", "--undo", "NAME:=VALUE", "tf-per-robot", "{robot}"):
        assert word in text
    assert max(map(len, text.splitlines())) <= 105


@pytest.mark.parametrize(
    ("env", "colored"), [({}, True), ({"NO_COLOR": "1"}, False)], ids=["color", "NO_COLOR"]
)
def test_color_on_a_terminal(folder: Path, env: dict[str, str], colored: bool) -> None:
    result = run_on_terminal(folder, "siblings.urdf", "robot1", env=env)
    assert result.code == 0
    assert "MB405" in result.err
    assert ("\033[" in result.err) == colored


def test_progress_bar_on_a_terminal_only(folder: Path) -> None:
    robots = [f"r{number}" for number in range(30)]
    words = ("rover.urdf", *robots, "-o", "{robot}.urdf")
    watched = run_on_terminal(folder, *words)
    assert watched.code == 0
    assert "writing" in watched.err
    assert "30 robots" in watched.err
    assert all((folder / f"{robot}.urdf").is_file() for robot in robots)
    piped = run(folder, *words).err
    assert "writing" not in piped
    assert piped.count("\n") == 1


def test_few_robots_need_no_progress_bar(folder: Path) -> None:
    watched = run_on_terminal(folder, "rover.urdf", *TEN, "-o", "{robot}.urdf")
    assert "writing" not in watched.err


# ---------------------------------------------------------------- files


def test_in_place_keeps_the_mode_and_a_reader_keeps_its_text(folder: Path, rover: bytes) -> None:
    target = folder / "rover.urdf"
    target.chmod(0o640)
    wanted = run(folder, "rover.urdf", "robot1").out
    with target.open("rb") as reader:
        assert run(folder, "rover.urdf", "robot1", "--in-place").code == 0
        assert reader.read() == rover
    assert target.read_bytes() == wanted
    assert stat.S_IMODE(target.stat().st_mode) == 0o640
    assert temporaries(folder) == []


def test_in_place_strip_undoes_in_place(folder: Path, rover: bytes) -> None:
    run(folder, "rover.urdf", "robot1", "--in-place")
    assert run(folder, "rover.urdf", "robot1", "--in-place", "--undo").code == 0
    assert (folder / "rover.urdf").read_bytes() == rover


@pytest.mark.parametrize("there", [True, False], ids=["file", "dangling"])
def test_no_link_is_followed(folder: Path, there: bool) -> None:
    (folder / "deep").mkdir()
    target = folder / "deep" / "target.urdf"
    if there:
        target.write_text("old")
    (folder / "link.urdf").symlink_to("deep/target.urdf")
    before = contents(folder)
    result = run(folder, "rover.urdf", "robot1", "-o", "link.urdf")
    assert (result.code, contents(folder)) == (2, before)
    assert f"link.urdf is a link to {target}; name that" in result.err


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(("robot1", "-o", "rover.urdf"), id="same"),
        pytest.param(("robot1", "-o", "./rover.urdf"), id="spelled-differently"),
        pytest.param(("robot1", "-o", "link.urdf"), id="link"),
        pytest.param(("robot1", "rover", "-o", "{robot}.urdf"), id="by-robot-name"),
        pytest.param(("robot1", "--output-kind", "changes", "-o", "rover.urdf"), id="changes"),
    ],
)
def test_the_input_is_never_overwritten(folder: Path, rover: bytes, words: tuple[str, ...]) -> None:
    (folder / "link.urdf").symlink_to("rover.urdf")
    before = contents(folder)
    result = run(folder, "rover.urdf", *words)
    assert result.code == 2
    assert "is the input file" in result.err
    assert contents(folder) == before
    assert (folder / "rover.urdf").read_bytes() == rover


def test_two_results_need_two_files(folder: Path) -> None:
    (folder / "r1.urdf").symlink_to("both.urdf")
    (folder / "r2.urdf").symlink_to("both.urdf")
    before = contents(folder)
    linked = run(folder, "rover.urdf", "r1", "r2", "-o", "{robot}.urdf")
    assert (linked.code, linked.err.count("\n")) == (2, 1)
    assert contents(folder) == before


def test_devices_are_written_through(folder: Path) -> None:
    assert run(folder, "rover.urdf", "robot1", "-o", "/dev/null").code == 0
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
    printed = run(folder, "rover.urdf", "robot1").out
    assert run(folder, "rover.urdf", "robot1", "-o", "/dev/stdout").out == printed


def test_a_pipe_is_written_through(folder: Path) -> None:
    os.mkfifo(folder / "pipe")
    printed = run(folder, "rover.urdf", "robot1").out
    reader = os.open(folder / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    assert run(folder, "rover.urdf", "robot1", "-o", "pipe").code == 0
    assert os.read(reader, 65536) == printed
    os.close(reader)
    assert stat.S_ISFIFO(os.stat(folder / "pipe").st_mode)


def test_an_error_at_robot_seven_of_ten_leaves_nothing(folder: Path) -> None:
    out = folder / "out"
    (out / "r7.urdf").mkdir(parents=True)
    for robot in ("r2", "r9"):
        (out / f"{robot}.urdf").write_text(f"old {robot}")
    before = contents(folder)
    result = run(folder, "rover.urdf", *TEN, "-o", "out/{robot}.urdf")
    assert result.code == 2
    assert result.err.startswith("urdf-postfix: out/r7.urdf: cannot be written: it is a folder")
    assert contents(folder) == before
    assert temporaries(folder) == []


@pytest.mark.parametrize(
    "signal_", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP], ids=lambda s: s.name
)
def test_an_interrupt_leaves_nothing(folder: Path, signal_: signal.Signals) -> None:
    """The last target is a pipe no node reads, so the command waits there with nine files staged."""
    out = folder / "out"
    out.mkdir()
    os.mkfifo(out / "r10.urdf")
    (out / "r1.urdf").write_text("old")
    before = contents(folder)
    words = [*COMMAND, "rover.urdf", *TEN, "-o", "out/{robot}.urdf"]
    with subprocess.Popen(words, cwd=folder, stderr=subprocess.PIPE) as process:
        wait_until(lambda: len(temporaries(out)) == 9 or process.poll() is not None)
        # None of them is in place before all are written.
        assert (out / "r1.urdf").read_text() == "old"
        assert not (out / "r2.urdf").exists()
        process.send_signal(signal_)
        _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert err == b"urdf-postfix: interrupted; no half-written file is left\n"
    assert contents(folder) == before
    assert temporaries(folder) == []


# ---------------------------------------------------------------- streams that are not there


@pytest.mark.parametrize("words", [(), ("--diff",)], ids=["result", "diff"])
def test_a_closed_pipe_is_no_fault(folder: Path, words: tuple[str, ...]) -> None:
    links = "".join(f'<link name="a{number}"/>\n' for number in range(2_000))
    (folder / "big.urdf").write_text(f'<robot name="big">\n{links}</robot>\n')
    line = [*COMMAND, "big.urdf", "robot1", *words]
    with subprocess.Popen(
        line, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.close()
        err = process.stderr.read().decode()
    assert (process.returncode, err) == (141, "")


def test_help_into_a_closed_pipe(folder: Path) -> None:
    line = [*COMMAND, "--help"]
    with subprocess.Popen(
        line, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.close()
        assert b"Traceback" not in process.stderr.read()


@pytest.mark.parametrize(
    ("redirection", "words", "code", "said"),
    [
        pytest.param(">&-", ("rover.urdf", "r1"), 2, "standard output is closed", id="no-stdout"),
        pytest.param(">&-", ("rover.urdf", "r1", "-o", "a"), 0, "Verified", id="no-need-of-stdout"),
        pytest.param("<&-", ("-", "r1"), 2, "standard input is closed", id="no-stdin"),
        pytest.param("2>&-", ("rover.urdf", "r1"), 0, "", id="no-stderr"),
        pytest.param("2>&-", ("siblings.urdf", "r-1"), 2, "", id="no-stderr-to-complain"),
        pytest.param(">/dev/full", ("rover.urdf", "r1"), 2, "No space left", id="disk-full"),
    ],
)
def test_missing_streams(
    folder: Path, redirection: str, words: tuple[str, ...], code: int, said: str
) -> None:
    result = run_shell(folder, redirection, *words)
    assert result.code == code
    assert said in result.err
    assert result.err.count("\n") == bool(said)


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (("rover.urdf", "r1"), 0, False),
        (("rover.urdf", "r1", "--verbose"), 0, True),
        (("rover.urdf", "r1", "-o", "out.urdf"), 0, True),
        (("nowhere.urdf", "r1"), 2, True),
    ],
)
def test_a_program_that_reads_two_pipes_hears_of_failures_alone(
    words: tuple[str, ...], code: int, told: bool, folder: Path
) -> None:
    line = [*COMMAND, *words]
    done = subprocess.run(line, cwd=folder, capture_output=True, check=False, timeout=PATIENCE)
    assert (done.returncode, bool(done.stderr)) == (code, told)
