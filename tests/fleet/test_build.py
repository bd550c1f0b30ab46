# SPDX-License-Identifier: Apache-2.0
"""``multibot build``: what it writes, when it writes nothing, and that it is all or nothing."""

from __future__ import annotations

import contextlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import yaml
from fleet_folder import SMALL, fleet_folder, mixed
from hypothesis import given, strategies as st
from lxml import etree
from plans import PlannedRobot, from_plugin, planned, planned_end

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.cli import folders
from multibot_rewrite.cli.files import write_new
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.sources.release_said import MANIFEST
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.outputs.manifest import NOTE
from multibot_rewrite.fleet.robots.robot_groups import said_once
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.system.json import from_yaml

pytestmark = pytest.mark.slow

COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "build"]
Files = dict[str, bytes]


def held(folder: Path) -> Files:
    """Everything in a folder, by path; links by where they lead."""
    return {
        path.relative_to(folder).as_posix(): os.readlink(path).encode()
        if path.is_symlink()
        else path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_symlink() or path.is_file()
    }


def leftovers(folder: Path) -> list[str]:
    """Return what only a killed build leaves."""
    return [it.name for it in folder.rglob("*") if "multibot-build" in it.name or ".tmp" in it.name]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a fleet that was built once."""
    folder = tmp_path_factory.mktemp("built")
    fleet_folder(folder)
    assert build(folder) == 0
    return folder


@pytest.fixture
def out(built: Path, tmp_path: Path) -> Path:
    """Its output folder, in a copy."""
    shutil.copytree(built, tmp_path, dirs_exist_ok=True, symlinks=True)
    return tmp_path / "out"


def build(folder: Path, *more: str) -> int:
    return main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out"), "--quiet", *more])


def limited(arguments: list[str], limit: Callable[[], None]) -> subprocess.CompletedProcess[str]:
    """Run behind a limit. Python cuts compiled modules there, too, and keeps them for all others."""
    return subprocess.run(
        arguments,
        preexec_fn=limit,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )


def renamed(folder: Path, old: str = "robot2", new: str = "robot3") -> None:
    fleet = folder / "fleet.yaml"
    fleet.write_text(fleet.read_text().replace(old, new))


# ---------------------------------------------------------------- what is written


def test_the_smallest_fleet_gives_everything(out: Path) -> None:
    common = {"plan.yaml", ".system.schema.json", "remappings.yaml", "commands.md", MANIFEST}
    common |= {"fleet.launch.py", "bridge.yaml", "foxglove.json"}
    own = {"robot1/rover.urdf", "robot1/params.yaml", "robot1/start_pose.yaml"}
    assert set(held(out)) == common | own | {
        "robot2/rover.urdf",
        "robot2/params.yaml",
        "one_robot.rviz",
    }


def test_a_policy_of_sros2_is_written_where_it_is_asked_for(tmp_path: Path) -> None:
    """An enclave for each robot, in which the other robot's command topic is nowhere."""
    fleet_folder(tmp_path)
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(f"sros2: true\n{fleet.read_text()}")
    assert build(tmp_path) == 0
    policy = etree.parse(tmp_path / "out" / "policy.xml").getroot()
    text = {it.get("path"): etree.tostring(it).decode() for it in policy.iter("enclave")}
    assert {"/robot1", "/robot2"} <= text.keys()
    assert "robot1" in text["/robot1"]
    assert "robot2" not in text["/robot1"]
    assert "robot1" not in text["/robot2"]


def test_the_manifest_names_what_was_read_and_written(out: Path) -> None:
    data = json.loads((out / MANIFEST).read_text())
    assert set(data["outputs"]) == set(held(out)) - {MANIFEST}
    inputs = {"fleet.yaml", "rover.urdf", "params.yaml", "one_robot.rviz"}
    assert set(data["inputs"]) == {f"../{it}" for it in inputs}


def test_a_second_build_changes_nothing(out: Path) -> None:
    before = {path: path.stat() for path in out.rglob("*")}
    assert build(out.parent) == 0
    after = {path: path.stat() for path in out.rglob("*")}
    assert {it: (s.st_ino, s.st_mtime_ns) for it, s in before.items()} == {
        it: (s.st_ino, s.st_mtime_ns) for it, s in after.items()
    }


def test_a_change_writes_only_what_follows_from_it(out: Path) -> None:
    before = {path: path.stat().st_ino for path in out.rglob("*") if path.is_file()}
    params = out.parent / "params.yaml"
    params.write_text(params.read_text().replace("# of one", "# of any"))
    assert build(out.parent) == 0
    after = {path: path.stat().st_ino for path in out.rglob("*") if path.is_file()}
    changed = {it.relative_to(out).as_posix() for it in after if after[it] != before[it]}
    assert changed == {"robot1/params.yaml", "robot2/params.yaml", MANIFEST}


def test_what_others_put_there_stays(out: Path) -> None:
    (out / "robot2" / "notes.txt").write_text("mine")
    (out / "maps" / "empty").mkdir(parents=True)
    (out / "link").symlink_to("maps")
    os.mkfifo(out / "pipe")
    (out / "robot1").chmod(0o750)
    renamed(out.parent)
    assert build(out.parent) == 0
    assert (out / "robot2" / "notes.txt").read_text() == "mine"
    assert not (out / "robot2" / "params.yaml").exists()
    assert (out / "maps" / "empty").is_dir()
    assert os.readlink(out / "link") == "maps"
    assert (out / "pipe").is_fifo()
    assert (out / "robot1").stat().st_mode & 0o777 == 0o750


@pytest.mark.sample(2)
@pytest.mark.parametrize("more", ["", "x"])
def test_what_was_edited_is_not_overwritten(
    more: str, out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = out / "robot1" / "params.yaml"
    path.write_text(path.read_text() + "# by hand\n")
    before = held(out)
    assert build(out.parent) == 2
    said = capsys.readouterr().err
    assert f"{path}: it was edited since it was built; move it away, or --force" in said
    assert held(out) == before
    assert build(out.parent, "--force") == 0
    assert "by hand" not in path.read_text()


def test_what_no_build_made_is_not_overwritten(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fleet_folder(tmp_path)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "plan.yaml").write_text("mine")
    assert build(tmp_path) == 2
    assert "plan.yaml: no build made it" in capsys.readouterr().err
    assert held(tmp_path / "out") == {"plan.yaml": b"mine"}
    assert build(tmp_path, "--force") == 0


def test_what_was_edited_and_is_no_longer_made_is_not_removed(out: Path) -> None:
    path = out / "robot2" / "params.yaml"
    path.write_text("mine")
    renamed(out.parent)
    assert build(out.parent) == 2
    assert path.read_text() == "mine"


# ---------------------------------------------------------------- --check


def test_check_says_what_is_stale_and_writes_nothing(
    out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert build(out.parent, "--check") == 0
    capsys.readouterr()
    renamed(out.parent)
    before = held(out)
    assert build(out.parent, "--check") == 1
    lines = capsys.readouterr().out.splitlines()
    assert "robot3/params.yaml: stale" in lines
    assert "robot2/params.yaml: left over" in lines
    assert "robot1/params.yaml: stale" not in lines
    assert held(out) == before


# ---------------------------------------------------------------- the same from everywhere


def child(arguments: Sequence[str], cwd: Path, **env: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*COMMAND, *arguments],
        cwd=cwd,
        env={**os.environ, **env},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.sample(2)
@pytest.mark.parametrize("text", [SMALL, mixed()], ids=["small", "mixed"])
def test_the_output_is_the_same_from_everywhere_and_in_any_order(text: str, tmp_path: Path) -> None:
    home, elsewhere = tmp_path / "a", tmp_path / "b" / "c"
    home.mkdir()
    elsewhere.mkdir(parents=True)
    fleet_folder(home, text)
    assert child(["fleet.yaml", "-o", "out1"], home, PYTHONHASHSEED="1").returncode == 0
    far = [str(home / "fleet.yaml"), "-o", str(home / "out2")]
    assert child(far, elsewhere, PYTHONHASHSEED="2").returncode == 0
    assert child(["../../a/fleet.yaml", "-o", "../../a/out3"], elsewhere).returncode == 0
    first = held(home / "out1")
    assert held(home / "out2") == first
    assert held(home / "out3") == first
    assert not any(str(tmp_path).encode() in it for it in first.values())


def test_findings_that_differ_in_their_hints_alone_are_sorted_too(tmp_path: Path) -> None:
    """A set of them has another order in every process."""
    fleet_folder(tmp_path)
    plan = plan_fleet(read_fleet(str(tmp_path / "fleet.yaml"), "", {}))
    found = [Finding("MB853", WARNING, "unknown", hint=f"did you mean {it}?") for it in "abcdefghi"]
    assert said_once(plan, found[::-1]) == found


# ---------------------------------------------------------------- links and folders in the way


def test_a_link_in_the_output_is_not_followed(
    out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outside = out.parent / "outside"
    shutil.move(out / "robot1", outside)
    (out / "robot1").symlink_to(outside)
    before = held(outside)
    renamed(out.parent, "robot1,", "robot1, colour: red,")
    params = out.parent / "params.yaml"
    params.write_text(params.read_text() + "# new\n")
    assert build(out.parent) == 2
    assert "robot1: it is a link, and a build writes nothing elsewhere" in capsys.readouterr().err
    assert held(outside) == before


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("path", "folder", "words"),
    [
        ("out/plan.yaml", True, "plan.yaml: cannot be written: it is a folder"),
        ("out/robot1", False, "robot1 is a file, not a folder"),
        ("out", False, "out: it is a file; name a folder"),
    ],
)
def test_what_prevents_a_pose_or_namespace_is_reported(
    path: str, folder: bool, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fleet_folder(tmp_path)
    place = tmp_path / path
    place.parent.mkdir(exist_ok=True)
    place.mkdir() if folder else place.write_text("mine")
    before = sorted(tmp_path.rglob("*"))
    assert build(tmp_path) == 2
    assert words in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == before


def test_missing_folders_above_are_made_and_go_again_with_a_failure(tmp_path: Path) -> None:
    path = fleet_folder(tmp_path)
    deep = tmp_path / "x" / "y" / "out"
    assert main(["build", str(path), "-o", str(deep), "--quiet"]) == 0
    assert (deep / MANIFEST).exists()
    limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (1000, 1000))
    again = [*COMMAND, str(path), "-o", str(tmp_path / "z" / "out")]
    made = limited(again, limit)
    assert made.returncode == 2
    assert not (tmp_path / "z").exists()


# ---------------------------------------------------------------- all or nothing


@pytest.mark.sample(3)
@pytest.mark.parametrize("room", [0, 1000, 20_000])
def test_no_room_leaves_the_old_files(room: int, out: Path) -> None:
    before = held(out)
    renamed(out.parent)
    limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (room, room))
    arguments = [*COMMAND, str(out.parent / "fleet.yaml"), "-o", str(out)]
    made = limited(arguments, limit)
    assert made.returncode == 2, made.stderr
    reason = "File too large" if room else "No usable temporary directory"
    assert f"cannot be written: {reason}" in made.stderr.splitlines()[-1]
    assert held(out) == before
    assert leftovers(out.parent) == []


@pytest.mark.parametrize("name", ["out", "."])
def test_a_full_disk_leaves_the_old_files(name: str, out: Path) -> None:
    """On a file system of 300 kB, where that can be had; the folder may be the file system."""
    disk = out.parent / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", str(disk)]
    if os.geteuid() or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no right to mount a small file system here")
    try:
        arguments = ["build", str(out.parent / "fleet.yaml"), "-o", str(disk / name), "--quiet"]
        assert main(arguments) == 0
        room = os.statvfs(disk)
        # One page is left, for the first file.
        (disk / "filler").write_bytes(bytes((room.f_bavail - 1) * room.f_frsize))
        before = held(disk / name)
        renamed(out.parent)
        assert main(arguments) == 2
        assert held(disk / name) == before
        assert leftovers(disk) == []
    finally:
        subprocess.run(["umount", str(disk)], check=True)


@pytest.fixture
def one_by_one(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """As where a folder cannot be swapped."""

    def cannot(*_: object) -> None:
        raise folders._CannotSwapError

    monkeypatch.setattr(folders, "_exchange", cannot)
    yield


@pytest.mark.usefixtures("one_by_one")
def test_without_a_swap_the_result_is_the_same(out: Path) -> None:
    renamed(out.parent)
    (out / "mine").write_text("mine")
    assert build(out.parent) == 0
    found = held(out)
    assert found.pop("mine") == b"mine"
    assert leftovers(out.parent) == []
    assert NOTE not in found
    shutil.rmtree(out)
    assert build(out.parent) == 0
    assert held(out) == found


def test_a_build_inside_of_the_folder_does_not_take_it_away(
    out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    renamed(out.parent)
    monkeypatch.chdir(out / "robot1")
    assert build(out.parent) == 0
    assert Path.cwd().samefile(out / "robot1")
    assert (out / "robot3").is_dir()


@pytest.mark.sample(3)
@pytest.mark.usefixtures("one_by_one")
@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
@pytest.mark.parametrize("there", [None, b"of a build that was killed"])
def test_a_failure_without_a_swap_leaves_no_note(
    error: BaseException, there: bytes | None, out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = held(out)
    renamed(out.parent)
    if there is not None:
        (out / NOTE).write_bytes(there)
        monkeypatch.setattr("multibot_rewrite.cli.build.read_manifest", lambda data, *_: {})
    written = []

    def full(path: str, *more: Any) -> None:
        written.append(path)
        # The note is in its place, and some of the files are on the disk.
        if len(written) > 3:
            raise error
        write_new(path, *more)

    monkeypatch.setattr("multibot_rewrite.cli.files.write_new", full)
    assert build(out.parent, "--force") in (2, 130)
    assert len(written) >= 4
    assert held(out) == {**before, **({NOTE: there} if there is not None else {})}
    assert leftovers(out.parent) == []


@pytest.mark.sample(3)
@pytest.mark.parametrize("force", [[], ["--force"]])
@pytest.mark.parametrize("link", [os.symlink, os.link, shutil.move])
def test_a_build_writes_over_nothing_that_it_reads(
    force: list[str],
    link: Callable[[str, str], None],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder = fleet_folder(tmp_path).parent
    assert build(folder) == 0
    target = next((folder / "out" / "robot1").glob("*.urdf"))
    target.unlink()
    given = folder / "rover.urdf"
    if link is shutil.move:
        text = (folder / "fleet.yaml").read_text()
        (folder / "fleet.yaml").write_text(text.replace("rover.urdf", str(target)))
        given.rename(target)
        given = target
    else:
        link(str(given), str(target))
    before = given.read_bytes()
    capsys.readouterr()
    assert build(folder, *force) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert f"{target} is a file that is read; choose another folder for --output" in said
    assert given.read_bytes() == before


@pytest.mark.usefixtures("one_by_one")
def test_half_replaced_files_are_completed_by_the_next_build(
    out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As after a kill between two renames: no file counts as edited by hand."""
    renamed(out.parent)
    shutil.copytree(out, out.parent / "old")
    assert build(out.parent) == 0
    new = held(out)
    shutil.rmtree(out)
    shutil.move(out.parent / "old", out)
    (out / NOTE).write_bytes(new[MANIFEST])
    (out / "plan.yaml").write_bytes(new["plan.yaml"])
    (out / ".urdf-postfix.1.2.tmp").write_text("half")
    renamed(out.parent, "robot3", "robot4")
    monkeypatch.undo()
    assert build(out.parent) == 0
    assert (out / "robot4").is_dir()
    assert NOTE not in held(out)
    assert leftovers(out.parent) == []


def killed(arguments: Sequence[str], number: int, after: float) -> bool:
    """Run a build and send it a signal; tells whether it was still running."""
    process = subprocess.Popen(
        [*COMMAND, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        process.send_signal(number)
        process.wait()
        return True
    return False


def until_killed(out: Path, number: int, runs: int, seed: int) -> int:
    """Kill builds from one state to another and back; after each all files are old or all new."""
    draw = random.Random(seed)
    fleet = out.parent / "fleet.yaml"
    arguments = [str(fleet), "-o", str(out)]
    states: list[Files] = []
    for new in ("robot2", "robot3"):
        renamed(out.parent, "robot2", new)
        assert build(out.parent) == 0
        states.append(held(out))
    start = time.monotonic()
    subprocess.run([*COMMAND, *arguments], capture_output=True, check=True)
    usual = time.monotonic() - start
    hit = 0
    for run in range(runs):
        renamed(out.parent, *(("robot3", "robot2") if run % 2 else ("robot2", "robot3")))
        # Most of the time goes into the start of Python; what matters is the end.
        hit += killed(arguments, number, usual * draw.uniform(0.6, 1.15))
        assert held(out) in states
    assert build(out.parent) == 0
    assert leftovers(out.parent) == []
    return hit


# What kills at once is tried around each step below.
@pytest.mark.parametrize(
    "number", [signal.SIGTERM, pytest.param(signal.SIGKILL, marks=pytest.mark.deep)]
)
def test_a_killed_build_leaves_old_or_new(number: int, out: Path) -> None:
    until_killed(out, number, 2, seed=number)


@pytest.mark.deep
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_many_killed_builds_leave_old_or_new(number: int, out: Path) -> None:
    assert until_killed(out, number, 20, seed=number + 100) > 0


STEPS = ("_link_all", "_write_all", "_exchange", "_bring_late")


@pytest.mark.sample(8)
@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("before", [True, False])
def test_a_kill_around_each_step_leaves_old_or_new(step: str, before: bool, out: Path) -> None:
    """A child that dies right before or behind a step; the next build clears up."""
    code = (
        "import os, signal, sys\n"
        "from multibot_rewrite.cli import folders\n"
        "from multibot_rewrite.cli.multibot import main\n"
        f"real = folders.{step}\n"
        "def dying(*given):\n"
        f"    {'pass' if before else 'real(*given)'}\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
        f"folders.{step} = dying\n"
        "main(sys.argv[1:])\n"
    )
    old = held(out)
    renamed(out.parent)
    arguments = ["build", str(out.parent / "fleet.yaml"), "-o", str(out)]
    died = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, check=False
    )
    assert died.returncode == -signal.SIGKILL
    left = held(out)
    assert build(out.parent) == 0
    new = held(out)
    assert left == (new if (step, before) in DONE else old)
    assert leftovers(out.parent) == []


DONE = {("_exchange", False), ("_bring_late", True), ("_bring_late", False)}


def test_a_failure_at_each_step_leaves_the_old_files(
    out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = held(out)
    renamed(out.parent)
    for step in STEPS[:2]:
        with monkeypatch.context() as patch:
            patch.setattr(folders, step, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt()))
            assert build(out.parent) == 130
        assert held(out) == before
        assert leftovers(out.parent) == []


def test_what_comes_while_a_build_writes_is_kept(
    out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = folders._exchange

    def late(stage: str, folder: str) -> None:
        (Path(folder) / "late").mkdir()
        (Path(folder) / "late" / "bag.mcap").write_text("data")
        real(stage, folder)

    monkeypatch.setattr(folders, "_exchange", late)
    renamed(out.parent)
    assert build(out.parent) == 0
    assert (out / "late" / "bag.mcap").read_text() == "data"


def test_two_builds_at_once_leave_one_whole_output(tmp_path: Path) -> None:
    """Two fleets into one folder, again and again: what is there is one of the two."""
    wanted, fleets = [], []
    for name in ("one", "two"):
        text = SMALL.replace("robot2", name)
        fleets.append(tmp_path / f"{name}.yaml")
        fleet_folder(tmp_path, text).rename(fleets[-1])
        alone = tmp_path / f"alone_{name}"
        assert main(["build", str(fleets[-1]), "-o", str(alone), "--quiet"]) == 0
        wanted.append(held(alone))
    out = tmp_path / "out"
    for _ in range(2):
        running = [
            subprocess.Popen([*COMMAND, str(it), "-o", str(out), "--quiet"]) for it in fleets
        ]
        assert [it.wait() for it in running] == [0, 0]
        assert held(out) in wanted
    assert leftovers(tmp_path) == []


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written_is_reported(
    out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = held(out)
    renamed(out.parent)
    for path in (out / "robot1", out, out.parent):
        path.chmod(0o555)
    try:
        assert build(out.parent) == 2
        assert "cannot be written: Permission denied" in capsys.readouterr().err
        assert held(out) == before
    finally:
        for path in (out.parent, out, out / "robot1"):
            path.chmod(0o755)


def test_a_read_only_folder_is_reported(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """On a file system that was mounted read-only, which stops root, too."""
    renamed(out.parent)
    mounts = [["mount", "--bind", str(out), str(out)], ["mount", "-o", "remount,ro,bind", str(out)]]
    if os.geteuid() or subprocess.run(mounts[0], capture_output=True, check=False).returncode:
        pytest.skip("no right to mount here")
    try:
        before = held(out)
        if subprocess.run(mounts[1], capture_output=True, check=False).returncode:
            pytest.skip("no right to mount read-only here")
        assert build(out.parent) == 2
        said = capsys.readouterr().err.splitlines()[-1]
        assert f"multibot: {out}: cannot be written: Read-only file system" in said
        assert held(out) == before
    finally:
        subprocess.run(["umount", str(out)], check=True)


def test_a_mount_point_is_built_into_file_by_file(out: Path) -> None:
    mount = ["mount", "--bind", str(out), str(out)]
    if os.geteuid() or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no right to mount here")
    try:
        renamed(out.parent)
        assert build(out.parent) == 0
        assert (out / "robot3" / "params.yaml").exists()
        assert not (out / "robot2").exists()
    finally:
        subprocess.run(["umount", str(out)], check=True)


# ---------------------------------------------------------------- the text of plans

WORD = st.text(st.characters(codec="utf-8", exclude_categories=("Cs",)), min_size=1, max_size=12)
ODD = st.one_of(WORD, st.sampled_from(["yes", "y", "~", "null", "1e3", "0x1", "a: b", "- a", "#"]))


@given(ODD, ODD, st.lists(ODD, max_size=3))
def test_any_words_in_a_plan_read_back(word: str, other: str, frames: list[str]) -> None:
    robot = PlannedRobot(word, (f"/{other}",), tuple(frames), "/tf", tag=other)
    end = planned_end(f"/{other}", "topic", "publishes", f"/{word}", other, other)
    plan = planned("both", (robot,), (), (), tuple(frames), (end,))
    plan = from_plugin(plan, f"/{other}", word)
    text = to_yaml(plan)
    with contextlib.suppress(InputError):
        assert from_yaml(text.encode(), "p") == plan
    assert isinstance(yaml.safe_load(text), dict)


# ---------------------------------------------------------------- undo


def test_undo_removes_what_a_build_wrote_and_nothing_else(out: Path) -> None:
    own = out / "robot1" / "notes.txt"
    own.write_text("mine")
    assert build(out.parent, "--undo") == 0
    assert held(out) == {"robot1/notes.txt": b"mine"}
    assert build(out.parent) == 0
    own.unlink()
    assert build(out.parent, "--undo") == 0
    assert not out.exists()


def test_undo_leaves_a_file_that_was_edited(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (out / "plan.yaml").read_bytes()
    (out / "plan.yaml").write_bytes(before + b"# mine\n")
    there = held(out)
    assert build(out.parent, "--undo") == 2
    assert "plan.yaml: it was edited since it was built" in capsys.readouterr().err
    assert held(out) == there
    assert build(out.parent, "--undo", "--force") == 0
    assert not out.exists()


def test_there_is_nothing_to_undo(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    fleet_folder(tmp_path)
    assert build(tmp_path, "--undo") == 2
    assert "so there is nothing to undo" in capsys.readouterr().err


def test_the_fleet_file_and_the_folder_have_defaults(here: Path) -> None:
    fleet_folder(here)
    assert main(["build", "-q"]) == 0
    assert (here / "out" / MANIFEST).exists()
