# SPDX-License-Identifier: Apache-2.0
"""Rules that a description alone is asked, and a system: their words, with the example of a system."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.rules.declaration import SYSTEM, system_options

NOT_EXPORTED = declare(
    "MB229",
    "interface-not-exported",
    WARNING,
    formats=(SYSTEM,),
    options=system_options(absence=True),
)
CLAIMED_TWICE = declare(
    "MB240", "interface-claimed-twice", WARNING, formats=(SYSTEM,), options=system_options()
)
ONE_DEVICE = declare("MB412", "one-device", WARNING, formats=(SYSTEM,), options=system_options())
