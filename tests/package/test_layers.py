# SPDX-License-Identifier: Apache-2.0
"""The house rules: imports run one way, heavy packages stay out, the public names are complete."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from importlib.resources import files

import pytest
from parsed import PACKAGE, sources

import multibot_rewrite
from multibot_rewrite.base import model
from multibot_rewrite.base.findings import finding

# The order of the floors: a module imports from floors below its own, or from its own folder.
FLOORS = (
    ("version",),
    ("base",),
    ("system",),
    ("knowledge",),
    ("description",),
    ("planning",),
    ("related_files",),
    ("producers",),
    ("rules",),
    ("lint", "live"),
    ("fleet",),
    ("checks",),
    ("library",),
    ("proposal",),
    ("refactor",),
    ("__init__", "launch", "pages"),
    ("cli",),
    ("__main__",),
)
HEAVY = (
    "rclpy",
    "zenoh",
    "rosbags",
    "launch",
    "launch_ros",
    "trimesh",
    "yourdfpy",
    "xacro",
    "tree_sitter",
    "tree_sitter_cpp",
)
# What a start pays for without need; the commands import these where they use them.
LATE = (*HEAVY, "yaml", "rich", "numpy", "difflib")


@cache
def imports_of(file: str) -> tuple[str, ...]:
    """Return what a module of the package imports."""
    return tuple(imports(sources()[file]))


def imports(tree: ast.AST) -> Iterator[str]:
    """Full names of what a module imports, anywhere in it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def room(file: str) -> str:
    """Return the module or folder right below the package that a file belongs to."""
    return file.partition("/")[0].removesuffix(".py")


def floor(room_: str) -> int:
    found = [level for level, rooms in enumerate(FLOORS) if room_ in rooms]
    assert found, f"{room_} has no floor yet: give it one in FLOORS"
    return found[0]


@cache
def inner(file: str) -> set[str]:
    """Return the files of the package that a file imports."""
    found = set()
    for name in imports_of(file):
        parts = name.split(".")
        if parts[0] != PACKAGE.name:
            continue
        paths = ["/".join(parts[1:end]) for end in range(len(parts), 0, -1)]
        files_ = [f"{path}{end}".lstrip("/") for path in paths for end in (".py", "/__init__.py")]
        found.add(next(path for path in files_ if path in sources()))
    return found


@pytest.mark.slow
def test_imports_run_one_way() -> None:
    pairs = [(file, other) for file in sources() for other in inner(file)]
    between = [(one, other) for one, other in pairs if room(one) != room(other)]
    assert [it for it in between if floor(room(it[1])) >= floor(room(it[0]))] == []


@pytest.mark.slow
def test_a_fleet_is_made_without_asking_a_rule() -> None:
    """What judges it stands above: checks, and the commands."""
    asking = [
        (file, other)
        for file in sources()
        for other in inner(file)
        if room(file) == "fleet" and room(other) in ("rules", "lint", "live")
    ]
    assert asking == []


@pytest.mark.slow
def test_no_module_imports_itself_by_a_detour() -> None:
    TopologicalSorter({file: inner(file) for file in sources()}).prepare()


@pytest.mark.slow
def test_the_check_sees_the_imports_there_are() -> None:
    assert inner("description/library.py") >= {
        "base/model.py",
        "base/naming.py",
        "description/pipeline.py",
    }
    assert inner("__init__.py") == {
        "base/findings/finding.py",
        "fleet/robots/loaded_robot.py",
        "library/one_file.py",
        "library/loaded_fleet.py",
        "library/systems.py",
        "refactor/adopt.py",
        "related_files/join.py",
        "refactor/rename.py",
        "description/joining/part.py",
        "description/library.py",
        "base/model.py",
        "system/records.py",
        "version.py",
    }


@pytest.mark.slow
def test_heavy_packages_have_one_door_each() -> None:
    doors = defaultdict(set)
    for file in sources():
        for name in imports_of(file):
            doors[name.split(".")[0]].add(file)
    assert {name: doors[name] for name in HEAVY if len(doors[name]) > 1} == {}


def loaded(code: str) -> set[str]:
    """Return the modules that ``code`` loads in a fresh interpreter, beyond those of a bare start."""
    end = "; import sys; print(*sys.modules)"
    run = [sys.executable, "-c"]
    after = subprocess.run([*run, code + end], capture_output=True, text=True, check=True)
    bare = subprocess.run([*run, "pass" + end], capture_output=True, text=True, check=True)
    return set(after.stdout.split()) - set(bare.stdout.split())


@pytest.mark.slow
def test_a_start_loads_no_more_than_it_needs() -> None:
    there = loaded("import multibot_rewrite as m; m.rewrite('<robot name=\"r\"/>', 'r1')")
    assert "multibot_rewrite.description.library" in there
    assert sorted(there & set(LATE)) == []


NOT_NEEDED = {
    "cli.check": "planning.records planning.planned_system knowledge.records knowledge.node_library",
    "cli.plan": "cli.check_launch live.diagnose library.systems description.joining.join",
    "cli.build": "description.joining.join related_files.join producers.rosgraph.reading",
    "cli.rewrite": "knowledge.records system.records",
    "lint.groups as it; [it.rules_of(one, False) for one in it.GROUPS[:8]]": "system.records",
    "lint.run": "description.rewriters.plugin_definitions",
}


@pytest.mark.slow
@pytest.mark.parametrize("command", NOT_NEEDED)
def test_a_command_loads_no_records_that_it_does_not_make(command: str) -> None:
    there = loaded(f"import multibot_rewrite.{command}")
    assert there & {f"multibot_rewrite.{it}" for it in NOT_NEEDED[command].split()} == set()


@pytest.mark.slow
def test_a_check_pays_for_no_source_that_it_does_not_look_at() -> None:
    there = loaded("import multibot_rewrite.cli.check")
    assert "multibot_rewrite.rules.check" in there
    sources = ("ros.child", "snapshot_file", "zenoh.observe", "zenoh.session")
    late = {*LATE, "inspect", "lxml", "subprocess", "urllib.request"}
    assert there & {*late, *(f"multibot_rewrite.producers.{it}" for it in sources)} == set()


@pytest.mark.slow
def test_the_package_alone_loads_nothing() -> None:
    there = {name for name in loaded("import multibot_rewrite") if name.startswith(PACKAGE.name)}
    assert there == {PACKAGE.name, f"{PACKAGE.name}.version"}


def test_all_names_what_is_there() -> None:
    missing = [name for name in multibot_rewrite.__all__ if not hasattr(multibot_rewrite, name)]
    assert missing == []
    assert sorted(set(multibot_rewrite.__all__)) == multibot_rewrite.__all__


@pytest.mark.slow
def test_all_is_complete() -> None:
    offered = {name.rpartition(".")[2] for name in imports_of("__init__.py")}
    others = {"annotations", "import_module", "TYPE_CHECKING", "__version__"}
    assert offered - others == set(multibot_rewrite.__all__)


def test_every_error_is_public_and_one_family() -> None:
    named = {**vars(model), **vars(finding)}
    errors = {n for n, v in named.items() if isinstance(v, type) and issubclass(v, Exception)}
    assert errors <= set(multibot_rewrite.__all__)
    family = [getattr(multibot_rewrite, name) for name in errors]
    assert all(issubclass(error, multibot_rewrite.MultibotError) for error in family)


def test_the_package_ships_its_types_and_its_data() -> None:
    assert files("multibot_rewrite").joinpath("py.typed").is_file()
    assert (
        files("multibot_rewrite")
        .joinpath("description/rewriters/plugin_definitions/urdf.vocab")
        .is_file()
    )


@pytest.mark.more
def test_every_module_says_what_it_is_for() -> None:
    assert [file for file, tree in sources().items() if not ast.get_docstring(tree)] == []


@pytest.mark.more
def test_every_module_can_be_imported() -> None:
    for file in sources():
        name = file.removesuffix(".py").replace("/", ".").removesuffix("__init__").rstrip(".")
        importlib.import_module(f"multibot_rewrite.{name}".rstrip("."))
