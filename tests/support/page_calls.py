# SPDX-License-Identifier: Apache-2.0
"""What a page is made of, as tests of pages make it.

Where each of them stands in the package is known here alone.
"""

from __future__ import annotations

from multibot_rewrite.live.watching import Outcome, Verdict
from multibot_rewrite.pages.page import to_html
from multibot_rewrite.pages.page_sections import (
    concerns_of,
    css_class_of,
    has_faults,
    ids_in,
    ids_of,
    link_to,
    make_ids,
    make_sections,
    only_common,
    summarize,
    without_common,
)
from multibot_rewrite.pages.scene import (
    BRIDGE,
    Crossing,
    DrawnEdge,
    DrawnGroup,
    DrawnName,
    DrawnNode,
    FindingRow,
    Scene,
    combined_state,
    make_scene,
)
from multibot_rewrite.pages.states import (
    CLASH,
    CROSS_TALK,
    FAULTY,
    LEAK,
    MISSING,
    OK,
    UNEXPECTED,
    FrameRow,
    FrameTree,
    Targets,
    find_targets,
    make_states,
    merged,
    robots_of,
    words_of,
    worst,
)
from multibot_rewrite.pages.svg import (
    Ids,
    clipped,
    columns,
    group_svg,
    safe,
    tooltip,
    tree_svg,
    visible,
)
