# SPDX-License-Identifier: Apache-2.0
"""The lint as tests call it: of a text, a file or several, with settings; and its fixes.

Where each of them stands in the package is known here alone.
"""

from __future__ import annotations

from multibot_rewrite.lint.check import lint_data, lint_file
from multibot_rewrite.lint.fix import fix
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.lint.run import lint_files
from multibot_rewrite.rules.settings import ArgumentSet, Settings
