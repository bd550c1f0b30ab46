# SPDX-License-Identifier: Apache-2.0
"""Why a real file is refused, and whether that is true by other means than the package's."""

from __future__ import annotations

import re
from typing import NamedTuple

from lxml import etree

from multibot_rewrite import MultibotError, RewriteRefused


class Outcome(NamedTuple):
    """What became of one file: refused with ``reason``, or ``problem`` (empty: verified)."""

    reason: str
    problem: str


def reason(error: MultibotError) -> str:
    """Code or class of an error and its message, without file, line and hint."""
    if not isinstance(error, RewriteRefused):
        text = str(error).partition(";")[0]
        return f"{type(error).__name__} {re.sub(r'^[^ ]*: |, line .*', '', text)}"
    first = next(finding for finding in error.findings if finding.level == "error")
    return f"{first.code} {first.message}"


def is_true(why: str, data: bytes) -> bool:
    """Return whether the reason holds, by other means than the package's; False if unknown."""
    if found := re.fullmatch(r"MB105 xacro element <(\w+)>", why):
        wanted = f"//*[contains(namespace-uri(), 'xacro') and local-name() = '{found[1]}']"
        return bool(etree.fromstring(data).xpath(wanted))
    if found := re.fullmatch(r"MB105 xacro substitution '(.*)'", why):
        values = etree.fromstring(data).xpath("//@*|//text()")
        return any(found[1] == " ".join(value.split()) for value in values)
    return False
