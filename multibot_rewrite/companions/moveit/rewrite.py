"""MoveIt's YAML files for any number of robots: the new text of their names.

MoveItConfigsBuilder reads them with PyYAML and passes them to move_group as parameters. So there are
no sections of nodes, anchors are legal, and of a repeated key the last value counts.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.companion import Companion
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.engine import name_splices, text_of
from multibot_rewrite.companions.moveit.controller_manager import inserted_namespace
from multibot_rewrite.companions.moveit.read import read_moveit
from multibot_rewrite.companions.names.node_topics import facts_by_name
from multibot_rewrite.companions.template import check_no_slots, make_template
from multibot_rewrite.companions.yaml_text import Splice, YamlText
from multibot_rewrite.knowledge.records import NodeFacts


def rewrite_moveit(
    document: YamlText, context: Context, facts: Iterable[NodeFacts] = ()
) -> Companion:
    """A MoveIt file with slots for a robot.

    Groups of an SRDF are known if they are declared (``with_srdf``); ``facts`` are those of the robot's
    nodes, whose remap rules move topics too. Raises InputError for a file that is not MoveIt's, and
    for an alias whose value would need two new names.
    """
    try:
        check_no_slots(document.text, document.file)
        file = read_moveit(document, context)
    except RecursionError:
        raise InputError(
            f"{document.file}:1: the YAML is nested too deeply for a MoveIt file"
        ) from None
    speller = partial(text_of, context, facts_by_name(facts, context.distro))
    splices = [*name_splices(file, speller), *inserted_namespace(document, context)]
    shift = [Splice(0, 0, document.bom)] if document.bom else []
    template = make_template(document.text, [*shift, *splices])
    return Companion(template, file)
