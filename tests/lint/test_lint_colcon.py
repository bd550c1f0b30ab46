# SPDX-License-Identifier: Apache-2.0
"""A description package lints itself in ``colcon test``, with the real CMake, ament and colcon."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from pathlib import Path

import pytest
from junitparser import JUnitXml
from paths import ROOT

pytestmark = pytest.mark.slow

PAGE = (
    (ROOT / "docs" / "lint.md").read_text().partition("### colcon test")[2].partition("\n### ")[0]
)
IN_CMAKE, IN_PYTHON = (
    re.findall(rf"```{it}\n(.*?)```", PAGE, re.DOTALL)[0] for it in ("cmake", "python")
)
AMENT = Path(sys.prefix, "share", "ament_cmake_test")
COLCON = (
    "colcon-core", "colcon-ros", "colcon-python-setup-py", "colcon-recursive-crawl", "colcon-cmake",
    "colcon-test-result",
)  # fmt: skip
HAND = '<joint name="wrist" type="fixed"><parent link="base"/><child link="hand"/></joint>'
GOOD = f'<robot name="r"><link name="base"/><link name="hand"/>{HAND}</robot>\n'
BAD = GOOD.replace("</robot>", '<link name="lost"/></robot>')
MANIFEST = """<package format="3"><name>{name}</name><version>1.0.0</version>
<description>d</description><maintainer email="a@b.org">m</maintainer><license>Apache-2.0</license>
<buildtool_depend>{tool}</buildtool_depend><test_depend>multibot_rewrite</test_depend>
<export><build_type>{tool}</build_type></export></package>
"""
SETUP = """from setuptools import setup
setup(name="by_python", version="1.0.0", packages=[], tests_require=["pytest"], data_files=[
    ("share/ament_index/resource_index/packages", ["resource/by_python"]),
    ("share/by_python", ["package.xml"])])
"""


def environ() -> dict[str, str]:
    """Return the variables of an active environment with multibot_rewrite and ament installed."""
    path = os.pathsep.join([str(Path(sys.prefix, "bin")), os.environ["PATH"]])
    return {
        **os.environ, "PATH": path, "AMENT_PREFIX_PATH": sys.prefix, "CMAKE_PREFIX_PATH": sys.prefix,
    }  # fmt: skip


def run(words: Sequence[str | Path], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        words, cwd=folder, env=environ(), capture_output=True, text=True, timeout=300, check=False
    )


@pytest.fixture
def ament() -> list[str]:
    """Words by which CMake finds Python, ament and this checkout's function."""
    if not AMENT.is_dir() or shutil.which("cmake") is None:
        pytest.skip("no CMake with ament_cmake: pip install '.[tf2-build]'")
    return [
        f"-DPython3_EXECUTABLE={sys.executable}",
        f"-Dmultibot_rewrite_DIR={ROOT / 'share' / 'cmake'}",
    ]


def by_cmake(folder: Path, document: str, lines: str = IN_CMAKE) -> Path:
    """Return a package with one description, which CMake builds."""
    package = folder / "by_cmake"
    (package / "urdf").mkdir(parents=True)
    (package / "urdf" / "r.urdf").write_text(document)
    (package / "package.xml").write_text(MANIFEST.format(name="by_cmake", tool="ament_cmake"))
    head = "cmake_minimum_required(VERSION 3.16)\nproject(by_cmake NONE)\n"
    (package / "CMakeLists.txt").write_text(f"{head}{lines}ament_package()\n")
    return package


def outcome(package: Path, ament: list[str], folder: Path) -> tuple[int, JUnitXml]:
    """Return the exit code of ctest, and the result that it leaves."""
    build = folder / "build" / "by_cmake"
    done = run(["cmake", "-S", package, "-B", build, *ament], folder)
    assert done.returncode == 0, done.stdout + done.stderr
    done = run(["ctest", "--output-on-failure"], build)
    (file,) = (build / "test_results" / "by_cmake").glob("*.xml")
    return done.returncode, JUnitXml.fromfile(str(file))


def failures(result: JUnitXml) -> list[str]:
    """Return the codes of what was found."""
    cases = (case for suite in result for case in suite if case.is_failure)
    return [str(case.name).split()[0] for case in cases]


def test_a_package_that_is_clean_passes(ament: list[str], tmp_path: Path) -> None:
    code, result = outcome(by_cmake(tmp_path, GOOD), ament, tmp_path)
    assert (code, failures(result), result.failures, result.errors) == (0, [], 0, 0)
    assert [suite.name for suite in result] == ["urdf/r.urdf"]


def test_what_is_found_is_a_failure_by_its_code(ament: list[str], tmp_path: Path) -> None:
    code, result = outcome(by_cmake(tmp_path, BAD), ament, tmp_path)
    assert (code != 0, failures(result)) == (True, ["MB501"])


def test_options_and_paths_are_those_of_the_command(ament: list[str], tmp_path: Path) -> None:
    package = by_cmake(
        tmp_path, BAD,
        IN_CMAKE.replace("urdf_lint()", "urdf_lint(PATHS urdf OPTIONS --ignore MB5 TEST_NAME own)"),
    )  # fmt: skip
    code, result = outcome(package, ament, tmp_path)
    assert (code, failures(result)) == (0, [])
    assert (
        tmp_path / "build" / "by_cmake" / "test_results" / "by_cmake" / "own.xunit.xml"
    ).exists()


def test_a_package_without_a_description_fails(ament: list[str], tmp_path: Path) -> None:
    """The lint ends with 2 and writes nothing: no test passes that looks at nothing."""
    package = by_cmake(tmp_path, GOOD)
    shutil.rmtree(package / "urdf")
    code, result = outcome(package, ament, tmp_path)
    assert code != 0 and result.errors + result.failures == 1


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (IN_CMAKE.replace("urdf_lint()", "urdf_lint(FILES a)"), "unknown arguments FILES;a"),
        ("find_package(multibot_rewrite REQUIRED)\nurdf_lint()\n", "find_package(ament_cmake"),
    ],
)
def test_a_wrong_use_is_said(lines: str, said: str, ament: list[str], tmp_path: Path) -> None:
    package = by_cmake(tmp_path, GOOD, lines)
    done = run(["cmake", "-S", package, "-B", tmp_path / "build", *ament], tmp_path)
    assert done.returncode != 0 and said in " ".join(done.stderr.split())


@pytest.fixture(scope="module")
def colcon(pytestconfig: pytest.Config) -> Path:
    """colcon with CMake in an environment of its own."""
    home = pytestconfig.cache.mkdir(f"colcon-cmake-{sysconfig.get_python_version()}")
    program = home / "bin" / "colcon"
    if not program.exists():
        run([sys.executable, "-m", "venv", "--clear", home], home)
        done = run(
            [home / "bin" / "python", "-m", "pip", "install", "--quiet", *COLCON, "pytest"], home
        )
        if done.returncode != 0:
            shutil.rmtree(home)
            pytest.skip(f"no colcon: {done.stderr.strip().splitlines()[-1:]}")
    return program


@pytest.mark.deep
def test_colcon_tests_both_kinds_of_packages(
    colcon: Path, ament: list[str], tmp_path: Path
) -> None:
    by_cmake(tmp_path / "src", BAD)
    python = tmp_path / "src" / "by_python"
    for name, text in {
        "package.xml": MANIFEST.format(name="by_python", tool="ament_python"),
        "setup.py": SETUP, "resource/by_python": "", "urdf/r.urdf": BAD,
        "setup.cfg": "[options]\ntests_require = pytest\n", "test/test_urdf_lint.py": IN_PYTHON,
    }.items():  # fmt: skip
        (python / name).parent.mkdir(parents=True, exist_ok=True)
        (python / name).write_text(text)
    words = ["--log-base", "log"]
    done = run([colcon, *words, "build", "--cmake-args", *ament], tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    done = run([colcon, *words, "test"], tmp_path)
    said = run([colcon, *words, "test-result", "--verbose"], tmp_path).stdout
    # CTest's own word on the test of CMake is counted as well.
    assert "Summary: 3 tests, 0 errors, 3 failures, 0 skipped" in said, said + done.stderr
    assert said.count("MB501") >= 2
    for package in ("by_cmake", "by_python"):
        (tmp_path / "src" / package / "urdf" / "r.urdf").write_text(GOOD)
    assert run([colcon, *words, "test"], tmp_path).returncode == 0
    said = run([colcon, *words, "test-result"], tmp_path).stdout
    assert "Summary: 3 tests, 0 errors, 0 failures, 0 skipped" in said
