# SPDX-License-Identifier: Apache-2.0
"""urdf-lint with bad files and dying processes: no traceback, no hang, other files are linted."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from counted_steps import growth
from mutants import SAMPLE, fixtures, mutant, read_all
from paths import FIXTURES
from real_robots import spread
from waiting import wait_until

from multibot_rewrite.base import workers
from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.formats import FORMATS, Report, rendered
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.cli.urdf_lint import main
from multibot_rewrite.cli.walk import find_files
from multibot_rewrite.lint import check
from multibot_rewrite.lint.check import lint_data, lint_file
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.lint.run import FEW, lint_files
from multibot_rewrite.rules.settings import ArgumentSet, Settings

pytestmark = pytest.mark.slow

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
HARMLESS = b'<robot name="r"><link name="a"/></robot>'
TWO_ROOTS = b'<robot name="r">\n<link name="a"/>\n<link name="b"/></robot>'
UNFINISHED = {"MB001", "MB004"}
COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.urdf_lint"]
SECONDS = 0.5


def urdf(body: str) -> bytes:
    return f'<robot name="r">{body}</robot>'.encode()


def xacro(body: str) -> bytes:
    return f'<robot name="r" {XACRO}>{body}</robot>'.encode()


def joint(name: str, parent: str, child: str, more: str = "", type_: str = "fixed") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{type_}">{ends}{more}</joint>'


def chain(count: int) -> bytes:
    links = "".join(f'<link name="l{at}"/>' for at in range(count))
    return urdf(links + "".join(joint(f"j{at}", f"l{at}", f"l{at + 1}") for at in range(count - 1)))


def bomb(levels: int) -> bytes:
    """Macros of which each calls the one below twice."""
    macros = '<xacro:macro name="m0"><link name="x"/></xacro:macro>'
    for at in range(levels):
        call = f"<xacro:m{at}/>"
        macros += f'<xacro:macro name="m{at + 1}">{call}{call}</xacro:macro>'
    return xacro(f"{macros}<xacro:m{levels}/>")


LIMITS = '<limit effort="{0}" velocity="{0}" lower="{0}" upper="{0}"/>'
MANY = " ".join(f'a{at}=""' for at in range(2000))
LOOP = '<link name="a"/><link name="b"/>' + joint("j", "a", "b") + joint("k", "b", "a")
MACRO = '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>'
X_OF_Y = '<xacro:property name="x" value="${y}"/><xacro:property name="y" value="${x}"/>'
# File name -> content and the codes that have to be among what is found.
BAD: dict[str, tuple[bytes, set[str]]] = {
    "empty.urdf": (b"", {"MB101"}),
    "blank.urdf": (b" \n\t", {"MB101"}),
    "no_xml.urdf": (b"robot: r", {"MB101"}),
    "cut_short.urdf": (TWO_ROOTS[:30], {"MB101"}),
    "other_root.urdf": (b"<model/>", {"MB101"}),
    "a_namespace.urdf": (b'<robot name="r" xmlns="http://ros.org"/>', {"MB146"}),
    "utf16.urdf": (TWO_ROOTS.decode().encode("utf-16"), {"MB101"}),
    "latin1.urdf": ('<robot name="é"/>'.encode("latin-1"), {"MB101"}),
    "null.urdf": (b'<robot name="r\0"/>', {"MB101"}),
    "entities.urdf": (b"<!DOCTYPE robot [<!ENTITY a 'b'>]><robot name='&a;'/>", {"MB101"}),
    "mesh.urdf": (b"solid mesh\n" * 2_000_000, {"MB102"}),
    "big.urdf": (urdf('<link name="a"/>' + f"<!--{'.' * 1000}-->" * 10_000), set()),
    "deep.urdf": (urdf("<a>" * 20_000 + "</a>" * 20_000), {"MB101"}),
    "nested.urdf": (urdf('<link name="a"/>' + "<gazebo>" * 200 + "</gazebo>" * 200), set()),
    "loop.urdf": (urdf(LOOP), {"MB503"}),
    "itself.urdf": (urdf('<link name="a"/>' + joint("j", "a", "a")), {"MB506"}),
    "nan.urdf": (urdf('<link name="a"><inertial><mass value="nan"/></inertial></link>'), {"MB120"}),
    "huge.urdf": (
        urdf(
            '<link name="a"/><link name="b"/>'
            + joint("j", "a", "b", LIMITS.format("1e400"), "revolute")
        ),
        {"MB120"},
    ),
    "digits.urdf": (
        urdf(f'<link name="a"><inertial><mass value="{"9" * 5000}"/></inertial></link>'),
        {"MB120"},
    ),
    "1200_links.urdf": (chain(1200), set()),
    "one_name.urdf": (urdf('<link name="a"/>' * 1000), {"MB201"}),
    "names.urdf": (urdf("".join(f'<link name="{"a" * at}"/>' for at in range(1000))), {"MB501"}),
    "attributes.urdf": (urdf(f'<link name="a" {MANY}/>'), set()),
    "new\nline.urdf": (TWO_ROOTS, {"MB501"}),
    "\udcff.urdf": (TWO_ROOTS, {"MB501"}),
    "undefined.xacro": (xacro('<link name="${x}"/>'), {"MB103"}),
    "circle.xacro": (xacro(X_OF_Y + '<link name="${x}"/>'), {"MB103"}),
    "recursion.xacro": (xacro(MACRO), {"MB103"}),
    "itself.xacro": (xacro('<xacro:include filename="itself.xacro"/>'), {"MB103"}),
    "nowhere.xacro": (xacro('<xacro:include filename="no/such"/><link name="a"/>'), {"MB102"}),
    "outside.xacro": (xacro('<xacro:include filename="/no/such"/><link name="a"/>'), {"MB103"}),
    "a_folder.xacro": (xacro('<xacro:include filename="."/><link name="a"/>'), {"MB102"}),
    "not_utf8.xacro": (xacro("é").decode().encode("latin-1"), {"MB101"}),
    "memory.xacro": (xacro("<link name=\"${len('a' * 10**10)}\"/>"), {"MB103"}),
    "power.xacro": (xacro('<link name="${9**9**9}"/>'), {"MB004"}),
    "endless.xacro": (
        xacro('<link name="${len([i for i in range(10**12) if i == 1])}"/>'),
        {"MB004"},
    ),
    "bomb.xacro": (bomb(40), {"MB004"}),
}
LINKS = {"dead.urdf": "nowhere", "circle.urdf": "circle.urdf", "no_text.urdf": "/proc/self/mem"}


@pytest.fixture(scope="module")
def bad(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder of bad files, pipes and links, and a file with a finding behind them all."""
    home = tmp_path_factory.mktemp("bad")
    for name, (data, _) in BAD.items():
        (home / name).write_bytes(data)
    for name, target in LINKS.items():
        (home / name).symlink_to(target)
    (home / "around").symlink_to(".")
    (home / "folder.urdf").mkdir()
    (home / "folder.urdf" / "in.urdf").write_bytes(TWO_ROOTS)
    os.mkfifo(home / "pipe.urdf")
    os.mkfifo(home / "pipe.xacro")
    (home / "zz.urdf").write_bytes(TWO_ROOTS)
    return home


def codes(found: list[Finding]) -> dict[str, set[str]]:
    """Return the codes of each file, by the path below its folder."""
    result: dict[str, set[str]] = {}
    for it in found:
        result.setdefault(Path(it.file).name, set()).add(it.code)
    return result


@pytest.fixture(scope="module")
def found(bad: Path) -> list[Finding]:
    paths = find_files([str(bad)], (".urdf", ".xacro")).files
    assert not any("pipe" in path for path in paths)
    endless = [path for path in paths if "MB004" in BAD.get(Path(path).name, (b"", set()))[1]]
    others = [path for path in paths if path not in endless]
    found = lint_files(others, Settings(), jobs=2)
    # That this comes to an end is what is tested; without a limit none of them does.
    return found + lint_files(endless, Settings(seconds=SECONDS), jobs=3)


def test_endless_files_are_ended(found: list[Finding]) -> None:
    wanted = {name for name, (_, codes) in BAD.items() if "MB004" in codes}
    assert {Path(it.file).name for it in found if it.code == "MB004"} == wanted


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_told(found: list[Finding], name: str) -> None:
    reported = codes(found).get(name, set())
    assert reported >= BAD[name][1]
    assert reported & UNFINISHED <= BAD[name][1]


def test_what_is_no_file_is_told_and_the_others_are_linted(
    found: list[Finding],
) -> None:
    reported = codes(found)
    assert [reported[name] for name in LINKS] == [{"MB102"}] * len(LINKS)
    assert "MB501" in reported["in.urdf"] & reported["zz.urdf"]


@pytest.mark.parametrize("form", FORMATS)
def test_every_format_tells_all_of_it(found: list[Finding], form: str, bad: Path) -> None:
    text = rendered(form, found, Report("urdf-lint", [str(bad / name) for name in BAD], RULES))
    text.encode()
    assert "Traceback" not in text


@pytest.mark.parametrize("name", ["pipe.urdf", "pipe.xacro"])
def test_a_pipe_that_nobody_writes_to(bad: Path, name: str) -> None:
    (reported,) = lint_files([str(bad / name)], Settings(seconds=SECONDS))
    assert reported.code == "MB102"


def test_a_device_without_end() -> None:
    (reported,) = lint_files(["/dev/zero"], Settings())
    assert reported.code == "MB102"


def test_a_file_that_is_gone_before_it_is_read(tmp_path: Path) -> None:
    (reported,) = lint_files([str(tmp_path / "gone.urdf")], Settings())
    assert reported.code == "MB102"


def test_a_file_that_changes_while_it_is_read(tmp_path: Path) -> None:
    """What is found is of one of its states, or that it cannot be read."""
    part, whole = tmp_path / "part.xacro", tmp_path / "whole.xacro"
    whole.write_bytes(xacro('<xacro:include filename="part.xacro"/><link name="a"/>'))
    states = [xacro("\n" * at + '<link name="a"/>' * at) for at in range(5)] + [b"<robot"]
    stop = threading.Event()

    def change() -> None:
        while not stop.is_set():
            part.write_bytes(random.choice(states))

    writer = threading.Thread(target=change)
    writer.start()
    try:
        for _ in range(60):
            reported = lint_file(str(whole), Settings())
            assert {it.code for it in reported}.isdisjoint(UNFINISHED)
    finally:
        stop.set()
        writer.join()


# ---------------------------------------------------------------- crashes, killed processes


def fallen(how: Callable[[], object], monkeypatch: pytest.MonkeyPatch) -> None:
    """Linting a file called fallen.* ends like this."""

    def lint(path: str, settings: Settings) -> list[Finding]:
        if "fallen" in path:
            how()
        return lint_file(path, settings)

    monkeypatch.setattr(check, "lint_file", lint)


@pytest.fixture
def several(tmp_path: Path) -> Iterator[Path]:
    for at in range(FEW + 4):
        (tmp_path / f"{at:02}.urdf").write_bytes(TWO_ROOTS)
    for name in ("05_fallen", "09_fallen"):
        (tmp_path / f"{name}.urdf").write_bytes(TWO_ROOTS)
    yield tmp_path


@pytest.mark.sample(4)
@pytest.mark.parametrize("jobs", [1, 2, 4])
@pytest.mark.parametrize(
    ("how", "said"),
    [
        (lambda: os.kill(os.getpid(), signal.SIGKILL), "ended by SIGKILL"),
        (lambda: os.kill(os.getpid(), signal.SIGUSR1), "ended by SIGUSR1"),
        (lambda: os._exit(0), "ended before it was done"),
        (lambda: sys.exit(0), "ended before it was done"),
    ],
    ids=["kill", "usr1", "exit", "system-exit"],
)
def test_a_killed_worker_is_an_error_and_no_pass(
    how: Callable[[], object],
    said: str,
    jobs: int,
    several: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    fallen(how, monkeypatch)
    monkeypatch.setattr(workers, "processors", lambda: jobs)
    # A xacro file among them: it is never linted in the process that has to go on.
    (several / "10.xacro").write_bytes(xacro('<link name="a"/>'))
    assert main([str(several), "--select", "MB501", "--quiet"]) == 2
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in lines if "MB001" in line and said in line] == [
        line for line in lines if "fallen" in line
    ]
    assert sum("fallen" in line for line in lines) == 2
    assert sum("MB501" in line for line in lines) == FEW + 4


def test_a_rule_that_crashes_is_an_error_and_no_pass(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def crash(*_: object) -> None:
        raise MemoryError

    (tmp_path / "a.urdf").write_bytes(HARMLESS)
    monkeypatch.setattr("multibot_rewrite.lint.check.read_subjects", crash)
    assert main([str(tmp_path)]) == 2
    assert "MB001" in capsys.readouterr().out


# ---------------------------------------------------------------- interrupts


def endless(folder: Path, count: int = 8) -> Path:
    for at in range(count):
        loop = '<link name="${len([i for i in range(10**12) if i == 1])}"/>'
        (folder / f"{at}.xacro").write_bytes(xacro(loop))
    (folder / "urdf-lint.toml").write_text("seconds = 30\n")
    return folder


def started(folder: Path) -> subprocess.Popen[str]:
    """Return a lint in a session of its own, with its workers at work."""
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    lint = subprocess.Popen([*COMMAND, "."], cwd=folder, start_new_session=True, **streams)
    wait_until(lambda: len(members(lint.pid)) >= 2)
    time.sleep(0.2)
    return lint


def members(group: int) -> list[int]:
    """Return the processes of a group that have not ended."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[2]) == group and fields[0] != "Z":
            found.append(int(stat.parent.name))
    return found


@pytest.mark.parametrize("everybody", [True, False], ids=["group", "parent"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_all_processes(
    tmp_path: Path, number: signal.Signals, everybody: bool
) -> None:
    lint = started(endless(tmp_path))
    (os.killpg if everybody else os.kill)(lint.pid, number)
    out, err = lint.communicate(timeout=10)
    assert (lint.returncode, out) == (130, "")
    assert err == "urdf-lint: interrupted; no half-written file is left\n"
    wait_until(lambda: not members(lint.pid))


def test_workers_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    folder = endless(tmp_path)
    (folder / "urdf-lint.toml").write_text("seconds = 2\n")
    lint = started(folder)
    os.kill(lint.pid, signal.SIGKILL)
    lint.communicate(timeout=10)
    wait_until(lambda: not members(lint.pid))


# ---------------------------------------------------------------- many files


def many(folder: Path, count: int) -> list[str]:
    paths = [folder / f"{at % 20}" / f"{at:05}.urdf" for at in range(count)]
    for at in range(20):
        (folder / f"{at}").mkdir()
    for path in paths:
        path.write_bytes(TWO_ROOTS)
    return [str(path) for path in paths]


def test_a_folder_of_hundreds_of_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    many(tmp_path, 500)
    assert main([str(tmp_path), "--select", "MB501"]) == 1
    out, err = capsys.readouterr()
    assert len(out.splitlines()) == 500
    assert err.startswith("urdf-lint: 500 files: 500 errors")


@pytest.mark.deep
def test_a_folder_of_ten_thousand_files(tmp_path: Path) -> None:
    paths = many(tmp_path, 10_000)
    found = lint_files(paths, Settings(select=("MB501",)))
    assert [it.file for it in found] == paths


def test_the_cost_of_many_files_grows_with_their_number_and_not_faster(tmp_path: Path) -> None:
    paths = many(tmp_path, 400)

    def prepared(count: int) -> Callable[[], object]:
        return lambda: lint_files(paths[:count], Settings(select=("MB501",)), jobs=1)

    assert growth(prepared, 100, 400) < 1.5


# ---------------------------------------------------------------- damaged files

ROBOTS = ("robot1", "robot2")
FEW_MUTANTS, MANY_MUTANTS = 300, 2_000


def hunt(sources: list[bytes], seeds: range) -> int:
    """How many findings there are; AssertionError where one is out of its file or a rule fell."""
    settings = Settings(robots=ROBOTS, naming=make_naming("L2"), targets=("mjcf",))
    total = 0
    for seed in seeds:
        data = mutant(seed, sources)
        lines = data.split(b"\n")
        for it in lint_data("robot.urdf", data, settings):
            assert it.code not in UNFINISHED, f"seed {seed}: {it.message}"
            assert 1 <= it.line <= len(lines), f"seed {seed}: {it}"
            width = len(lines[it.line - 1].decode("utf-8", "replace"))
            assert 1 <= it.column <= width + 1, f"seed {seed}: {it}"
            total += 1
    return total


def test_mutants_of_fixtures() -> None:
    assert hunt(fixtures(), range(FEW_MUTANTS // 2)) > FEW_MUTANTS


def test_mutants_of_real_files(corpus: dict[str, Path]) -> None:
    hunt(read_all(spread(corpus, SAMPLE)), range(FEW_MUTANTS // 2, FEW_MUTANTS))


@pytest.mark.deep
@pytest.mark.parametrize("part", range(4))
def test_many_mutants(corpus: dict[str, Path], part: int) -> None:
    start = 50_000 + part * (MANY_MUTANTS // 4)
    sources = [*fixtures(), *read_all(spread(corpus, 4 * SAMPLE))]
    hunt(sources, range(start, start + MANY_MUTANTS // 4))


# ---------------------------------------------------------------- workers


@pytest.fixture(scope="module")
def by_jobs() -> list[list[Finding]]:
    homes = [str(FIXTURES / "robots"), str(FIXTURES / "lint")]
    paths = find_files(homes, (".urdf", ".xacro", ".srdf"), everything=True).files
    settings = Settings(arguments=(ArgumentSet("*", (("sim", "gz"),)),))
    return [lint_files(paths, settings, jobs=jobs) for jobs in (1, 2, 4)]


@pytest.mark.parametrize(
    ("quota", "many"),
    [
        ("max 100000", 8),
        ("200000 100000", 2),
        ("150000 100000", 2),
        ("50000 100000", 1),
        ("9900000 100000", 8),
        (None, 8),
    ],
)
def test_a_container_has_as_many_workers_as_its_quota(
    quota: str | None, many: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if quota is not None:
        (tmp_path / "cpu.max").write_text(f"{quota}\n")
    monkeypatch.setattr(workers, "QUOTA", str(tmp_path / "cpu.max"))
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(8)))
    assert workers.processors() == many


@pytest.mark.sample(4)
@pytest.mark.parametrize("form", FORMATS)
def test_the_number_of_workers_changes_no_byte(form: str, by_jobs: list[list[Finding]]) -> None:
    report = Report("urdf-lint", ["a.urdf"], RULES)
    results = [rendered(form, found, report).encode() for found in by_jobs]
    assert results[0].count(b"MB") > 20
    assert results[0] == results[1] == results[2]


@pytest.mark.deep
def test_of_the_corpus_neither(
    corpus: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = str(next(iter(corpus.values())).parents[1])
    for jobs in (1, 4):
        monkeypatch.setattr(workers, "processors", lambda jobs=jobs: jobs)
        target = str(tmp_path / str(jobs))
        assert main([home, "--format", "json", "--output", target]) == 1
    one, four = ((tmp_path / jobs).read_bytes() for jobs in ("1", "4"))
    assert one == four


def test_a_joint_to_itself_beside_another_is_one_error(tmp_path: Path) -> None:
    """It makes no loop of two links, so the tree of the other joints is as it was."""
    path = tmp_path / "a.urdf"
    both = joint("j", "a", "b") + joint("k", "b", "b")
    path.write_bytes(urdf('<link name="a"/><link name="b"/>' + both))
    assert {it.code for it in lint_file(str(path), Settings()) if it.level == ERROR} == {"MB506"}
