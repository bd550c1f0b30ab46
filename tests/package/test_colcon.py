# SPDX-License-Identifier: Apache-2.0
"""The project and the example package in a colcon workspace, with colcon from PyPI."""

from __future__ import annotations

import importlib.metadata
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from paths import ROOT

pytestmark = pytest.mark.slow

try:
    import tomllib
except ModuleNotFoundError:
    import tomli as tomllib

COLCON = ("colcon-core", "colcon-ros", "colcon-python-setup-py", "colcon-recursive-crawl")
# What a build takes; the rest of the repository is large, and no business of it.
SOURCES = (
    "package.xml",
    "setup.py",
    "setup.cfg",
    "pyproject.toml",
    "resource",
    "share",
    "multibot_rewrite",
)
# Where a shell and man look, below share/.
SHELL_FILES = (
    "bash-completion/completions/multibot",
    "zsh/site-functions/_urdf-lint",
    "man/man1/multibot-plan.1",
    "man/man1/urdf-postfix.1",
)
NAMES = ("multibot_rewrite", "multibot_example")
TOML = tomllib.loads((ROOT / "pyproject.toml").read_text())
PROGRAMS = sorted(TOML["project"]["scripts"])
SECONDS = 300


def run(
    command: Sequence[str | Path], folder: Path, env: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command, cwd=folder, env=env, capture_output=True, text=True, timeout=SECONDS, check=False
    )


@pytest.fixture(scope="session")
def colcon(pytestconfig: pytest.Config) -> Path:
    """colcon in an environment of its own: it wants an older setuptools than the tests have."""
    home = pytestconfig.cache.mkdir(f"colcon-{sysconfig.get_python_version()}")
    program = home / "bin" / "colcon"
    if not program.exists():
        made = run([sys.executable, "-m", "venv", "--clear", home], home)
        pip = [home / "bin" / "python", "-m", "pip", "install", "--quiet", *COLCON]
        made = run(pip, home) if made.returncode == 0 else made
        if made.returncode != 0:
            shutil.rmtree(home)
            reason = (made.stderr or made.stdout).strip().splitlines()[-1:]
            pytest.skip(f"no colcon to build with: pip install {' '.join(COLCON)}: {reason}")
    return program


def copied(folder: Path) -> Path:
    """Return the sources as a workspace has them."""
    ours = folder / "src" / "multibot_rewrite"
    ours.mkdir(parents=True)
    no_caches = shutil.ignore_patterns("__pycache__", "*.egg-info")
    for name in SOURCES:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, ours / name, ignore=no_caches)
        else:
            shutil.copy(source, ours / name)
    example = ROOT / "examples" / "multibot_example"
    shutil.copytree(example, ours / "examples" / example.name, ignore=no_caches)
    return ours


def files(folder: Path) -> set[Path]:
    return {it.relative_to(folder) for it in folder.rglob("*")}


BUILDS = [pytest.param(it, marks=pytest.mark.deep) for it in ("installed", "symlinked")]


@pytest.fixture(scope="module", params=BUILDS)
def workspace(
    request: pytest.FixtureRequest, colcon: Path, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """Return a workspace where both packages are built."""
    folder = tmp_path_factory.mktemp(request.param)
    source = copied(folder)
    before = files(source)
    links = ["--symlink-install"] if request.param == "symlinked" else []
    paths = ["--base-paths", "src", "src/multibot_rewrite/examples"]
    done = run([colcon, "--log-base", "log", "build", *paths, *links], folder)
    assert done.returncode == 0, done.stdout + done.stderr
    for name in NAMES:
        assert f"Finished <<< {name}" in done.stdout
    assert "doesn't explicitly" not in done.stdout + done.stderr
    assert files(source) == before, "a build leaves the sources as they are"
    return folder


def sourced(workspace: Path, command: str) -> subprocess.CompletedProcess[str]:
    """Return the result of a command in a shell that has sourced the workspace, with our Python."""
    script = f'. install/setup.sh && export PYTHONPATH="$PYTHONPATH:$MORE" && {command}'
    return run(
        ["sh", "-c", script], workspace, {**os.environ, "MORE": sysconfig.get_path("purelib")}
    )


@pytest.mark.parametrize("name", NAMES)
def test_the_ament_index_knows_it(name: str, workspace: Path) -> None:
    share = workspace / "install" / name / "share"
    assert (share / "ament_index" / "resource_index" / "packages" / name).is_file()
    assert ET.parse(share / name / "package.xml").findtext("name") == name


def test_ros2_run_finds_the_programs(workspace: Path) -> None:
    folder = workspace / "install" / "multibot_rewrite" / "lib" / "multibot_rewrite"
    assert sorted(it.name for it in folder.iterdir()) == PROGRAMS
    for name in PROGRAMS:
        assert os.access(folder / name, os.X_OK)
        done = sourced(workspace, f"{folder / name} --version")
        assert done.returncode == 0, done.stderr
        assert TOML["project"]["version"] in done.stdout
        by_name = sourced(workspace, f"command -v {name} && {name} --version").stdout
        assert by_name == f"{folder.parents[1] / 'bin' / name}\n{done.stdout}"


def python(workspace: Path, code: str, *words: str) -> str:
    """Return what a Python of this workspace prints."""
    done = sourced(workspace, shlex.join([sys.executable, "-c", code, *words]))
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_what_runs_is_the_workspace_s(workspace: Path) -> None:
    found = python(workspace, "import multibot_rewrite; print(multibot_rewrite.__file__)")
    assert found.startswith(str(workspace))


POINTS = """\
from importlib.metadata import distribution
for it in distribution("multibot_rewrite").entry_points:
    print(it.group, it.name, it.value)
"""


def test_launch_and_ros2cli_find_their_entry_points(workspace: Path) -> None:
    found = set(python(workspace, POINTS).splitlines())
    groups = {"console_scripts": TOML["project"]["scripts"], **TOML["project"]["entry-points"]}
    assert found == {f"{group} {key} {its[key]}" for group, its in groups.items() for key in its}
    assert {"launch.frontend.launch_extension", "ros2cli.command"} < set(groups)


LOAD = "import sys, multibot_rewrite as m; print(*m.load_fleet(sys.argv[1]).files)"


def test_data_files_are_there(workspace: Path) -> None:
    fleet = "install/multibot_example/share/multibot_example/config/fleet_gz.yaml"
    assert "robot2/bridge.yaml" in python(workspace, LOAD, fleet).split()


def test_completions_and_manual_pages_are_installed(workspace: Path) -> None:
    share = workspace / "install" / "multibot_rewrite" / "share"
    for name in SHELL_FILES:
        assert (share / name).read_bytes() == (ROOT / "share" / name).read_bytes()


def test_the_example_is_installed_whole(workspace: Path) -> None:
    share = workspace / "install" / "multibot_example" / "share" / "multibot_example"
    example = ROOT / "examples" / "multibot_example"
    for folder in ("config", "launch", "urdf"):
        for path in (example / folder).iterdir():
            assert (share / folder / path.name).read_bytes() == path.read_bytes()


def test_versions_and_descriptions_agree() -> None:
    manifest = ET.parse(ROOT / "package.xml")
    for tag, key in (("name", "name"), ("version", "version"), ("description", "description")):
        assert manifest.findtext(tag) == TOML["project"][key]
    assert manifest.findtext("license") == TOML["project"]["license"]


def test_both_manifests_ask_for_the_same_packages() -> None:
    """Of what is needed everywhere: each has its own words for conditions."""
    depends = ET.parse(ROOT / "package.xml").iter()
    kinds = ("depend", "exec_depend")
    ros = {it.text for it in depends if it.tag in kinds and not it.get("condition")}
    always = (it for it in TOML["project"]["dependencies"] if ";" not in it)
    pip = {re.split(r"[>=<]", it)[0].lower() for it in always}
    names = {"pyyaml": "python3-yaml", "xacro": "xacro"}
    assert ros == {names.get(it, f"python3-{it}") for it in pip}


@pytest.mark.deep
def test_pip_goes_by_pyproject_alone(tmp_path: Path) -> None:
    source, target = copied(tmp_path), tmp_path / "target"
    for name in ("README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    offline = ["--no-deps", "--no-index", "--no-build-isolation", "--no-compile"]
    pip = [sys.executable, "-m", "pip", "install", "--quiet", *offline, "--target", target, source]
    done = run(pip, tmp_path)
    assert done.returncode == 0, done.stderr
    (found,) = importlib.metadata.distributions(path=[str(target)])
    assert found.metadata["License-Expression"] == TOML["project"]["license"]
    assert found.metadata["Requires-Python"] == TOML["project"]["requires-python"]
    needed = [it for it in found.requires or () if "extra ==" not in it]
    assert any(it.startswith("lxml") for it in needed)
    assert not any(it.startswith("yourdfpy") for it in needed)
    assert sorted(it.name for it in (target / "bin").iterdir()) == PROGRAMS
    for name in SHELL_FILES:
        assert (target / "share" / name).read_bytes() == (ROOT / "share" / name).read_bytes()
