# SPDX-License-Identifier: Apache-2.0
"""Descriptions as tests read them: their document, what renames them, and what is read back.

Where each of them stands in the package is known here alone.
"""

from __future__ import annotations

from multibot_rewrite.base.naming import LAYOUTS, Policy, make_naming, spelled
from multibot_rewrite.base.releases import NEWEST_LTS, RELEASES
from multibot_rewrite.description.readback.meeting import (
    LostRule,
    advice,
    lost_rules,
    meetings,
    said,
    same_for_all,
)
from multibot_rewrite.description.readback.nodes import BELOW, TOPIC, RuntimeName, wheels_in
from multibot_rewrite.description.readback.reading import Reading, read
from multibot_rewrite.description.rewriters.plugin_definitions import (
    TYPES,
    Definitions,
    PluginDefinition,
    library,
    load_definitions,
)
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.apply import Template, cut, fill
from multibot_rewrite.description.steps.collect import Inventory, collect, declarations
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.planning.transforms import edges_in
