# SPDX-License-Identifier: Apache-2.0
"""``changed_since`` with real repositories: commits, working tree, includes, odd names, no git."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from multibot_rewrite import UsageError
from multibot_rewrite.lint.config.changed import changed_since

pytestmark = pytest.mark.more

ROBOT = '<robot name="r"><link name="a"/></robot>'
XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">{}</robot>'


def git(folder: Path, *words: str) -> str:
    who = ["-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "commit.gpgsign=false"]
    allow = ["-c", "protocol.file.allow=always"]
    done = subprocess.run(
        ["git", *who, *allow, *words], cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout


def write(folder: Path, **files: str) -> None:
    for name, text in files.items():
        put(folder, name, text)


def put(folder: Path, name: str, text: str = ROBOT) -> None:
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text)


def commit(folder: Path, message: str = "m") -> None:
    git(folder, "add", "-A")
    git(folder, "commit", "-qm", message)


def including(*names: str) -> str:
    return XACRO.format("".join(f'<xacro:include filename="{name}"/>' for name in names))


@pytest.fixture
def repo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a repository with two committed files on the branch main, the working directory."""
    for name in [it for it in os.environ if it.startswith("GIT_")]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    folder = tmp_path / "repo"
    folder.mkdir()
    git(folder, "init", "-q", "-b", "main")
    put(folder, "a.urdf")
    put(folder, "b.urdf")
    commit(folder)
    monkeypatch.chdir(folder)
    return folder


def every(folder: Path) -> list[str]:
    """Return the descriptions in a folder, as the command finds them."""
    found = (it for it in folder.rglob("*") if it.suffix in (".urdf", ".xacro", ".srdf"))
    return sorted(os.path.relpath(it) for it in found)


def test_nothing_changed_is_nothing(repo: Path) -> None:
    assert changed_since("main", ["a.urdf", "b.urdf"]) == []
    assert changed_since("main", []) == []


def test_the_working_tree_and_the_index_count(repo: Path) -> None:
    put(repo, "b.urdf", "other")
    assert changed_since("HEAD", ["a.urdf", "b.urdf"]) == ["b.urdf"]
    git(repo, "add", "-A")
    assert changed_since("HEAD", ["a.urdf", "b.urdf"]) == ["b.urdf"]
    put(repo, "b.urdf")  # back again, the index aside
    assert changed_since("HEAD", ["a.urdf", "b.urdf"]) == []


def test_new_and_ignored_files_count(repo: Path) -> None:
    put(repo, "new/c.urdf")
    put(repo, "made/d.urdf")
    put(repo, ".gitignore", "made/\n")
    assert changed_since("main", every(repo)) == ["made/d.urdf", "new/c.urdf"]


def test_commits_count_from_where_the_branches_parted(repo: Path) -> None:
    git(repo, "checkout", "-qb", "work")
    put(repo, "a.urdf", "mine")
    commit(repo)
    git(repo, "checkout", "-q", "main")
    put(repo, "b.urdf", "theirs")
    commit(repo)
    git(repo, "tag", "v1")
    git(repo, "checkout", "-q", "work")
    for rev in ("main", "v1", "HEAD~1", git(repo, "rev-parse", "main").strip(), "main@{0}"):
        assert changed_since(rev, ["a.urdf", "b.urdf"]) == ["a.urdf"]


def test_renamed_and_deleted_files(repo: Path) -> None:
    git(repo, "mv", "a.urdf", "c.urdf")
    (repo / "b.urdf").unlink()
    assert changed_since("main", every(repo)) == ["c.urdf"]
    commit(repo)
    assert changed_since("HEAD~1", every(repo)) == ["c.urdf"]
    assert changed_since("HEAD", every(repo)) == []


ODD = ["with space.urdf", "q'uo\"te.urdf", "grün.urdf", "日本/x.urdf", "new\nline.urdf", "-a.urdf"]


@pytest.mark.parametrize("name", ODD)
def test_odd_names(repo: Path, name: str) -> None:
    put(repo, name)
    commit(repo)
    assert changed_since("HEAD", [name]) == []
    assert changed_since("HEAD~1", [name, "a.urdf"]) == [name]
    put(repo, name, "other")
    assert changed_since("HEAD", [name, "a.urdf"]) == [name]


def test_a_name_that_is_no_text(repo: Path) -> None:
    name = os.fsdecode(b"\xff.urdf")
    put(repo, name)
    commit(repo)
    assert changed_since("HEAD~1", [name, "a.urdf"]) == [name]
    assert changed_since("HEAD", [name]) == []


def test_from_a_subfolder_and_however_a_path_is_written(
    repo: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put(repo, "sub/c.urdf")
    put(repo, "sub/d.urdf")
    commit(repo)
    put(repo, "sub/c.urdf", "other")
    put(repo, "a.urdf", "other")
    git(repo, "config", "diff.relative", "true")
    monkeypatch.chdir(repo / "sub")
    ways = ["c.urdf", "./c.urdf", "../sub/c.urdf", str(repo / "sub" / "c.urdf"), "../a.urdf"]
    assert changed_since("HEAD", [*ways, "d.urdf", "../b.urdf", str(repo / "b.urdf")]) == ways


def test_outside_of_the_repository_git_cannot_tell(repo: Path, tmp_path: Path) -> None:
    put(tmp_path, "out.urdf")
    assert changed_since("HEAD", ["../out.urdf", "a.urdf"]) == ["../out.urdf"]


def test_links_count_where_they_stand_and_where_they_lead(repo: Path, tmp_path: Path) -> None:
    (repo / "link.urdf").symlink_to("a.urdf")
    (tmp_path / "way").symlink_to(repo)
    commit(repo)
    files = ["link.urdf", "../way/a.urdf", "../way/b.urdf"]
    assert changed_since("HEAD", files) == []
    put(repo, "a.urdf", "other")
    assert changed_since("HEAD", files) == ["link.urdf", "../way/a.urdf"]
    git(repo, "checkout", "a.urdf")
    (repo / "link.urdf").unlink()
    (repo / "link.urdf").symlink_to("b.urdf")
    assert changed_since("HEAD", files) == ["link.urdf"]


def test_repositories_in_the_repository(repo: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.mkdir()
    git(other, "init", "-q")
    put(other, "c.urdf")
    put(other, "part.xacro", XACRO.format(""))
    commit(other)
    git(repo, "submodule", "--quiet", "add", str(other), "sub")
    put(repo, "top.xacro", including("$(find other)/part.xacro"))
    commit(repo)
    files = ["a.urdf", "sub/c.urdf", "top.xacro"]
    assert changed_since("HEAD", files) == []
    put(repo, "sub/c.urdf", "other")
    git(repo, "config", "diff.ignoreSubmodules", "all")
    assert changed_since("HEAD", files) == ["sub/c.urdf", "top.xacro"]
    git(repo / "sub", "checkout", "c.urdf")
    (repo / "own").mkdir()
    git(repo / "own", "init", "-q")
    put(repo, "own/d.urdf")
    commit(repo / "own")
    assert changed_since("HEAD", [*files, "own/d.urdf"]) == ["own/d.urdf"]


# Files of a repository, the one that changes, the xacro files that count as changed with it.
INCLUDES: list[tuple[dict[str, str], str, list[str]]] = [
    ({"top.xacro": including("part.xacro")}, "part.xacro", ["part.xacro", "top.xacro"]),
    ({"top.xacro": including("b.xacro")}, "part.xacro", ["part.xacro"]),
    (
        {"top.xacro": including("$(find r)/urdf/part.xacro")},
        "urdf/part.xacro",
        ["top", "urdf/part"],
    ),
    ({"top.xacro": including("${d['x']}/part.xacro")}, "part.xacro", ["part", "top"]),
    ({"top.xacro": including("$(arg kind).xacro")}, "part.xacro", ["part", "top"]),
    ({"top.xacro": including("${kind}_part.xacro")}, "my_part.xacro", ["my_part", "top"]),
    ({"top.xacro": including("${kind}_part.xacro")}, "other.xacro", ["other"]),
    ({"top.xacro": including("${file}")}, "README.md", ["top"]),
    ({"top.xacro": including("parts/*.xacro")}, "parts/a.xacro", ["parts/a", "top"]),
    ({"top.xacro": including("pa&#x72;t.xacro")}, "part.xacro", ["part", "top"]),
    ({"top.xacro": including("part.gazebo")}, "part.gazebo", ["top"]),
    (
        {"top.xacro": including("mid.xacro"), "mid.xacro": including("low.xacro")},
        "low.xacro",
        ["low", "mid", "top"],
    ),
    (
        {"top.xacro": including("${x}_mid.txt"), "the_mid.txt": including("low.xacro")},
        "low.xacro",
        ["low", "top"],
    ),
    (
        {"top.xacro": including("mid.xacro"), "mid.xacro": including("top.xacro", "low.xacro")},
        "low.xacro",
        ["low", "mid", "top"],
    ),
    ({"top.xacro": XACRO.replace("{}", "${xacro.load_yaml(f)}")}, "config/x.yaml", ["top"]),
    ({"top.xacro": XACRO.replace("{}", "${load_yaml(f)}")}, "config/x.txt", []),
    (
        {"top.xacro": "<xacro:include\n ns='n'\n filename = 'part.xacro' />"},
        "part.xacro",
        ["part", "top"],
    ),
    ({"r.srdf": ROBOT, "c.urdf": ROBOT}, "a.urdf", ["a.urdf", "r.srdf"]),
    ({"r.srdf": ROBOT, "c.urdf": ROBOT}, "x.yaml", []),
    (
        {"r.srdf": ROBOT, "top.xacro": including("part.gazebo")},
        "part.gazebo",
        ["r.srdf", "top.xacro"],
    ),
]


@pytest.mark.sample(5)
@pytest.mark.parametrize("how", ["changed", "deleted", "new"])
@pytest.mark.parametrize(("files", "name", "wanted"), INCLUDES)
def test_who_reads_a_changed_file_changed(
    repo: Path, files: dict[str, str], name: str, wanted: list[str], how: str
) -> None:
    for file, text in files.items():
        put(repo, file, text)
    if how != "new":
        put(repo, name, "<before/>")
    commit(repo)
    if how == "deleted":
        (repo / name).unlink()
    else:
        put(repo, name, "<after/>")
    found = changed_since("HEAD", every(repo))
    whole = {it if "." in it else f"{it}.xacro" for it in wanted}
    assert set(found) == (whole - {name} if how == "deleted" else whole)


def test_an_included_file_that_moved_away(repo: Path) -> None:
    put(repo, "top.xacro", including("$(find r)/part.xacro"))
    put(repo, "part.xacro")
    commit(repo)
    git(repo, "mv", "part.xacro", "moved.xacro")
    assert changed_since("HEAD", every(repo)) == ["moved.xacro", "top.xacro"]


def test_an_ignored_file_beside_is_read(repo: Path) -> None:
    put(repo, ".gitignore", "made.xacro\n")
    put(repo, "top.xacro", including("made.xacro"))
    put(repo, "made.xacro", including("low.xacro"))
    put(repo, "low.xacro")
    commit(repo)
    assert changed_since("HEAD", ["top.xacro", "low.xacro"]) == ["top.xacro"]


def test_what_cannot_be_read_is_left_to_the_lint(repo: Path) -> None:
    (repo / "dead.xacro").symlink_to("nowhere")
    commit(repo)
    assert changed_since("HEAD", ["dead.xacro", "gone.xacro"]) == ["dead.xacro", "gone.xacro"]


REVISIONS = [
    ("nowhere", "git does not know the revision 'nowhere'"),
    ("", "'' is not a revision"),
    ("-x", "'-x' is not a revision"),
    ("--output=x", "'--output=x' is not a revision"),
    ("a\0b", "is not a revision"),
    ("main..HEAD", "git does not know the revision 'main..HEAD'"),
    ("main:a.urdf", "git does not know the revision"),
    ("two\nlines", "git does not know the revision 'two\\nlines'"),
]


@pytest.mark.parametrize(("rev", "words"), REVISIONS)
def test_a_wrong_revision_is_one_line(repo: Path, rev: str, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        changed_since(rev, ["a.urdf"])
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_histories_that_never_met(repo: Path) -> None:
    git(repo, "checkout", "-q", "--orphan", "new")
    git(repo, "commit", "-qm", "another beginning")
    with pytest.raises(UsageError, match="no commit in common; fetch the whole history"):
        changed_since("main", ["a.urdf"])


def test_a_repository_without_a_commit(repo: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (repo / "empty").mkdir()
    git(repo / "empty", "init", "-q")
    monkeypatch.chdir(repo / "empty")
    with pytest.raises(UsageError, match="git does not know the revision 'HEAD'"):
        changed_since("HEAD", ["../a.urdf"])


def test_no_repository_is_one_line(repo: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(repo.parent.parent))
    monkeypatch.chdir(repo.parent)
    with pytest.raises(UsageError) as caught:
        changed_since("main", ["repo/a.urdf"])
    assert str(caught.value).startswith("git reports: not a git repository")
    assert "\n" not in str(caught.value)


def test_no_work_tree_is_one_line(repo: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(repo / ".git")
    with pytest.raises(UsageError, match="git reports: this operation must be run in a work tree"):
        changed_since("main", ["../a.urdf"])


def test_no_git_is_one_line(repo: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(repo))
    with pytest.raises(UsageError, match="git cannot be run: No such file or directory; install"):
        changed_since("main", ["a.urdf"])
