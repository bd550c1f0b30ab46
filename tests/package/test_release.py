# SPDX-License-Identifier: Apache-2.0
"""What is published: the archives hold the package and nothing else, and the workflow is safe."""

from __future__ import annotations

import os
import re
import runpy
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import ROOT

from multibot_rewrite.version import __version__

WORKFLOWS = ROOT / ".github" / "workflows"
TOOL: dict[str, Any] = runpy.run_path(str(ROOT / ".ci" / "release.py"))
# What is of a package's build and not of the package.
MADE = ("__pycache__", ".egg-info", ".pyc")
SOURCES = (
    "multibot_rewrite",
    "tools",
    "share",
    "resource",
    "fixtures/robots",
    "tests/support",
    ".ci",
)
# Both ends of PEP 517 in one process: a wheel of what the source archive holds.
BUILD = """
import os, sys, tarfile
from setuptools import build_meta
wheels = sys.argv[1]
name = build_meta.build_sdist("dist")
tarfile.open("dist/" + name).extractall("unpacked")
os.chdir("unpacked/" + name.removesuffix(".tar.gz"))
build_meta.build_wheel(wheels)
"""


def run(words: Sequence[str | Path], folder: Path) -> subprocess.CompletedProcess[str]:
    environ = {key: it for key, it in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.run(
        words, cwd=folder, env=environ, capture_output=True, text=True, check=False
    )


def copied(folder: Path) -> Path:
    """Return a part of the repository, with what must not be published."""
    folder.mkdir()
    for path in ROOT.iterdir():
        if path.is_file() and path.suffix in (".toml", ".cfg", ".py", ".xml", ".rst", ".md", ".in"):
            shutil.copy(path, folder)
    shutil.copy(ROOT / "LICENSE", folder)
    shutil.copy(ROOT / "CITATION.cff", folder)
    for name in SOURCES:
        ignore = shutil.ignore_patterns("__pycache__", "*.egg-info")
        shutil.copytree(ROOT / name, folder / name, ignore=ignore)
    return folder


@pytest.fixture(scope="module")
def archives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the source archive and the wheel."""
    pytest.importorskip(
        "setuptools", minversion="77", reason="pyproject.toml asks for setuptools 77"
    )
    folder = tmp_path_factory.mktemp("release")
    source = copied(folder / "source")
    done = run([sys.executable, "-c", BUILD, source / "dist"], source)
    assert done.returncode == 0, done.stderr
    return source / "dist"


def ours(folder: Path) -> set[str]:
    """Return the files of a folder of the repository, by their path in it."""
    found = (it for it in (ROOT / folder).rglob("*") if it.is_file())
    return {str(it.relative_to(ROOT)) for it in found if not any(word in str(it) for word in MADE)}


def wheel_of(archives: Path) -> Path:
    (found,) = archives.glob("*.whl")
    return found


@pytest.mark.slow
def test_the_wheel_is_the_package_whole_and_nothing_else(archives: Path) -> None:
    names = zipfile.ZipFile(wheel_of(archives)).namelist()
    tops = {it.partition("/")[0].rpartition(".")[2] for it in names}
    assert tops == {"multibot_rewrite", "data", "dist-info"}
    assert {it for it in names if it.startswith("multibot_rewrite/")} == ours(
        Path("multibot_rewrite")
    )
    assert any(it.endswith("dist-info/licenses/LICENSE") for it in names)


@pytest.mark.slow
def test_the_wheel_has_what_shells_and_launch_files_look_for(archives: Path) -> None:
    names = zipfile.ZipFile(wheel_of(archives)).namelist()
    found = {it.partition(".data/data/")[2] for it in names} - {""}
    made = {it for it in ours(Path("share")) if not it.endswith("make.py")}
    ours_alone = re.compile(r"^share/(?=launch/|cmake/)")
    moved = {ours_alone.sub("share/multibot_rewrite/", it) for it in made}
    assert found == moved


@pytest.mark.slow
def test_the_source_archive_can_be_built_by_pip_and_by_colcon(archives: Path) -> None:
    (path,) = archives.glob("*.tar.gz")
    with tarfile.open(path) as archive:
        files = [it.name.partition("/")[2] for it in archive if it.isfile()]
    needed = {"pyproject.toml", "setup.py", "setup.cfg", "package.xml", "CHANGELOG.rst", "LICENSE"}
    assert needed | ours(Path("resource")) | ours(Path("multibot_rewrite")) <= set(files)
    assert [
        it for it in files if it.startswith(("tools", "tests", "fixtures", "docs", ".ci"))
    ] == []
    assert path.stat().st_size < 3_000_000 > wheel_of(archives).stat().st_size


@pytest.mark.slow
def test_the_readme_is_what_an_index_can_show(archives: Path) -> None:
    metadata = pytest.importorskip("packaging.metadata", reason="no packaging")
    wheel = zipfile.ZipFile(wheel_of(archives))
    (name,) = (it for it in wheel.namelist() if it.endswith(".dist-info/METADATA"))
    found = metadata.Metadata.from_email(wheel.read(name), validate=True)
    assert found.description_content_type == "text/markdown"
    assert found.description == (ROOT / "README.md").read_text()


@pytest.mark.deep
def test_an_installed_wheel_does_the_main_job(archives: Path, tmp_path: Path) -> None:
    """In an environment of its own, far from the sources; libraries come from that of the tests."""
    fresh = tmp_path / "fresh"
    run([sys.executable, "-m", "venv", "--without-pip", fresh], tmp_path)
    pip = [sys.executable, "-m", "pip", "--python", fresh, "install", "--no-index", "--no-deps"]
    done = run([*pip, wheel_of(archives)], tmp_path)
    assert done.returncode == 0, done.stderr
    (home,) = fresh.glob("lib/python*/site-packages")
    (home / "libraries.pth").write_text(sysconfig.get_path("purelib"))
    shutil.copy(ROOT / "fixtures" / "robots" / "rover.urdf", tmp_path)
    words = ["rover.urdf", "robot1", "robot2", "-o", "out/{robot}.urdf", "--fail-on", "warning"]
    done = run([fresh / "bin" / "urdf-postfix", *words], tmp_path)
    assert (done.returncode, "2 robots" in done.stderr) == (0, True), done.stderr
    assert '"base_link/robot2"' in (tmp_path / "out" / "robot2.urdf").read_text()
    lint = run([fresh / "bin" / "urdf-lint", "rover.urdf", "--fail-on", "error"], tmp_path)
    assert lint.returncode == 0, lint.stdout
    where = "import multibot_rewrite as it; print(it.__file__, it.__version__)"
    said = run([fresh / "bin" / "python", "-c", where], tmp_path).stdout.split()
    assert said[0].startswith(str(home))
    assert f"-{said[1]}-" in wheel_of(archives).name


def workflow(name: str) -> dict[str, Any]:
    loaded = yaml.safe_load((WORKFLOWS / name).read_text())
    assert isinstance(loaded, dict)
    return loaded


OURS = ("ci.yml", "container.yml", "docs.yml", "release.yml")


@pytest.mark.slow
def test_the_workflows_are_by_their_schema() -> None:
    files = [str(WORKFLOWS / it) for it in OURS]
    words = ["-m", "check_jsonschema", "--builtin-schema", "vendor.github-workflows", *files]
    done = run([sys.executable, *words], ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("name", OURS)
def test_a_workflow_trusts_no_name_and_takes_no_right(name: str) -> None:
    """A tag of an action may be moved, a commit may not; every right is asked for by its job."""
    text = (WORKFLOWS / name).read_text()
    assert workflow(name)["permissions"] == {}
    assert all(it.get("permissions") for it in workflow(name)["jobs"].values())
    used = re.findall(r"uses: (.*)", text)
    assert all(re.fullmatch(r"[\w/-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+", it) for it in used)
    assert text.count("actions/checkout@") == text.count("persist-credentials: false")
    assert not re.search(r"secrets\.|password|pull_request_target", text)
    runs = [it.get("run", "") for job in workflow(name)["jobs"].values() for it in job["steps"]]
    assert not any("${{" in it for it in runs)


def test_one_job_may_publish_and_it_runs_nothing_of_the_repository() -> None:
    jobs = workflow("release.yml")["jobs"]
    trusted = {name for name, it in jobs.items() if "id-token" in it["permissions"]}
    assert trusted == {"pypi"}
    job = jobs["pypi"]
    assert (job["permissions"], job["environment"]) == ({"id-token": "write"}, {"name": "pypi"})
    assert [it["uses"].partition("@")[0] for it in job["steps"]] == [
        "actions/download-artifact",
        "pypa/gh-action-pypi-publish",
    ]
    assert (jobs["pypi"]["needs"], jobs["github"]["needs"]) == ("build", "pypi")


def test_the_site_is_published_by_a_job_that_runs_nothing_of_the_repository() -> None:
    jobs = workflow("docs.yml")["jobs"]
    assert jobs["build"]["permissions"] == {"contents": "read"}
    assert [list(it) for it in jobs["publish"]["steps"]] == [["uses"]]
    assert "refs/heads/main" in jobs["publish"]["if"]


def test_what_is_published_is_checked_first() -> None:
    build = workflow("release.yml")["jobs"]["build"]["steps"]
    script = "\n".join(it.get("run", "") for it in build)
    order = ["release.py notes", "-m build", "twine check --strict", "urdf-postfix rover.urdf"]
    assert sorted(order, key=script.index) == order
    (told,) = workflow("release.yml")[True].values()
    assert told == {"tags": ["v*"]}


def test_the_tests_that_are_run_are_those_of_the_readme() -> None:
    (command,) = re.findall(
        r"(?m)^    (python3 -m venv .*pytest.*)$", (ROOT / "README.md").read_text()
    )
    script = (ROOT / ".ci" / "run").read_text()
    for step in ("python3 -m venv .venv", "'.[test]'", "-m pytest -n 3"):
        assert step in command and step in script
    assert any(it.get("run") == ".ci/run" for it in workflow("ci.yml")["jobs"]["tests"]["steps"])


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """Return what says the version, in a folder of its own, and a change that is not released."""
    for name in (*TOOL["PLACES"], "CHANGELOG.rst"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    changes = tmp_path / "CHANGELOG.rst"
    if not re.search(r"(?m)^Forthcoming$", changes.read_text()):
        now = f"\n{__version__} ("
        new = f"\nForthcoming\n{'-' * 11}\n**Added**\n\n* New\n{now}"
        changes.write_text(changes.read_text().replace(now, new, 1))
    return tmp_path


def test_a_prepared_release_says_one_version_and_what_is_new(repository: Path) -> None:
    TOOL["prepare"]("7.8.9", repository, "2030-01-02")
    notes = TOOL["notes"]("v7.8.9", repository)
    assert notes.startswith("**") and "\n* " in notes and "``" not in notes
    changes = (repository / "CHANGELOG.rst").read_text()
    assert "\n7.8.9 (2030-01-02)\n------------------\n**" in changes
    for name in TOOL["PLACES"]:
        assert "7.8.9" in (repository / name).read_text()
    assert f'version = "{__version__}"' not in (repository / "pyproject.toml").read_text()


def test_the_notes_are_those_of_one_version(repository: Path) -> None:
    file = repository / "CHANGELOG.rst"
    TOOL["prepare"]("7.8.9", repository, "2030-01-02")
    title = "7.8.9 (2030-01-02)"
    file.write_text(file.read_text().replace(title, f"Forthcoming\n{'-' * 11}\n* New\n\n{title}"))
    TOOL["prepare"]("8.0.0", repository, "2030-01-03")
    assert TOOL["notes"]("v8.0.0", repository) == "* New"


def refuse_twice(root: Path) -> None:
    TOOL["prepare"]("7.8.9", root, "2030-01-02")
    TOOL["prepare"]("7.8.9", root, "2030-01-02")


def refuse_other(root: Path) -> None:
    TOOL["prepare"]("7.8.9", root, "2030-01-02")
    file = root / "package.xml"
    file.write_text(file.read_text().replace("7.8.9", "7.8.8"))
    TOOL["notes"]("v7.8.9", root)


@pytest.mark.parametrize(
    ("act", "words"),
    [
        pytest.param(lambda root: TOOL["prepare"]("7.8", root, ""), "three numbers", id="form"),
        pytest.param(refuse_twice, "7.8.9 is released already", id="twice"),
        pytest.param(refuse_other, r"package\.xml: the tag is v7\.8\.9", id="other"),
        pytest.param(lambda root: TOOL["notes"]("v9.9.9", root), "the tag is v9.9.9", id="tag"),
    ],
)
def test_a_release_that_does_not_agree_is_refused(
    act: Callable[[Path], None], words: str, repository: Path
) -> None:
    with pytest.raises(ValueError, match=words):
        act(repository)


def test_all_files_say_the_same_version_now() -> None:
    found = {
        number
        for name, pattern in TOOL["PLACES"].items()
        for place in re.finditer(pattern, (ROOT / name).read_text())
        for number in re.findall(TOOL["VERSION"], place[0])
    }
    assert found == {__version__}
