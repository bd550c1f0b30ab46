# SPDX-License-Identifier: Apache-2.0
"""urdf-lint --fix: verified, idempotent, and nothing but the edited spans is another byte."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from lint_calls import Settings, fix, lint_data
from real_robots import spread

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit, ProofError
from multibot_rewrite.cli.urdf_lint import main
from multibot_rewrite.lint import fix as fixing

SAMPLE = 120
# A prefix that is not used, twice, and a comment that suppresses nothing.
FIXABLE = (
    b'<?xml version="1.0"?>\r\n'
    b"<robot name='r' xmlns:x=\"urn:x\"\txmlns:y = 'urn:y'>\r\n"
    b"  <!-- urdf-lint: ignore MB501, MB201 - not known -->\r\n"
    b"  <link  name='a' /><!-- kept -->\r\n"
    b"</robot>"
)
FIXED = (
    b"<?xml version=\"1.0\"?>\r\n<robot name='r'>\r\n  <link  name='a' /><!-- kept -->\r\n</robot>"
)


def spliced(data: bytes, edits: set[Edit]) -> bytes:
    """Return the text with the edits made, the last first; a plain reading of what an edit is."""
    reached = len(data) + 1
    for it in sorted(edits, key=lambda it: it.start, reverse=True):
        assert it.end <= reached, "edits of one round do not overlap"
        data, reached = data[: it.start] + it.before + data[it.end :], it.start
    return data


def by_hand(path: str, data: bytes) -> bytes:
    """All rounds of edits, made without the code that is tested."""
    for _ in range(fixing.ROUNDS):
        edits = {edit for it in lint_data(path, data, Settings()) for edit in it.edits}
        if not edits:
            break
        data = spliced(data, edits)
    return data


def counted(found: list[Finding]) -> Counter[str]:
    return Counter(it.code for it in found)


def check(path: str, data: bytes) -> bool:
    """Fix a text; was there anything to fix?"""
    before = lint_data(path, data, Settings())
    fixable = Counter(it.code for it in before if it.edits)
    fixed, left = fix(path, data, Settings())
    assert (fixed != data) == bool(fixable)
    assert fixed == by_hand(path, data)
    assert fix(path, fixed, Settings()) == (fixed, left)
    assert not any(it.edits for it in left)
    assert not counted(left) - counted(before)
    assert counted(before) - counted(left) >= fixable
    return bool(fixable)


@pytest.mark.deep
def test_files_of_the_corpus(corpus: dict[str, Path]) -> None:
    # Most of what is fixed are prefixes that nothing uses.
    likely = {name: path for name, path in corpus.items() if b" xmlns:" in path.read_bytes()}
    assert sum(check(str(it), it.read_bytes()) for it in spread(likely, SAMPLE).values()) > 10


def with_edits(monkeypatch: pytest.MonkeyPatch, *edits: Edit) -> None:
    """Make the lint propose these edits, whatever it finds."""

    def lint(path: str, data: bytes, _: Settings) -> list[Finding]:
        return [Finding("MB142", "note", "m", "", path, 1, 1, edits=edits)]

    monkeypatch.setattr(fixing, "lint_data", lint)


ONE = b'<robot name="r"><link name="a"/><link name="b"/></robot>'


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (Edit(16, 32, b"", None), "would change more"),
        (Edit(17, 21, b"limb", None), "would change more"),
        (Edit(16, 16 + 16, b'<link name="a"/><link name="c"/>', None), "would change more"),
        (Edit(56, 56, b"", None), ""),
    ],
)
def test_a_fix_that_goes_too_far_is_refused(
    monkeypatch: pytest.MonkeyPatch, edit: Edit, said: str
) -> None:
    with_edits(monkeypatch, edit)
    if not said:
        assert fix("r.urdf", ONE, Settings())[0] == ONE
        return
    with pytest.raises(ProofError, match=said):
        fix("r.urdf", ONE, Settings())


def test_fixes_that_come_back_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with_edits(monkeypatch, Edit(28, 29, b"a", None))
    with pytest.raises(ProofError, match="still something to fix"):
        fix("r.urdf", ONE, Settings())


# ---------------------------------------------------------------- the command


def test_diff_shows_and_writes_nothing(tmp_path: Path, capsysbinary: object) -> None:
    file = tmp_path / "r.urdf"
    file.write_bytes(FIXABLE)
    assert main([str(file), "--fix", "--diff"]) == 1
    out, err = capsysbinary.readouterr()  # type: ignore[attr-defined]
    assert file.read_bytes() == FIXABLE
    assert b"-<robot name='r' xmlns:x" in out
    assert b"+<robot name='r'>\r\n" in out
    assert err.endswith(b"\n") and b"mended" not in err


def test_fix_writes_and_tells_what_is_left(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, other = tmp_path / "r.urdf", tmp_path / "other.urdf"
    file.write_bytes(FIXABLE.replace(b"<!-- kept -->", b"<link name='b'/>"))
    other.write_bytes(FIXED)
    file.chmod(0o640)
    assert main([str(tmp_path), "--fix"]) == 1
    out, err = capsys.readouterr()
    assert file.read_bytes().count(b"xmlns") == 0
    assert (file.stat().st_mode & 0o777, other.read_bytes()) == (0o640, FIXED)
    assert [line.split()[2] for line in out.splitlines() if "note:" not in line] == ["MB501"]
    assert f"fixed {file}" in err and "other.urdf" not in err
    for words in (["--fix"], ["--fix", "--diff"]):
        main([str(other), *words])
        assert "urdf-lint: nothing that --fix can fix\n" in capsys.readouterr().err


def test_a_second_run_has_nothing_to_do(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "r.urdf"
    file.write_bytes(FIXABLE)
    assert main([str(file), "--fix", "--quiet"]) == 0
    written = file.stat().st_mtime_ns
    capsys.readouterr()
    assert main([str(file), "--fix", "--quiet"]) == 0
    assert (file.stat().st_mtime_ns, capsys.readouterr().err) == (written, "")
