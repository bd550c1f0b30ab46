# SPDX-License-Identifier: Apache-2.0
"""What becomes of a file beside a description."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.template import FileTemplate


class Companion(NamedTuple):
    """A companion file as a template for any robot, what was read, and what only its rewrite finds."""

    template: FileTemplate
    file: NamedFile
    findings: tuple[Finding, ...] = ()
