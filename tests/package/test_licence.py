# SPDX-License-Identifier: Apache-2.0
"""Each source file says its licence, as the SPDX specification has it (annex E)."""

from __future__ import annotations

import re

from paths import ROOT

LICENCE = re.findall(r'^license = "(.*)"$', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)[0]
LINE = f"# SPDX-License-Identifier: {LICENCE}\n"
FOLDERS = ("multibot_rewrite", "tools", "share", "tests", "benchmarks")


def test_each_file_begins_with_the_licence() -> None:
    files = [it for folder in FOLDERS for it in sorted((ROOT / folder).rglob("*.py"))]
    missing = [str(it.relative_to(ROOT)) for it in files if not it.read_text().startswith(LINE)]
    assert len(files) > 500
    assert missing == [], f"sed -i '1i {LINE.strip()}' {' '.join(missing)}"
