# SPDX-License-Identifier: Apache-2.0
"""``multibot completion``: a shell that reads it completes commands, options and choices."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from paths import ROOT

from multibot_rewrite.cli import completion
from multibot_rewrite.cli.declared.commands import COMMANDS
from multibot_rewrite.cli.multibot import main

PROGRAMS = ("multibot", "urdf-postfix", "urdf-lint")
SHARE = {
    "bash": "bash-completion/completions/{}",
    "zsh": "zsh/site-functions/_{}",
    "fish": "fish/vendor_completions.d/{}.fish",
}
# What bash does at a tab: the words so far, the last one to be completed.
ASK = """
source "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=()
"$(complete -p "$1" | sed 's/.*-F //; s/ .*//')" "$1"
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.mark.parametrize("shell", SHARE)
def test_what_is_printed_is_what_is_installed(shell: str, capfdbinary: Any) -> None:
    assert main(["completion", shell]) == 0
    files = (ROOT / "share" / SHARE[shell].format(it) for it in PROGRAMS)
    assert capfdbinary.readouterr().out == b"".join(it.read_bytes() for it in files)


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("shell") / "multibot.bash"
    assert main(["completion", "bash", "-o", str(path)]) == 0
    return path


@pytest.mark.parametrize(
    ("words", "some"),
    [
        (("multibot", ""), {*COMMANDS}),
        (("multibot", "completion", ""), {*SHARE}),
        (("multibot", "plan", "--lay"), {"--layout"}),
        (("urdf-postfix", "--und"), {"--undo"}),
        (("urdf-lint", "--format", "sar"), {"sarif"}),
    ],
)
def test_bash_completes_all_programs(words: tuple[str, ...], some: set[str], file: Path) -> None:
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("no bash")
    done = subprocess.run(
        [bash, "-c", ASK, "bash", file, *words], capture_output=True, text=True, check=True
    )
    assert some <= {it.strip() for it in done.stdout.splitlines()}, done.stderr


def test_where_nothing_was_installed_it_says_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A package that was copied by hand, without share/."""
    monkeypatch.setattr(completion, "__file__", str(tmp_path / "a" / "completion.py"))
    assert main(["completion", "fish"]) == 2
    said = capsys.readouterr()
    assert said.out == "" and "install it by pip or colcon" in said.err
    # share/ of a prefix is above the package, however it was installed.
    for name in PROGRAMS:
        made = tmp_path / "share" / SHARE["fish"].format(name)
        made.parent.mkdir(parents=True, exist_ok=True)
        made.write_text(f"# {name}\n")
    assert main(["completion", "fish"]) == 0
    assert capsys.readouterr().out == "".join(f"# {it}\n" for it in PROGRAMS)
