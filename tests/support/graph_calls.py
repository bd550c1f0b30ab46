# SPDX-License-Identifier: Apache-2.0
"""Graphs and plans as tests use them: read, written, looked through and judged.

Where each of them stands in the package is known here alone.
"""

from __future__ import annotations

from multibot_rewrite.live.diagnose import diagnose, survey
from multibot_rewrite.live.seen_plan import seen_plan
from multibot_rewrite.planning.plan import read_plan, to_yaml
from multibot_rewrite.rules.check import ABSENCE, RULES, absences, check, judge, side_by_side
from multibot_rewrite.system.guess import GuessedRobot, guess_robots, whose_by_guess
from multibot_rewrite.system.index import Index, beside, index
from multibot_rewrite.system.json import from_json, from_yaml, to_json
from multibot_rewrite.system.ownership import ALONE, Whose, name_ownership, whose_by_plan
from multibot_rewrite.system.parameters import questions, with_answers
