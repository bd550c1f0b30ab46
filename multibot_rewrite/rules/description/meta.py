# SPDX-License-Identifier: Apache-2.0
"""MB0: the lint itself: rules that crash, files that take too long, comments that suppress findings."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR, WARNING, declare

# Reported where rules are run: see ``failures``.
rule_crashed = declare("MB001", "rule-crashed", ERROR, formats=())

# Reported after all rules have run: see ``config.comments``.
unused_suppression = declare("MB002", "unused-suppression", WARNING, formats=())

# Reported when comments are read: see ``config.directives``.
broken_suppression = declare("MB003", "broken-suppression", ERROR, formats=())

# Reported when the time is over: see ``failures``.
took_too_long = declare("MB004", "took-too-long", ERROR, formats=())
