# SPDX-License-Identifier: Apache-2.0
"""C++ -> its syntax nodes; an expression -> its text, with unknown parts in <>. Imports tree-sitter.

Which functions hand a text on is data: ``SAME_TEXT``, ``LAST_TEXT``; each kind of syntax has a
function in ``TEXTS``."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.producers.sources.records import braced

if TYPE_CHECKING:
    from tree_sitter import Node, Parser, QueryCursor

__all__ = ("Node",)

MAKERS = ("make_shared", "make_unique", "allocate_shared")
# Their first argument is the text that they give back.
SAME_TEXT = (
    *("string", "c_str", "str", "to_string", "move", "getString", "topicResolve", "ParameterValue"),
    *("static_pointer_cast", "dynamic_pointer_cast"),
    *("resolve_topic_or_service_name", "expand_topic_or_service_name"),
)
LAST_TEXT = ("joinWithParentNamespace", "resolve_topic_name", "append")
NAMES_PARAMETER = lazy_compile(r"(get|declare|add)\w*[pP]aram(eter)?(_if_not_declared|_or)?")
LONGEST_NAME = 80
MESSAGE = lazy_compile(r"::(msg|srv|action)::")
_SCOPE = lazy_compile(r"\b(?:\w+(?:<[^<>]*>)?::)+(?=\w)")
_NODE = lazy_compile(
    r"<(this|\w*[nN]ode\w*|nh_?|n_?|parent\w*|shared_from_this|\w*interface\w*|Node:.*)>"
)


def text_of(node: Node | None) -> str:
    """Return the source text, on one line."""
    return " ".join((node.text or b"").decode("utf-8", "replace").split()) if node else ""


def last(name: str) -> str:
    """Return the last name without template arguments: ``a::B<c::D>`` -> ``B``."""
    return name.partition("<")[0].rpartition("::")[2].strip(" &*")


def template_arguments(type_: str) -> tuple[str, ...]:
    """Return the arguments of a template: ``a::B<c::D, E<F, G>>`` -> ``c::D``, ``E<F, G>``."""
    inside = type_.partition("<")[2].rpartition(">")[0]
    found, depth, start = [], 0, 0
    for at, sign in enumerate(inside):
        depth += (sign in "<(") - (sign in ">)")
        if sign == "," and not depth:
            found.append(inside[start:at].strip())
            start = at + 1
    return tuple(part for part in (*found, inside[start:].strip()) if part)


def is_node(text: str) -> bool:
    """Return whether an argument is a node, or a part of one."""
    return _NODE.fullmatch(text) is not None


def evaluated(node: Node | None) -> str:
    """Return an expression as a text; unknown parts are in <>."""
    if node is None:
        return "<?>"
    if node.type in TEXTS:
        return TEXTS[node.type](node)
    text = text_of(node)
    return f"<{_SCOPE.sub('', text)}>" if len(text) <= LONGEST_NAME else "<?>"


def arguments_of(node: Node | None) -> tuple[str, ...]:
    """Return the arguments of a call, each as a text."""
    if node is None:
        return ()
    return tuple(evaluated(it) for it in node.named_children if it.type != "comment")


def dotted(node: Node | None) -> list[str]:
    """Return the words of ``t.header.frame_id``; none for another expression."""
    if node is None or node.type not in ("field_expression", "identifier", "pointer_expression"):
        return []
    if node.type == "identifier":
        return [text_of(node)]
    if node.type == "pointer_expression":
        return dotted(node.child_by_field_name("argument"))
    above = dotted(node.child_by_field_name("argument"))
    return [*above, text_of(node.child_by_field_name("field"))] if above else []


def callee(function: Node) -> tuple[str, tuple[str, ...], str]:
    """Return (last name, template arguments, object whose method it is) of what is called."""
    full, on = text_of(function), ""
    if function.type == "field_expression":
        on = evaluated(function.child_by_field_name("argument"))
        full = text_of(function.child_by_field_name("field"))
    full = full.removeprefix("template ")
    if MESSAGE.search(full.partition("<")[0]):
        return "", (), ""
    full = full.removeprefix((_SCOPE.match(full) or [""])[0])
    return last(full), template_arguments(full), "" if on == "<this>" else on


def _text_of_field(field: str) -> Callable[[Any], str]:
    """Return a function that returns the text of a node's field."""
    return lambda node: evaluated(node.child_by_field_name(field))


def _text_of_children(node: Node) -> str:
    return "".join(evaluated(it) for it in node.named_children)


def _text_of_call(node: Node) -> str:
    """Return the value of a call, such as ``<@parameter>`` or ``<new Class>``."""
    function, arguments = (node.child_by_field_name(it) for it in ("function", "arguments"))
    if function is None:
        return "<?>"
    name, types, on = callee(function)
    given = arguments_of(arguments)
    made = last(types[0]) if types else last(text_of(function).rpartition("::")[0])
    if name in MAKERS and made.endswith("Node"):
        return f"<Node:{braced(given[0]) if given else ''}>"
    if NAMES_PARAMETER.fullmatch(name):
        texts = [it for it in given if not is_node(it)]
        return f"<@{braced(texts[0])}>" if texts else "<?>"
    if name in MAKERS and types:
        return f"<new {made}>"
    # The text that a function gives back.
    same = ""
    if name.startswith(("as_", "get_value", "value")) and "@" in on:
        same = on
    elif name in LAST_TEXT and given:
        same = given[-1]
    elif name in SAME_TEXT:
        same = given[0] if given else on
    return same or f"<{name}>"


TEXTS: dict[str, Callable[[Any], str]] = {
    "string_literal": lambda node: text_of(node)[1:-1],
    "user_defined_literal": lambda node: evaluated(node.named_children[0]),
    "concatenated_string": _text_of_children,
    "initializer_list": _text_of_children,
    "compound_literal_expression": _text_of_field("value"),
    "binary_expression": lambda node: (
        _text_of_children(node) if any(it.type == "+" for it in node.children) else "<?>"
    ),
    "parenthesized_expression": _text_of_children,
    "pointer_expression": _text_of_field("argument"),
    "new_expression": lambda node: f"<new {last(text_of(node.child_by_field_name('type')))}>",
    "conditional_expression": lambda node: "<either>",
    "field_expression": lambda node: (
        f"<{'.'.join(dotted(node)) or text_of(node.child_by_field_name('field'))}>"
    ),
    "call_expression": _text_of_call,
}


INSTALL = "pip install 'multibot_rewrite[sources]'"


def or_read() -> str:
    """Return the end of a hint on how to read more nodes; empty if C++ can be read already."""
    here = find_spec("tree_sitter") and find_spec("tree_sitter_cpp")
    return "" if here else f", or read those in C++ from their source: {INSTALL}"


def nodes_of(text: str, kinds: tuple[str, ...]) -> list[Node]:
    """Return nodes of these kinds in order, inner first; raises UsageError without tree-sitter."""
    parser, query = _tools(kinds)
    tree = parser.parse(text.encode())
    found = query.captures(tree.root_node).get("found", ())
    return sorted(found, key=lambda it: (it.start_byte, it.end_byte))


@cache
def _tools(kinds: tuple[str, ...]) -> tuple[Parser, QueryCursor]:
    """Return the parser, and the query for these kinds."""
    try:
        import tree_sitter
        import tree_sitter_cpp
    except ImportError:
        raise UsageError(f"reading C++ needs tree-sitter; {INSTALL}") from None
    language = tree_sitter.Language(tree_sitter_cpp.language())
    query = tree_sitter.Query(language, "\n".join(f"({kind}) @found" for kind in kinds))
    return tree_sitter.Parser(language), tree_sitter.QueryCursor(query)
