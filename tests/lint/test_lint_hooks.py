# SPDX-License-Identifier: Apache-2.0
"""The lint where it is used: pre-commit really runs it, and so do the CI examples of its page."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml
from junitparser import JUnitXml
from paths import ROOT

from multibot_rewrite.cli.declared.commands import PROGRAMS
from multibot_rewrite.cli.lint import check_use
from multibot_rewrite.cli.parser import make_parser, parsed
from multibot_rewrite.cli.urdf_lint import main
from multibot_rewrite.version import __version__

pytestmark = pytest.mark.slow

HOOKS = ROOT / ".pre-commit-hooks.yaml"
PAGE = (ROOT / "docs" / "lint.md").read_text()
HOME = "https://github.com/multibot-rewrite/multibot_rewrite"
REVISION = f"v{__version__}"
BASH = ("bash", "-e", "-o", "pipefail", "-c")
IDENTITY = ("-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "init.defaultBranch=main")
HAND = '<joint name="wrist" type="fixed"><parent link="base"/><child link="hand"/></joint>'
LINKS = f'<link name="base"/><link name="hand"/>{HAND}'
GOOD = f'<robot name="r">{LINKS}</robot>'
BAD = f'<robot name="r">{LINKS}<link name="lost"/></robot>'
FOUND = "MB501"


def example(language: str, has: str) -> str:
    """Return the example of the page in that language that holds a text."""
    (found,) = (it for it in re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL) if has in it)
    assert isinstance(found, str)
    return found


PRE_COMMIT = example("yaml", "hooks:")
WORKFLOW = example("yaml", "workflow_call:")
SHORT = example("yaml", "- uses: multibot-rewrite/")
ACTION = ROOT / "action.yml"
GITLAB = example("yaml", "codequality:")
JENKINS = example("groovy", "pipeline")


def run(
    command: Sequence[str], folder: Path, env: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    whole = None if env is None else {**os.environ, **env}
    return subprocess.run(
        command, cwd=folder, env=whole, capture_output=True, text=True, check=False
    )


def git(folder: Path, *words: str) -> str:
    done = run(["git", *IDENTITY, *words], folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


def repository(folder: Path, document: str) -> Path:
    """Return a repository with one description, committed."""
    (folder / "urdf").mkdir(parents=True)
    (folder / "urdf" / "rover.urdf").write_text(document)
    git(folder, "init", "-q")
    git(folder, "add", ".")
    git(folder, "commit", "-q", "-m", "a rover")
    return folder


# What needs no network


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(["pre_commit", "validate-manifest", str(HOOKS)], id="manifest"),
        pytest.param(["pre_commit", "validate-config", "config.yaml"], id="config"),
        pytest.param(
            ["check_jsonschema", "--builtin-schema", "vendor.github-workflows", "workflow.yaml"],
            id="github",
        ),
        pytest.param(
            ["check_jsonschema", "--builtin-schema", "vendor.github-workflows", "short.yaml"],
            id="github-short",
        ),
        pytest.param(
            ["check_jsonschema", "--builtin-schema", "vendor.github-actions", str(ACTION)],
            id="action",
        ),
        pytest.param(
            ["check_jsonschema", "--builtin-schema", "vendor.gitlab-ci", "gitlab.yaml"], id="gitlab"
        ),
    ],
)
def test_it_holds_by_the_schema_of_its_reader(words: list[str], tmp_path: Path) -> None:
    examples = {"config": PRE_COMMIT, "workflow": WORKFLOW, "short": SHORT, "gitlab": GITLAB}
    for name, content in examples.items():
        (tmp_path / f"{name}.yaml").write_text(content)
    done = run([sys.executable, "-m", *words], tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("path", "runs"),
    [
        ("a.urdf", True),
        ("deep/in/a.urdf.xacro", True),
        ("a.SRDF", True),
        ("urdf-lint.toml", True),
        ("deep/urdf-lint.toml", True),
        ("not-urdf-lint.toml", False),
        ("a.urdf.md", False),
        ("urdf", False),
        ("trees/main.xml", True),
        ("a.txt", False),
    ],
)
def test_the_hook_runs_where_a_description_was_touched(path: str, runs: bool) -> None:
    (hook,) = yaml.safe_load(HOOKS.read_text())
    assert bool(re.search(hook["files"], path)) == runs


def shown_commands() -> list[str]:
    """Return what follows every call of the lint on the page, up to where the shell takes over."""
    found = re.findall(r"\burdf-lint\"? ((?:\.|\$PATHS) .*)$", PAGE, re.MULTILINE)
    return [re.split(r"\|\||>>|'", it)[0].replace("$PATHS", ".").strip() for it in found]


def test_the_page_shows_commands() -> None:
    assert len(shown_commands()) == 8


@pytest.mark.parametrize("line", shown_commands())
def test_a_command_of_the_page_is_a_right_one(line: str) -> None:
    check_use(parsed(make_parser(PROGRAMS["urdf-lint"]), shlex.split(line)))


def lint(line: str) -> int:
    return main(shlex.split(line)[1:])


def test_the_baseline_keeps_old_findings_away(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write, read = example("console", "--write-baseline").splitlines()
    monkeypatch.chdir(repository(tmp_path / "r", BAD))
    assert lint("urdf-lint .") == 1
    assert lint(write) == 0
    capsys.readouterr()
    assert lint(read) == 0
    assert capsys.readouterr().out == ""
    Path("urdf/new.urdf").write_text(BAD)
    assert lint(read) == 1
    assert capsys.readouterr().out.count(FOUND) == 1


def test_only_what_a_branch_changed_is_linted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (line,) = example("console", "--changed-since").splitlines()
    repository(tmp_path / "origin", BAD)
    git(tmp_path, "clone", "-q", "origin", "clone")
    monkeypatch.chdir(tmp_path / "clone")
    assert lint(line) == 0
    Path("urdf/new.urdf").write_text(BAD)
    git(Path(), "add", ".")
    capsys.readouterr()
    assert lint(line) == 1
    assert "new.urdf" in capsys.readouterr().out


# What installs the package: pre-commit and the CI examples


@pytest.fixture(scope="session")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the working tree, committed as the revision of the page."""
    folder = tmp_path_factory.mktemp("clone")
    listed = git(ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard")
    for name in listed.split("\0"):
        if name and (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    git(folder, "init", "-q")
    git(folder, "add", ".")
    git(folder, "commit", "-q", "-m", "the working tree")
    git(folder, "tag", REVISION)
    made = run([sys.executable, ".ci/release.py", "hook", REVISION], folder)
    assert made.stdout.strip() == f"hook-{REVISION}", made.stderr
    return folder


@pytest.fixture(scope="session")
def venv(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the Python of a CI job."""
    folder = tmp_path_factory.mktemp("venv")
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    return folder


@pytest.mark.more
def test_pre_commit_downloads_little(clone: Path, tmp_path: Path) -> None:
    """As pre-commit fetches a revision: with no history."""
    git(tmp_path, "init", "-q")
    git(tmp_path, "fetch", "-q", "--depth=1", clone.as_uri(), f"hook-{REVISION}")
    (pack,) = (tmp_path / ".git" / "objects" / "pack").glob("*.pack")
    assert 1_000_000 < pack.stat().st_size < 4_000_000


@pytest.mark.deep
def test_pre_commit_runs_the_hook(clone: Path, tmp_path: Path) -> None:
    here = repository(tmp_path / "r", GOOD)
    (here / ".pre-commit-config.yaml").write_text(PRE_COMMIT.replace(HOME, str(clone)))
    git(here, "add", ".")
    git(here, "commit", "-q", "-m", "hooks")
    (here / "notes.txt").write_text("a rover\n")
    git(here, "add", ".")
    env = {"PRE_COMMIT_HOME": str(tmp_path / "home"), "PYTHONPATH": ""}
    command = [sys.executable, "-m", "pre_commit", "run", "--verbose"]

    skipped = run(command, here, env)
    assert (skipped.returncode, "Skipped" in skipped.stdout) == (0, True), skipped.stdout

    (here / "urdf" / "bad.urdf").write_text(BAD)
    git(here, "add", ".")
    failed = run(command, here, env)
    assert failed.returncode == 1, failed.stdout + failed.stderr
    assert re.search(rf"bad\.urdf:1:\d+: error: {FOUND} link 'lost'", failed.stdout)
    assert "rover.urdf" not in failed.stdout

    (here / "urdf" / "bad.urdf").write_text(GOOD)
    git(here, "add", ".")
    passed = run(command, here, env)
    assert (passed.returncode, "Passed" in passed.stdout) == (0, True), passed.stdout


class Ran(NamedTuple):
    """A CI job that ran in a folder: names of steps that failed, what it printed."""

    folder: Path
    failed: list[str]
    printed: str


# Expressions of the workflow, and what they are here.
EXPRESSIONS = {"${{ inputs.paths || '.' }}": "."}
KNOWN_ACTIONS = {"actions/checkout", "actions/setup-python", "actions/upload-artifact"}
# They run nothing of the repository, so a job of them may write.
PASSIVE_ACTIONS = {"actions/download-artifact", "github/codeql-action/upload-sarif"}


def run_workflow(folder: Path, env: Mapping[str, str]) -> Ran:
    """Return the steps of the workflow, with nothing in the place of actions."""
    job = yaml.safe_load(WORKFLOW)["jobs"]["urdf-lint"]
    given = {name: EXPRESSIONS.get(value, value) for name, value in job["env"].items()}
    failed: list[str] = []
    printed = ""
    for step in job["steps"]:
        if failed and "!cancelled()" not in step.get("if", ""):
            continue
        if "uses" in step:
            assert step["uses"].partition("@")[0] in KNOWN_ACTIONS
            uploaded = step["with"].get("path")
            failed += [step["name"]] if uploaded and not (folder / uploaded).is_file() else []
            continue
        done = run(["bash", "-e", "-c", step["run"]], folder, {**given, **env})
        failed += [step["name"]] if done.returncode else []
        printed += done.stdout + done.stderr
    return Ran(folder, failed, printed)


def job_env(clone: Path, venv: Path, **more: str) -> dict[str, str]:
    """Return the environment in which the page's requirement is the clone, and pip the job's."""
    path = f"{venv / 'bin'}{os.pathsep}{os.environ['PATH']}"
    return {"URDF_LINT": f"git+file://{clone}@{REVISION}", "PATH": path, "PYTHONPATH": "", **more}


def test_a_job_that_reads_the_repository_may_write_nothing() -> None:
    """A pull request brings its files, and xacro files are programs."""
    workflow = yaml.safe_load(WORKFLOW)
    assert workflow["permissions"] == {"contents": "read"}
    for job in workflow["jobs"].values():
        actions = {it["uses"].partition("@")[0] for it in job["steps"] if "uses" in it}
        if "permissions" in job:
            assert actions <= PASSIVE_ACTIONS
            assert not any("run" in it for it in job["steps"])
    checkout = workflow["jobs"]["urdf-lint"]["steps"][0]
    assert checkout["with"] == {"persist-credentials": False}
    assert "secrets." not in PAGE
    assert "pull_request_target" not in WORKFLOW


def test_the_action_is_pinned_and_reads_nothing_as_a_command() -> None:
    steps = yaml.safe_load(ACTION.read_text())["runs"]["steps"]
    used = [it["uses"] for it in steps if "uses" in it]
    assert {it.partition("@")[0] for it in used} <= KNOWN_ACTIONS | PASSIVE_ACTIONS
    assert all(re.fullmatch(r"[\w/-]+@[0-9a-f]{40}", it) for it in used)
    assert not any("${{" in it.get("run", "") for it in steps)
    workflow = yaml.safe_load(SHORT)
    assert workflow["permissions"] == {"contents": "read"}
    assert "permissions" not in workflow["jobs"]["urdf-lint"]


def test_the_action_installs_what_the_package_needs_in_one_version() -> None:
    def names(lines: Iterable[str]) -> set[str]:
        return {re.split(r"[<>=;! ]", it)[0].lower() for it in lines if it and it[0] != "#"}

    pins = (ROOT / ".ci" / "lint-constraints.txt").read_text().splitlines()
    assert all(re.fullmatch(r"[\w-]+==[\d.]+", it) for it in pins if it[0] != "#")
    text = (ROOT / "pyproject.toml").read_text()
    (listed,) = re.findall(r"(?m)^dependencies = \[\n(.*?)^\]", text, re.DOTALL)
    needed = re.findall(r'"(.+)"', listed)
    # The action's Python is newer than the one that needs this.
    assert names(needed) - {"tomli"} <= names(pins)
    # The hook's environment: nothing heavy may come in unseen.
    validators = {"jsonschema", "jsonschema-rs"}
    assert names(needed) == {*validators, "lxml", "pyyaml", "rich", "tomli", "xacro"}


@pytest.mark.deep
@pytest.mark.parametrize(
    ("document", "inputs", "code"),
    [
        pytest.param(GOOD, {}, 0, id="good"),
        pytest.param(BAD, {}, 1, id="bad"),
        pytest.param(BAD, {"OPTIONS": "--ignore MB501"}, 0, id="options"),
        pytest.param(GOOD, {"PATHS": "nowhere; touch hacked"}, 2, id="wrong-use"),
        pytest.param(GOOD, {"OPTIONS": "$(touch hacked) `touch hacked`"}, 2, id="no-commands"),
    ],
)
def test_the_action_runs(
    document: str, inputs: dict[str, str], code: int, clone: Path, venv: Path, tmp_path: Path
) -> None:
    here = repository(tmp_path / "r", document)
    env = {
        "PYTHON": str(venv / "bin" / "python"),
        "RUNNER_TEMP": str(venv.parent),
        "GITHUB_ACTION_PATH": str(clone),
        "GITHUB_OUTPUT": str(tmp_path / "output"),
        "GITHUB_STEP_SUMMARY": str(tmp_path / "summary.md"),
        "PYTHONPATH": "",
        **{"PATHS": ".", "OPTIONS": "", **inputs},
    }
    steps = [it["run"] for it in yaml.safe_load(ACTION.read_text())["runs"]["steps"] if "run" in it]
    install, lint_step = (run([*BASH, it], here, env) for it in steps)
    assert install.returncode == 0, install.stderr
    assert bool(lint_step.returncode) == bool(code), lint_step.stderr
    assert not (here / "hacked").exists()
    assert ("::error file=urdf/rover.urdf" in lint_step.stdout) == (code == 1)
    if code < 2:
        name, _, report = (tmp_path / "output").read_text().strip().partition("=")
        assert name == "sarif"
        assert json.loads(Path(report).read_text())["version"] == "2.1.0"


@pytest.mark.deep
@pytest.mark.parametrize(
    ("document", "paths", "failed"),
    [
        pytest.param(GOOD, ".", [], id="good"),
        pytest.param(BAD, ".", ["Lint"], id="bad"),
        pytest.param(BAD, "urdf urdf/rover.urdf", ["Lint"], id="paths"),
        pytest.param(GOOD, "nowhere", ["Report", "Keep the report"], id="wrong-use"),
    ],
)
def test_the_github_workflow_runs(
    document: str, paths: str, failed: list[str], clone: Path, venv: Path, tmp_path: Path
) -> None:
    here = repository(tmp_path / "r", document)
    summary = tmp_path / "summary.md"
    env = job_env(clone, venv, PATHS=paths, GITHUB_STEP_SUMMARY=str(summary))
    ran = run_workflow(here, env)
    assert ran.failed == failed, ran.printed
    if "Report" in failed:
        return
    annotation = rf"(?m)^::error file=urdf/rover.urdf,line=1,col=\d+,title={FOUND} several-roots::"
    assert bool(re.search(annotation, ran.printed)) == (document == BAD)
    (log,) = json.loads((here / "urdf-lint.sarif").read_text())["runs"]
    errors = [it["ruleId"] for it in log["results"] if it["level"] == "error"]
    assert errors == ([FOUND] if document == BAD else [])
    assert ("| 1 | error | MB501 several-roots |" in summary.read_text()) == (document == BAD)


@pytest.mark.deep
@pytest.mark.parametrize(("document", "code"), [(GOOD, 0), (BAD, 1)], ids=["good", "bad"])
def test_the_gitlab_job_runs(
    document: str, code: int, clone: Path, venv: Path, tmp_path: Path
) -> None:
    here = repository(tmp_path / "r", document)
    (job,) = yaml.safe_load(GITLAB).values()
    assert set(job["variables"]) == {"URDF_LINT"}
    done = run([*BASH, "\n".join(job["script"])], here, job_env(clone, venv))
    assert done.returncode == code, done.stderr
    report: list[dict[str, Any]] = json.loads((here / "gl-code-quality-report.json").read_text())
    serious = [it["location"]["path"] for it in report if it["severity"] != "info"]
    assert serious == ["urdf/rover.urdf"] * code


@pytest.fixture(scope="session")
def workspace_tmp(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("workspace")


@pytest.mark.deep
@pytest.mark.parametrize(("document", "failures"), [(GOOD, 0), (BAD, 1)], ids=["good", "bad"])
def test_the_jenkins_pipeline_runs(
    document: str, failures: int, clone: Path, venv: Path, workspace_tmp: Path, tmp_path: Path
) -> None:
    here = repository(tmp_path / "r", document)
    env = job_env(clone, venv, WORKSPACE_TMP=str(workspace_tmp))
    steps = re.findall(r"\bsh '(.*)'", JENKINS)
    assert len(steps) == 2
    for step in steps:
        done = run(["sh", "-xe", "-c", step], here, env)
        assert done.returncode == 0, done.stderr
    (report,) = re.findall(r"\bjunit '(.*)'", JENKINS)
    assert JUnitXml.fromfile(str(here / report)).failures == failures


def test_the_problem_matcher_reads_what_is_printed() -> None:
    """``regexp`` is one of JavaScript; what it uses means the same in Python."""
    (task,) = json.loads(example("json", "problemMatcher"))["tasks"]
    pattern = task["problemMatcher"]["pattern"]
    folder = ROOT / "fixtures" / "lint" / "planted"
    command = [sys.executable, "-m", "multibot_rewrite.cli.urdf_lint", "plugin_joint.urdf", "-q"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    line = next(it for it in done.stdout.splitlines() if "MB211" in it)
    found = re.fullmatch(pattern["regexp"], line)
    assert found
    said = {key: found[at] for key, at in pattern.items() if key != "regexp"}
    place = {"file": "plugin_joint.urdf", "line": "120", "column": "19"}
    assert said == {**place, "severity": "warning", "code": "MB211", "message": said["message"]}
