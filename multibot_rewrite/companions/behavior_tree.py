"""Nav2 behavior trees for any number of robots: ports that hold services, topics and frames.

rcl remaps a name in a port like any other name of the BT navigator. ``{entry}`` is a blackboard
entry and stays; a value put into an entry is renamed like the ports of the subtrees that read it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.sax.saxutils import escape

from multibot_rewrite.companions.context import Companion, Context
from multibot_rewrite.companions.names.by_kind import SPELLERS, is_plain
from multibot_rewrite.companions.names.node_topics import FROM_NODE, spell_topic
from multibot_rewrite.companions.names.undeclared import (
    holds_a_name,
    is_undeclared,
    renamed_names,
    undeclared_message,
)
from multibot_rewrite.companions.params.known_nodes import in_release
from multibot_rewrite.companions.template import (
    check_no_slots,
    make_template,
)
from multibot_rewrite.companions.yaml_text import Splice
from multibot_rewrite.findings.place import locate
from multibot_rewrite.findings.rule import Rule, declare
from multibot_rewrite.model import WARNING, Finding, InputError
from multibot_rewrite.rosnames import check_topic_name
from multibot_rewrite.steps.document import Document, read_document, value_slot

if TYPE_CHECKING:
    from lxml.etree import _Element

NAVIGATOR = "bt_navigator"
# <Action ID="Spin"/> is <Spin/>.
_FORMS = frozenset({"Action", "Condition", "Decorator", "Control"})
_SUBTREES = frozenset({"SubTree", "SubTreePlus"})
_SHARED = ("_autoremap", "__autoremap", "__shared_blackboard")
_MODEL = "TreeNodesModel"
_GRAPH_KINDS = {"service": "service", "topic": "topic", "action": "topic"}


class _Port(NamedTuple):
    """A value: its element, where that starts, and the kind of name; empty if that is not known."""

    element: _Element
    start: int
    attribute: str
    value: str
    kind: str


class _Trees(NamedTuple):
    """The trees of a file by id; ``braces`` is true if only ``{entry}`` is an entry (BT.CPP 4)."""

    by_id: Mapping[str, _Element]
    braces: bool


def rewrite_behavior_tree(data: bytes, file: str, context: Context) -> Companion:
    """A behavior tree with slots for a robot, and the findings about it.

    Raises InputError for a file that is not a behavior tree.
    """
    if not data.strip():
        raise InputError(f"{file}:1: the file is empty; a behavior tree starts with <root>")
    document = read_document(data, file)
    if document.root.tag != "root":
        place = f"{file}:{document.root.sourceline or 1}"
        raise InputError(f"{place}: not a behavior tree: the root is <{document.root.tag}>")
    check_no_slots(data.decode(), file)
    ports = list(_ports(document))
    splices = [*_value_splices(document, context, ports), *_default_splices(document, context)]
    return Companion(
        make_template(data.decode(), splices), tuple(_findings(document, context, ports))
    )


@cache
def _port_data() -> Mapping[str, Any]:
    import yaml

    text = files("multibot_rewrite.companions").joinpath("behavior_tree.yaml").read_text()
    return dict(yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)))


def _ports(document: Document) -> Iterator[_Port]:
    """Every literal with the kind of name it is; models for editors are left out."""
    trees = _trees(document.root)
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        if _is_model(element):
            yield from _model_default(element, start, trees)
            continue
        for attribute, value in element.items():
            if not _blackboard_entry(element, str(value), trees):
                kind = _kind(element, str(attribute), trees)
                yield _Port(element, start, str(attribute), str(value), kind)


def _trees(root: _Element) -> _Trees:
    found = {str(it.get("ID", "")): it for it in root.iter("BehaviorTree")}
    return _Trees(found, str(root.get("BTCPP_format", "3")).startswith("4"))


def _is_model(element: _Element) -> bool:
    return element.tag == _MODEL or any(it.tag == _MODEL for it in element.iterancestors())


def _model_default(element: _Element, start: int, trees: _Trees) -> Iterator[_Port]:
    """BT.CPP takes defaults from models of subtrees; other models are for editors."""
    above = element.getparent()
    if above is None or above.tag not in _SUBTREES or "default" not in element.attrib:
        return
    name, value = str(element.get("name", "")), str(element.get("default"))
    kind = _entry_kinds(trees, str(above.get("ID", "")), ()).get(name) or _port_data()["ports"].get(
        name
    )
    yield _Port(element, start, "default", value, kind or "")


def _kind(element: _Element, attribute: str, trees: _Trees) -> str:
    """The kind of name that a literal is; empty if that is not known."""
    if element.tag == "SetBlackboard" and attribute == "value":
        tree = next((it for it in element.iterancestors("BehaviorTree")), None)
        entries = _entry_kinds(trees, str(tree.get("ID", "")) if tree is not None else "", ())
        return entries.get(str(element.get("output_key", "")).strip("{}"), "")
    if attribute in _port_data()["keep"]:
        return ""
    return _port_kind(element, attribute, trees, ())


def _port_kind(element: _Element, attribute: str, trees: _Trees, above: tuple[str, ...]) -> str:
    if element.tag in _SUBTREES:
        inside = _entry_kinds(trees, str(element.get("ID", "")), above).get(attribute)
        return inside or _port_data()["ports"].get(attribute, "")
    own = _port_data()["nodes"].get(_node_name(element), {})
    return str(own.get(attribute) or _port_data()["ports"].get(attribute, ""))


def _node_name(element: _Element) -> str:
    return str(element.get("ID", "")) if element.tag in _FORMS else str(element.tag)


def _blackboard_entry(element: _Element, value: str, trees: _Trees) -> str:
    """The blackboard entry that a value stands for; empty for a literal."""
    if value.startswith("{") and value.endswith("}"):
        return value[1:-1]
    # A plain SubTree of BT.CPP 3 maps entries by their bare names.
    return value if element.tag == "SubTree" and not trees.braces else ""


def _entry_kinds(trees: _Trees, name: str, above: tuple[str, ...]) -> dict[str, str]:
    """The kind of name in each entry that a tree reads, by its use there and in subtrees."""
    tree = trees.by_id.get(name)
    if tree is None or name in above:
        return {}
    found: dict[str, str] = {}
    for element in tree.iter("*"):
        for attribute, value in element.items():
            entry = _blackboard_entry(element, str(value), trees)
            if entry and attribute not in ("ID", "name", *_SHARED):
                kind = _port_kind(element, str(attribute), trees, (*above, name))
                found |= {entry: kind} if kind and entry not in found else {}
        if any(element.get(it) in ("true", "1") for it in _SHARED):
            below = _entry_kinds(trees, str(element.get("ID", "")), (*above, name))
            found = {**below, **found}
    return found


def _new_text(context: Context, kind: str, value: str) -> str:
    if kind in _GRAPH_KINDS:
        # Written out even if a rule would do: rules do not reach the navigator's helper nodes.
        return spell_topic(context, NAVIGATOR, _GRAPH_KINDS[kind], value, FROM_NODE, {}).text
    if not is_plain(value):
        return value
    return SPELLERS[kind](context, value)


def _value_splices(
    document: Document, context: Context, ports: Iterable[_Port]
) -> Iterator[Splice]:
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
        name = _node_name(element)
        for it in _port_data()["defaults"] if not _is_model(element) else ():
            if it["node"] != name or it["port"] in element.attrib or it["unless"] in element.attrib:
                continue
            new = _new_text(context, it["kind"], it["value"])
            if in_release(it["distros"], context.distro) and new != it["value"]:
                at = _character(document, start + 1 + len(str(element.tag).encode()))
                yield Splice(at, at, f' {it["port"]}="{new}"')


def _character(document: Document, at: int) -> int:
    """Templates count characters, documents bytes."""
    source = document.source
    return at if source.isascii() else len(source[:at].decode())


# The rule, the message and the hint.
_Problem = tuple[Rule, str, str]


def _findings(document: Document, context: Context, ports: Iterable[_Port]) -> Iterator[Finding]:
    reported: set[tuple[str, str]] = set()
    names = renamed_names(context)
    for port in ports:
        problem = _problem_with(context, port, names)
        if problem is None or (
            problem[0] is UNDECLARED_FRAME and (port.kind, port.value) in reported
        ):
            continue
        reported.add((port.kind, port.value))
        slot = value_slot(document.source, port.start, port.attribute, port.value)
        line, column = locate(document.source, slot[0] if slot else port.start)
        rule, message, hint = problem
        yield rule.finding(message, hint, file=document.file, line=line, column=column)


def _problem_with(context: Context, port: _Port, names: frozenset[str]) -> _Problem | None:
    if port.element.tag == "include":
        message = f"includes another tree, {port.value!r}"
        return INCLUDE, message, "list that file under behavior_trees as well"
    if port.kind == "frame":
        return _frame(context, port.value)
    if port.kind in _GRAPH_KINDS:
        return _graph_name(port)
    return None if port.kind else _mention(port, names)


INCLUDE = declare(
    "MF403",
    "tree-includes-file",
    WARNING,
    what="A behavior tree includes another file.",
    why="The included file is not rewritten with this one. The names in it are then the same for all "
    "robots.",
    fix="List that file under behavior_trees as well.",
    bad="""\
<root BTCPP_format="4">
  <include path="recovery.xml"/>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Recovery"><Spin spin_dist="1.57"/></BehaviorTree>
</root>
""",
    line=2,
    formats=("tree",),
)
UNDECLARED_FRAME = declare(
    "MF401",
    "tree-undeclared-frame",
    WARNING,
    what="A frame in a behavior tree is neither in the description nor published by a known node.",
    why="It stays unchanged. The node of the tree waits for a transform that nobody publishes and fails.",
    fix="Correct the name, or let a node publish the frame with the robot's name.",
    bad="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <IsPathValid robot_base_frame="base_lnk"/>
  </BehaviorTree>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <IsPathValid robot_base_frame="base_link"/>
  </BehaviorTree>
</root>
""",
    line=3,
    formats=("tree",),
)


def _frame(context: Context, value: str) -> _Problem | None:
    if not is_undeclared(context, "frame", value):
        return None
    return UNDECLARED_FRAME, *undeclared_message(context, "frame", value)


PORT_INVALID = declare(
    "MF404",
    "tree-port-invalid",
    WARNING,
    what="The service, action or topic in a port is not a valid ROS name.",
    why="It stays unchanged. The BT navigator fails when it loads the tree, and no robot navigates.",
    fix="Correct the name: letters, digits, _ and /, and no digit at the start of a part.",
    bad="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <ClearEntireCostmap service_name="1/clear_costmap"/>
  </BehaviorTree>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <ClearEntireCostmap service_name="local_costmap/clear_entirely_local_costmap"/>
  </BehaviorTree>
</root>
""",
    line=3,
    formats=("tree",),
)


def _graph_name(port: _Port) -> _Problem | None:
    fault = check_topic_name(port.value) if is_plain(port.value) else None
    if fault is None:
        return None
    message = f"{port.value!r} is not a valid {port.kind} name: {fault.reason}"
    return PORT_INVALID, message, "it stays unchanged; correct it"


UNKNOWN_PORT = declare(
    "MF402",
    "tree-name-in-unknown-port",
    WARNING,
    what="A port or script holds a name of the robot or an absolute ROS name, but its use is not known.",
    why="It stays unchanged. If the node takes it as a frame or topic, all robots use the same one, or one "
    "that does not exist.",
    fix="If each robot needs its own, rename it by hand, or pass it in a blackboard entry such as {target}.",
    bad="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <LookAt target="lidar_link"/>
  </BehaviorTree>
</root>
""",
    good="""\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <LookAt target="{target}"/>
  </BehaviorTree>
</root>
""",
    line=3,
    formats=("tree",),
)


def _mention(port: _Port, names: frozenset[str]) -> _Problem | None:
    held = next((it for it in _words(port) if holds_a_name(it, names)), "")
    if not held:
        return None
    message = f"{port.attribute} holds the name {held!r}, but its use here is not known"
    hint = "it stays unchanged; if each robot needs its own, rename it by hand"
    return UNKNOWN_PORT, message, hint


def _words(port: _Port) -> list[str]:
    """What may be a name: the whole value, or the strings of a script."""
    known = _port_data()
    if port.attribute in known["keep"]:
        return []
    if port.attribute not in known["scripts"]:
        return [port.value]
    return [it.strip() for it in port.value.replace('"', "'").split("'")[1::2]]
