# SPDX-License-Identifier: Apache-2.0
"""All pages that are made with the site, and where links of written pages to them lead."""

from __future__ import annotations

import re
from collections.abc import Mapping

from tools.pages import (
    commands,
    findings,
    fleet_keys,
    interfaces,
    lint_triage,
    nodes,
    parameters,
    plugins,
    upstream,
)

# The written page whose sections stand for the made ones: on GitHub a link leads there.
STANDS_FOR = "reference.md"
# A section of it -> the page on the site.
SECTIONS = {
    "commands": "commands.md",
    "keys-of-the-fleet-file": "fleet-keys.md",
    "findings": "findings/index.md",
    "lint-rules": "findings/index.md",
    "plugins": "plugins/index.md",
    "known-nodes": "known-nodes.md",
    "known-parameters": "known-parameters.md",
    "interfaces": "interfaces.md",
    "judgements": "lint-triage.md",
    "errors-of-public-files": "upstream.md",
}
_CODE = re.compile(r"M[A-Z]\d{3}")


def every_page() -> dict[str, str]:
    """Path below docs/ -> Markdown."""
    return {
        "commands.md": commands.page(),
        "fleet-keys.md": fleet_keys.page(),
        "known-nodes.md": nodes.page(),
        "known-parameters.md": parameters.page(),
        "interfaces.md": interfaces.page(),
        "lint-triage.md": lint_triage.page(),
        "upstream.md": upstream.page(),
        **findings.pages(),
        **plugins.pages(),
    }


def meant(words: str, section: str, pages: Mapping[str, object]) -> str:
    """Return the page that a link to a section of ``reference.md`` leads to on the site: that of a
    code if its words are one; empty where the section stands for none."""
    own = f"findings/{words}.md"
    if _CODE.fullmatch(words) and own in pages:
        return own
    return SECTIONS.get(section, "")
