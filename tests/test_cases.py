"""Every case file, byte by byte, and what must hold for any rewrite whatever the case."""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
import yourdfpy
from case_files import Case, CaseError, load_cases, read_case
from lxml import etree

from multibot_rewrite import Rewrite, RewriteRefused, rewrite, strip
from multibot_rewrite.library import builtin_tree, rewrite_all
from multibot_rewrite.model import Edit, Site
from multibot_rewrite.naming import Naming, make_naming
from multibot_rewrite.rewriting import pipeline
from multibot_rewrite.vocabulary import Rewriter, load_vocabulary

ROBOTS = ("robot1", "robot2")
CASES = load_cases()
REWRITTEN = [case for case in CASES if case.expect != "refused"]
CHANGED = [case for case in CASES if case.expect == "changed"]
REFUSED = [case for case in CASES if case.expect == "refused"]
REWRITERS = load_vocabulary().rewriters("element", "plugin", "hardware", "sensor")
LEAST_CASES = 340
LEAST_REFEREED = 330
# Not a word of rewrite's naming policy.
NO_POLICY = ("again", "file")
