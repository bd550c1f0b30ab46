# SPDX-License-Identifier: Apache-2.0
"""The cache of urdf-lint: never another result than without it, however little changed."""

from __future__ import annotations

import ast
import builtins
import json
import os
import re
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from no_workers import lint_in_this_process

from multibot_rewrite.base import outside
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.cli.urdf_lint import main
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources import packages
from multibot_rewrite.description.sources.known_arguments import KnownArguments
from multibot_rewrite.lint.cache import cache as caches
from multibot_rewrite.lint.cache.cache import Cache, cache_folder, identity
from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import ArgumentSet, Settings

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ARM = f"""<robot name="arm" {XACRO}>
  <xacro:include filename="$(find arm_description)/urdf/parts.xacro"/>
  <xacro:part name="$(optenv ROS_ARM left)"/>
  <xacro:property name="sizes" value="${{xacro.load_yaml('sizes.yaml')}}"/>
  <link name="hand_${{sizes['hand']}}"/>
  <link name="spare"/>
  <joint name="wrist" type="fixed"><parent link="left"/><child link="hand_1"/></joint>
</robot>
"""
PARTS = f"""<robot {XACRO}><xacro:macro name="part" params="name"><link name="${{name}}">
  <visual><geometry><mesh filename="package://meshes/base.stl"/></geometry></visual>
</link></xacro:macro></robot>
"""
# A collision that is as far from the mesh as the mesh says.
FAR_OFF = """<robot name="far"><link name="a">
  <visual><geometry><mesh filename="package://meshes/cover.dae"/></geometry></visual>
  <collision><geometry><box size="1 1 1"/></geometry></collision>
</link></robot>
"""
COVER = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"><library_geometries>
<geometry id="g"><mesh><source id="at"><float_array>0 0 0 1 1 1</float_array></source>
<vertices><input semantic="POSITION" source="#at"/></vertices></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node>
<translate>0 0 0</translate><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""
PLAIN = '<robot name="plain"><link name="a"/></robot>\n'
MARKED = "\ufeff" + PLAIN
GROUP = '<robot name="plain"><group name="g"><link name="a"/></group></robot>'
LOST = "<package><name>lost</name></package>"
FILES = {
    "arm_description/package.xml": "<package><name>arm_description</name></package>",
    "arm_description/urdf/arm.urdf.xacro": ARM,
    "arm_description/urdf/parts.xacro": PARTS,
    "arm_description/urdf/sizes.yaml": "hand: 1\n",
    "arm_description/urdf/plain.urdf": PLAIN,
    "arm_description/urdf/arm.srdf": GROUP,
    "meshes/package.xml": "<package><name>meshes</name></package>",
    "meshes/base.stl": "solid",
    "meshes/cover.dae": COVER,
    "arm_description/urdf/far.urdf": FAR_OFF,
    "extra.vocab": "",
}
SOURCES = tuple(
    f"arm_description/urdf/{it}"
    for it in ("arm.urdf.xacro", "parts.xacro", "plain.urdf", "arm.srdf", "far.urdf")
)
SETTINGS = Settings(roots=("meshes", "arm_description"), readable=("meshes", "arm_description"))


# With the workers that a user has.
WITH_WORKERS = ("test_nothing_is_linted_twice", "test_two_runs_at_once_do_not_disturb_each_other")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Path:
    """Return the robot in a working directory, with a cache of its own."""
    if request.node.name not in WITH_WORKERS:
        lint_in_this_process(monkeypatch)
    for name, text in FILES.items():
        write(tmp_path / "ws" / name, text)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    for name in ("ROS_ARM", "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path / "ws")
    return tmp_path / "ws"


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def forget() -> None:
    """Forget all that was read, as a new process has read nothing yet."""
    for it in (packages.entries.__wrapped__, packages._candidate_folders, packages._own_package):
        it.cache_clear()
    packages.packages_below.cache_clear()
    packages._by_lower_case.cache_clear()


def linted(settings: Settings = SETTINGS, paths: tuple[str, ...] = SOURCES) -> list[Finding]:
    """Without a cache."""
    forget()
    return lint_files(paths, settings)


def again(
    settings: Settings = SETTINGS, paths: tuple[str, ...] = SOURCES
) -> tuple[list[Finding], int]:
    """With the cache, as a new process: the findings, and how many results are new."""
    forget()
    cache = Cache(cache_folder(), identity(settings))
    found = lint_files(paths, settings, cache=cache)
    cache.save()
    return found, sum(map(len, cache.changed.values()))


@pytest.mark.slow
def test_nothing_is_linted_twice(here: Path) -> None:
    first, new = again()
    assert new == len(SOURCES) + 1, "each file, and what they know of each other"
    assert again() == (first, 0)
    assert first == linted()
    assert {it.code for it in first}, "there is something to keep"


@pytest.mark.more
def test_a_name_beside_is_asked_for_but_not_what_nobody_looks_at(here: Path) -> None:
    again()
    write(here / "arm_description/urdf/notes.txt", "nothing")
    write(here / "other/deep/file.urdf", "<robot/>")
    os.utime(here / SOURCES[0])
    assert again()[0] == linted()


CHANGES: dict[str, Callable[[Path], object]] = {
    "the file": lambda at: write(at / SOURCES[2], PLAIN.replace("/>", '/><link name="c"/>')),
    "an include": lambda at: write(at / SOURCES[1], PARTS.replace("${name}", "x_${name}")),
    "an include is gone": lambda at: (at / SOURCES[1]).unlink(),
    "a mesh is gone": lambda at: (at / "meshes/base.stl").unlink(),
    "a mesh is elsewhere": lambda at: write(
        at / "meshes/cover.dae", COVER.replace("0 0 0</tr", "0 0 9</tr")
    ),
    "a mesh is renamed": lambda at: (at / "meshes/base.stl").rename(at / "meshes/Base.STL"),
    "a package is gone": lambda at: write(at / "meshes/package.xml", LOST),
    "what load_yaml reads": lambda at: write(at / "arm_description/urdf/sizes.yaml", "hand: 2\n"),
    "the SRDF's URDF": lambda at: write(at / SOURCES[2], PLAIN.replace('"a"', '"z"')),
    "another robot in it": lambda at: write(at / SOURCES[2], PLAIN.replace("plain", "other")),
}


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("change", CHANGES)
def test_what_changed_is_noticed(here: Path, change: str) -> None:
    before, _ = again()
    old = {path: os.stat(path) for path in SOURCES}
    CHANGES[change](here)
    # A copy that keeps the times of the file is another file all the same.
    for path, state in old.items():
        if os.path.exists(path):
            os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))
    found, new = again()
    assert found == linted()
    assert found != before, "the change is one that makes a difference"
    assert new


@pytest.mark.more
def test_a_replaced_file_of_the_same_size_and_time_is_noticed(here: Path) -> None:
    path = here / SOURCES[2]
    before, _ = again()
    state = path.stat()
    write(here / "new", '<robot name="plain"><link name="b"/></robot>\n')
    os.utime(here / "new", ns=(state.st_atime_ns, state.st_mtime_ns))
    os.replace(here / "new", path)
    found, _ = again()
    assert found == linted() != before


ENVIRONMENTS = {
    "$(optenv)": ("ROS_ARM", "right"),
    "ROS_PACKAGE_PATH": ("ROS_PACKAGE_PATH", "elsewhere"),
    "AMENT_PREFIX_PATH": ("AMENT_PREFIX_PATH", "install"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_the_environment_is_noticed(here: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    # A package that is in neither root, only where the variable says.
    alone = Settings(roots=("arm_description",), readable=("arm_description",))
    for folder in ("elsewhere/far/meshes", "install/share/meshes"):
        write(here / folder / "package.xml", "<package><name>meshes</name></package>")
    (here / "meshes/package.xml").unlink()
    (here / "meshes/base.stl").unlink()
    before, _ = again(alone)
    variable, value = ENVIRONMENTS[name]
    monkeypatch.setenv(variable, value if variable == "ROS_ARM" else str(here / value))
    found, _ = again(alone)
    assert found == linted(alone) != before
    monkeypatch.delenv(variable)
    assert again(alone)[0] == before


OTHERS = {
    "select": SETTINGS._replace(select=("MB5",)),
    "levels": SETTINGS._replace(levels={"MB702": "error", "MB501": "note", "MB5": "warning"}),
    "arguments": SETTINGS._replace(arguments=(ArgumentSet("*", (("side", "right"),)),)),
    "robots": SETTINGS._replace(robots=("one", "two")),
    "release": SETTINGS._replace(distro="humble"),
    "roots": SETTINGS._replace(roots=()),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", OTHERS)
def test_other_settings_are_other_results(here: Path, what: str) -> None:
    again()
    found, new = again(OTHERS[what])
    assert found == linted(OTHERS[what])
    assert new > 0


def test_a_definitions_is_part_of_it(here: Path) -> None:
    row = "[plugin libacme.so]\nframe uses link\n"
    with_one = SETTINGS._replace(definitions=("extra.vocab",))
    assert identity(with_one) == identity(with_one) != identity(SETTINGS)
    before = identity(with_one)
    write(here / "extra.vocab", row)
    assert identity(with_one) != before


@pytest.mark.more
def test_a_file_among_others_is_not_that_file_alone(here: Path) -> None:
    """parts.xacro is included by another one, unless it is linted alone."""
    again()
    for paths in (SOURCES[1:2], SOURCES[:2], SOURCES[2:], SOURCES[3:]):
        assert again(paths=paths)[0] == linted(paths=paths)


@pytest.mark.more
def test_an_included_file_is_another_one_alone(here: Path) -> None:
    write(here / "two.xacro", f'<robot name="r" {XACRO}><link name="a"/><link name="b"/></robot>')
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    include = '<xacro:include filename="two.xacro"/>'
    write(here / "whole.urdf.xacro", f'<robot name="r" {XACRO}>{include}{joint}</robot>')
    together, alone = ("two.xacro", "whole.urdf.xacro"), ("two.xacro",)
    assert not {"MB501"} & {it.code for it in again(paths=together)[0]}
    assert {"MB501"} <= {it.code for it in again(paths=alone)[0]}
    assert again(paths=together)[0] == linted(paths=together)


def test_runs_over_parts_of_a_folder_add_up(here: Path) -> None:
    again(paths=SOURCES[2:3])
    again(paths=SOURCES[3:4])
    assert again(paths=SOURCES[2:3])[1] == again(paths=SOURCES[3:4])[1] == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: data[:-7],
        lambda data: data.replace(b"MB", b"MC", 1),
        lambda data: b"{" * 10_000,
        lambda data: os.urandom(2000),
        lambda data: _signed(b"[]"),
        lambda data: _signed(b'[[["os:system",["touch hacked"],[],""]],{"k":[[],[0]]}]'),
        lambda data: _signed(b"[" * 5000 + b"]" * 5000),
    ],
)
def test_a_damaged_cache_is_none(here: Path, damage: Callable[[bytes], bytes]) -> None:
    before, _ = again()
    for path in Path(cache_folder()).iterdir():
        path.write_bytes(damage(path.read_bytes()))
    assert again()[0] == before
    assert again() == (before, 0), "it is written anew"
    assert not (here / "hacked").exists()


def _signed(body: bytes) -> bytes:
    return f"{outside.digest(body)}\n".encode() + body


def test_only_marked_functions_are_asked() -> None:
    for function in (
        "os:system",
        "multibot_rewrite.base.bounded:re.match",
        "multibot_rewrite.base.model:Edit",
    ):
        with pytest.raises(LookupError):
            outside.answer_now(outside.Question(function, ("x",)))


@pytest.mark.slow
def test_what_rests_on_time_is_not_kept(here: Path) -> None:
    write(here / "slow.urdf.xacro", f'<robot name="s" {XACRO}><link name="${{9**9**9}}"/></robot>')
    short = SETTINGS._replace(seconds=0.2)
    found, new = again(short, ("slow.urdf.xacro",))
    assert [it.code for it in found if it.level == "error"]
    assert new == 1, "only what the files of its package include"


# ---------------------------------------------------------------- the folder, and others that use it


def command(*words: str) -> subprocess.CompletedProcess[str]:
    line = [sys.executable, "-m", "multibot_rewrite.cli.urdf_lint", *words]
    return subprocess.run(line, capture_output=True, text=True, check=False)


FOLDERS: dict[str, Callable[[Path], object]] = {
    "a file is in its place": lambda at: write(at, "x"),
    "a dead link": lambda at: at.symlink_to("/nowhere/at/all"),
    "no device": lambda at: at.symlink_to("/dev/null"),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("fault", FOLDERS)
def test_a_folder_that_cannot_be_written_is_no_error(
    here: Path, capsys: pytest.CaptureFixture[str], fault: str
) -> None:
    FOLDERS[fault](here.parent / "cache")
    assert main([SOURCES[2]]) == 0
    assert "no findings" in capsys.readouterr().err
    assert main([SOURCES[2], "--verbose"]) == 0
    assert "the cache is not kept" in capsys.readouterr().err


@pytest.mark.more
def test_a_full_disk_leaves_nothing(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before, _ = again()
    write(here / SOURCES[2], '<robot name="plain"><link name="b"/></robot>')
    real = builtins.open

    def full(path: Any, mode: str = "r", *more: Any, **named: Any) -> Any:
        file = real(path, mode, *more, **named)
        if mode == "wb":
            file.close()
            raise OSError(28, "No space left on device")
        return file

    monkeypatch.setattr(builtins, "open", full)
    with pytest.raises(OSError, match="No space"):
        again()
    monkeypatch.setattr(builtins, "open", real)
    assert all(it.suffix == ".json" for it in Path(cache_folder()).iterdir())
    assert again()[0] == linted() != before


def test_a_relative_cache_home_is_not_valid(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "here")
    monkeypatch.setenv("HOME", "/home/someone")
    assert cache_folder() == "/home/someone/.cache/multibot_rewrite/lint"


@pytest.mark.slow
def test_two_runs_at_once_do_not_disturb_each_other(here: Path) -> None:
    expected = linted()
    wrong: list[object] = []

    def run(number: int) -> None:
        for _ in range(2):
            cache = Cache(cache_folder(), identity(SETTINGS))
            paths = SOURCES if number % 2 else SOURCES[::-1]
            found = lint_files(paths, SETTINGS, cache=cache)
            cache.save()
            if sorted(found) != sorted(expected):
                wrong.append(found)

    threads = [threading.Thread(target=run, args=(it,)) for it in range(2)]
    for it in threads:
        it.start()
    for it in threads:
        it.join()
    assert not wrong
    assert again()[0] == expected


def test_it_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(caches, "MOST_FILES", 10)
    for number in range(11):
        write(tmp_path / str(number), "x" * 100)
        os.utime(tmp_path / str(number), (number, number))
    caches.bound(str(tmp_path))
    assert sorted(int(it.name) for it in tmp_path.iterdir()) == [6, 7, 8, 9, 10]
    monkeypatch.setattr(caches, "MOST_IN_ALL", 400)
    caches.bound(str(tmp_path))
    assert sorted(int(it.name) for it in tmp_path.iterdir()) == [9, 10]


def test_a_file_of_the_cache_is_bounded(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(caches, "MOST_BYTES", 10)
    again()
    assert not os.path.exists(cache_folder())


# ---------------------------------------------------------------- the key is complete

LOOKS = ("stat", "lstat", "readlink", "listdir", "scandir", "access")
# Program text, and what Python itself asks.
OWN = (
    sys.prefix,
    sys.base_prefix,
    str(Path(outside.__file__).parent.parent),
    "/proc",
    "/dev",
    "/sys",
)


@pytest.fixture
def unnoted(here: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Yield what the lint of the robot asks the disk outside of functions that are noted."""
    found: list[str] = []

    def told(name: str, path: object) -> None:
        notes = outside._NOTES.get()
        if notes is not None and isinstance(path, str) and not path.startswith(OWN):
            found.append(f"{name} {path}")

    def spy(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
        def looks(path: Any = ".", *more: Any, **named: Any) -> Any:
            told(name, path)
            return real(path, *more, **named)

        return looks

    for name in LOOKS:
        monkeypatch.setattr(os, name, spy(name, getattr(os, name)))
    monkeypatch.setattr(builtins, "open", spy("open", open))
    yield found


def test_every_look_at_the_disk_is_noted(unnoted: list[str]) -> None:
    from multibot_rewrite.lint.check import lint_file
    from multibot_rewrite.lint.files.included import set_among

    forget()
    builtin_tree((), SETTINGS.distro)  # the identity of a run has all plugin definitions
    settings, _ = outside.recorded(lambda: set_among(SOURCES, SETTINGS))
    for path in SOURCES:
        outside.recorded(lambda path=path: lint_file(path, settings))
    assert unnoted == []


# What asks the disk or the environment, whoever imports it.
ASKING = re.compile(
    r"\bos\.(?:path\.(?:exists|isfile|isdir|lexists|getsize|realpath|getmtime)|listdir|scandir|stat|lstat"
    r"|walk|environ|getenv)\b|(?<![\w.])(?:open|glob|iglob)\(|\.read_text\(|\.read_bytes\(\)"
)
# The cache itself, what decides which files are linted, processes; what only marked functions call.
ALLOWED = (
    "lint/cache/", "lint/config/", "base/workers.py", "lint/run.py", "lint/__main__.py",
    "lint/launched.py", "rules/launch/", "rules/files/parameter_table.py",
    "rules/files/plugin_table.py",
    "description/sources/child/", "description/sources/processes.py",
    "description/sources/packages.py", "description/sources/access.py",
)  # fmt: skip
PACKAGE_DATA = ("files(", "(_FOLDER, file)", "__path__")


def unmarked(path: Path) -> list[str]:
    """Return the lines of functions without ``outside`` that ask the disk or the environment."""
    tree = ast.parse(path.read_text())
    marked: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and any(
            ast.unparse(it) == "outside" for it in node.decorator_list
        ):
            marked |= set(range(node.lineno, (node.end_lineno or 0) + 1))
    return [
        f"{path.name}:{number}: {line.strip()}"
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if ASKING.search(line)
        and number not in marked
        and not any(it in line for it in PACKAGE_DATA)
    ]


@pytest.mark.slow
def test_what_asks_the_disk_is_marked() -> None:
    """A rule that looks at a file by itself would be right once: its result is kept."""
    package = Path(outside.__file__).parent.parent
    rooms = ("lint", "rules", "description/sources")
    paths = [it for room in rooms for it in sorted((package / room).rglob("*.py"))]
    looked = [it for it in paths if not it.relative_to(package).as_posix().startswith(ALLOWED)]
    assert len(looked) > 100
    assert [line for it in looked for line in unmarked(it)] == []


# ---------------------------------------------------------------- the command


@pytest.mark.slow
def test_the_command_keeps_and_forgets(here: Path) -> None:
    first = command("arm_description", "--roots", ".")
    assert first.stdout
    assert os.listdir(cache_folder())
    second = command("arm_description", "--roots", ".")
    assert (second.stdout, second.stderr, second.returncode) == (
        first.stdout,
        first.stderr,
        first.returncode,
    )


def test_without_a_cache_nothing_is_written(here: Path) -> None:
    main([SOURCES[2], "--trust"])
    assert not os.path.exists(cache_folder())


@pytest.mark.slow
def test_an_unchanged_lint_loads_no_rule(here: Path) -> None:
    program = (
        "import sys; from multibot_rewrite.cli.urdf_lint import main; "
        "main(['arm_description', '--roots', '.']); "
        "print([it for it in ('lxml.etree', 'multibot_rewrite.lint.groups') if it in sys.modules])"
    )
    ran = [
        subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        for _ in range(2)
    ]
    assert ran[0].stdout.splitlines()[-1] != "[]"
    assert ran[1].stdout.splitlines()[-1] == "[]"
    assert ran[0].stdout.splitlines()[:-1] == ran[1].stdout.splitlines()[:-1]


@pytest.mark.more
def test_fixes_are_kept_and_made(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = here / "two.urdf"
    write(broken, MARKED)
    main(["two.urdf"])
    main(["two.urdf", "--fix"])
    text = broken.read_text()
    write(broken, MARKED)
    main(["two.urdf", "--fix", "--trust"])
    assert broken.read_text() == text != MARKED
    assert main(["two.urdf"]) == main(["two.urdf", "--trust"])


def test_statistics(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    twice = '<robot name="r"><link name="a"/><link name="b"/></robot>'
    for name in ("one.urdf", "two.urdf"):
        write(here / name, twice)
    assert main(["one.urdf", "two.urdf", "--format", "statistics", "--select", "MB501"]) == 1
    out, err = capsys.readouterr()
    assert [line.split() for line in out.splitlines()] == [
        ["count", "files", "fixable", "code", "level", "rule"],
        ["2", "2", "MB501", "error", "several-roots"],
    ]
    assert "2 files: 2 errors" in err


@pytest.mark.parametrize(
    "elsewhere", [None, KnownArguments(("a", "b"), False), KnownArguments((), True)]
)
def test_what_is_known_of_other_files_is_kept(elsewhere: KnownArguments | None) -> None:
    settings = Settings(
        included=frozenset(("b.xacro", "a.xacro")), urdfs=(("r", "r.urdf"),), elsewhere=elsewhere
    )
    for path, included in (("", ("a.xacro", "b.xacro")), ("b.xacro", ("b.xacro",)), ("c", ())):
        kept = json.loads(json.dumps(caches.among_written(settings, path)))
        assert kept[0] == [*included]
        found = caches.among_from(kept, Settings())
        assert found == settings._replace(included=frozenset(included))
    for wrong in (
        None,
        [],
        [[], []],
        [1, [], None],
        [[], [["a"]], None],
        [[], [], [1]],
        [[], [], [[]]],
    ):
        assert caches.among_from(wrong, Settings()) is None
