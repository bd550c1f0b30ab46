# SPDX-License-Identifier: Apache-2.0
"""Files beside a description as tests rewrite them: who is meant, and the text for a robot.

Where each of them stands in the package is known here alone.
"""

from __future__ import annotations

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_library import extend, nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.parameters import built_in_nodes, load_known_nodes
from multibot_rewrite.related_files.context import (
    NAMESPACE_SLOT,
    Context,
    fill_template,
    make_context,
    make_template,
)
from multibot_rewrite.related_files.params.rewrite import rewrite_params
from multibot_rewrite.related_files.params.sections import (
    ParamSection,
    flattened,
    identify_sections,
    is_for,
    raw_sections,
)
from multibot_rewrite.related_files.params.shared_defaults import all_sections
from multibot_rewrite.related_files.yaml_text import Splice, YamlText, quoted, read_yaml
