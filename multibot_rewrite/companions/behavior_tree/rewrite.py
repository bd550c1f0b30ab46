"""Nav2 behavior trees for any number of robots: ports that hold services, topics and frames.

rcl remaps a name in a port like any other name of the BT navigator. ``{entry}`` is a blackboard
entry and stays; a value put into an entry is renamed like the ports of the subtrees that read it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.companions.behavior_tree.checks import included_files
from multibot_rewrite.companions.behavior_tree.ports import (
    GRAPH_KINDS,
    Port,
    is_model,
    node_name,
    port_data,
    ports_of,
)
from multibot_rewrite.companions.behavior_tree.read import named_ports, read_tree
from multibot_rewrite.companions.companion import Companion
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import SPELLERS, is_plain
from multibot_rewrite.companions.names.node_topics import FROM_NODE, spell_topic
from multibot_rewrite.companions.names.placeholders import without_robot
from multibot_rewrite.companions.template import check_no_slots, make_template
from multibot_rewrite.companions.yaml_text import Splice
from multibot_rewrite.description.steps.document import Document, value_slot

NAVIGATOR = "bt_navigator"


def rewrite_behavior_tree(data: bytes, file: str, context: Context) -> Companion:
    """A behavior tree with slots for a robot, and the findings about it.

    Raises InputError for a file that is not a behavior tree.
    """
    document = read_tree(data, file)
    check_no_slots(data.decode(), file)
    ports = list(ports_of(document))
    splices = [*_value_splices(document, context, ports), *_default_splices(document, context)]
    found = tuple(included_files(document, ports))
    named = named_ports(document, context, ports)
    return Companion(make_template(data.decode(), splices), found, named)


def _new_text(context: Context, kind: str, value: str) -> str:
    value = without_robot(value, "/" if kind in GRAPH_KINDS else "")
    if kind in GRAPH_KINDS:
        # Written out even if a rule would do: rules do not reach the navigator's helper nodes.
        return spell_topic(context, NAVIGATOR, GRAPH_KINDS[kind], value, FROM_NODE, {}).text
    if not is_plain(value):
        return value
    return SPELLERS[kind](context, value)


def _value_splices(document: Document, context: Context, ports: Iterable[Port]) -> Iterator[Splice]:
    for port in ports:
        new = _new_text(context, port.kind, port.value) if port.kind else port.value
        if new == port.value:
            continue
        slot = value_slot(document.source, port.start, port.attribute, port.value)
        if slot is None:
            place = f"{document.file}:{port.element.sourceline}"
            raise InputError(
                f"{place}: {port.attribute} cannot be edited in place; write it on one line"
            )
        written = document.source[slot[0] : slot[1]].decode() == port.value
        text = new if written else escape(new, {'"': "&quot;", "'": "&apos;"})
        first, last = (_character(document, at) for at in slot)
        yield Splice(first, last, text)


def _default_splices(document: Document, context: Context) -> Iterator[Splice]:
    """Ports that are left out and whose default all robots would share: they are added."""
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        name = node_name(element)
        for it in port_data()["defaults"] if not is_model(element) else ():
            if it["node"] != name or it["port"] in element.attrib or it["unless"] in element.attrib:
                continue
            new = _new_text(context, it["kind"], it["value"])
            if has_release(it["releases"], context.distro) and new != it["value"]:
                at = _character(document, start + 1 + len(str(element.tag).encode()))
                yield Splice(at, at, f' {it["port"]}="{new}"')


def _character(document: Document, at: int) -> int:
    """Templates count characters, documents bytes."""
    source = document.source
    return at if source.isascii() else len(source[:at].decode())
