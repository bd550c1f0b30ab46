# SPDX-License-Identifier: Apache-2.0
"""Every parameter of a section -> the names in its key and value, and the kind of each."""

from typing import NamedTuple

import yaml

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.knowledge.node_entries import OWN_KINDS, PREFIX_KINDS
from multibot_rewrite.knowledge.parameters import KnownNodes, guess, is_absolute, is_below_costmap
from multibot_rewrite.knowledge.records import Branch, NodeParameters, Param
from multibot_rewrite.related_files.names.placeholders import is_robot, without_robot
from multibot_rewrite.related_files.params.sections import NO_NAME, ParamSection
from multibot_rewrite.related_files.sites import FROM_NODE, FROM_PARENT, IN_FULL, Site, slot_of
from multibot_rewrite.related_files.yaml_text import YamlText, items, names_below, refused

STRING = "tag:yaml.org,2002:str"
NULL = "tag:yaml.org,2002:null"
# Booleans for rcl, but not for PyYAML.
_BOOLEANS = frozenset("yYnN")
_NUMBER = lazy_compile(r"[-+.\d]")
# Segments of a path that hold no name of the robot.
_IDS = frozenset({"id", "*"})
# An empty prefix is replaced as well.
_TAKE_EMPTY = ("link_prefix", *PREFIX_KINDS, "no_prefix", "doubles_as_is")
_PREFIXES = ("link_prefix", *PREFIX_KINDS)
# Names below a namespace.
_BELOW = ("topic", "service", "node", "namespace")
# ~ is no text for YAML.
_ANY_TYPE = ("off", "no_prefix", *OWN_KINDS)
_NO_NAMES = frozenset(f"tag:yaml.org,2002:{it}" for it in ("int", "float", "bool"))


class SectionNames(NamedTuple):
    """What a section holds: names, known parameters by path, and other scalars and keys.

    ``unclaimed`` scalars and ``keys`` are of unknown parameters, ``kept`` ones hold no names;
    ``empty`` keys have no value, ``twice`` are repeated keys."""

    sites: list[Site]
    known: set[str]
    unclaimed: list[yaml.ScalarNode]
    empty: list[yaml.ScalarNode]
    twice: list[yaml.ScalarNode]
    keys: list[yaml.ScalarNode]
    kept: list[yaml.ScalarNode]


# The names of a section that is not looked at.
NO_NAMES = SectionNames([], set(), [], [], [], [], [])
Page = tuple[ParamSection, SectionNames]

# The branch that the path so far leads to, and the names in its keys: key, segment and kind.
_Mark = tuple[yaml.ScalarNode, int, str]
_State = tuple[Branch, tuple[_Mark, ...]]


class _Job(NamedTuple):
    """A section that is checked: what is known, the release, and what was found."""

    document: YamlText
    section: ParamSection
    known: KnownNodes
    release: str
    names: SectionNames

    @property
    def node(self) -> str:
        """The node as node sets call it: a pattern such as /**/amcl is for a node of that name."""
        path = self.section.path
        return path.rpartition("/")[2] if self.section.wild else path


def find_names(
    document: YamlText, section: ParamSection, known: KnownNodes, release: str
) -> SectionNames:
    """Return the names in all parameters of a section; InputError for keys that are not scalars."""
    names = SectionNames([], set(), [], [], [], [], [])
    tree = section.node.tree if section.node else known.anywhere
    _walk_mapping(_Job(document, section, known, release, names), section.body, [(tree, ())])
    return names


def params_at(node: NodeParameters, name: str, key: yaml.ScalarNode) -> list[Param]:
    """Return the known parameters with this dotted name, in this release or another."""
    return [
        param for branch, _ in _children([(node.tree, ())], name, key) for param in branch.params
    ]


def _walk_mapping(job: _Job, body: yaml.MappingNode, states: list[_State]) -> None:
    seen = set()
    for key, value in body.value:
        if not isinstance(key, yaml.ScalarNode):
            raise refused(job.document, key, NO_NAME)
        if key.value in seen:
            job.names.twice.append(key)
        seen.add(key.value)
        below = _children(states, key.value, key) if states else states
        if not below:
            job.names.keys.append(key)
        if inner := names_below(value):
            _walk_mapping(job, inner, below)
        # Most parameters are numbers that hold no name.
        elif below or value.tag not in _NO_NAMES:
            _claim_parameter(job, key, value, below, body)


def _children(states: list[_State], word: str, key: yaml.ScalarNode, at: int = 0) -> list[_State]:
    """Return the places in the tree of known parameters that a key leads to from ``states``."""
    if "." in word:
        for place, part in enumerate(word.split(".")):
            states = _children(states, part, key, place)
        return states
    found: list[_State] = []
    for branch, marks in states:
        child = branch.exact.get(word)
        if child:
            found.append((child, marks))
        stem = word.rstrip("0123456789")
        if stem != word and stem in branch.numbered:
            found.append((branch.numbered[stem], marks))
        for kind, child in branch.wild.items():
            found.append((child, marks if kind in _IDS else (*marks, (key, at, kind))))
    return found


def _claim_parameter(
    job: _Job, key: yaml.ScalarNode, value: yaml.Node, states: list[_State], layer: yaml.MappingNode
) -> None:
    """Record the names in one parameter: known, guessed or unclaimed."""
    names = job.names
    if value.tag == NULL and not value.value:
        names.empty.append(key)
    param = None
    for branch, marks in states:
        if branch.params:
            param = branch.params[0]
            names.known.add(param.path)
            names.sites.extend(_key_site(it, param) for it in marks)
            break
    if param is None or param.kind != "keep":
        reach = FROM_NODE
        if param and param.absolute:
            plugin = next((str(it.value) for key, it in layer.value if key.value == "plugin"), "")
            outside = is_absolute(param, job.release) or is_below_costmap(plugin)
            reach = IN_FULL if outside else FROM_PARENT
        _value_sites(job, key, items(value), param, reach)
    else:
        names.kept.extend(it for it in items(value) if isinstance(it, yaml.ScalarNode))


def _key_site(mark: _Mark, param: Param) -> Site:
    key, segment, kind = mark
    words = str(key.value).split(".")
    at, size = sum(len(it) + 1 for it in words[:segment]), len(words[segment])
    text = _without_robot(words[segment], kind)
    site = Site(kind, text, str(key.value), slot_of(key), at, size, in_key=True, param=param)
    return site._replace(together=id(key))


def _value_sites(
    job: _Job, key: yaml.ScalarNode, scalars: list[yaml.Node], param: Param | None, reach: str
) -> None:
    kind = param.kind if param else ""
    # The releases in which the node takes off a slash that a frame starts with.
    strips = job.section.node.strips if job.section.node else ""
    is_stripped = bool(strips) and has_release(strips, job.release)
    for scalar in scalars:
        if not isinstance(scalar, yaml.ScalarNode):
            continue
        # Some kinds may hold booleans and numbers.
        text = str(scalar.value) if kind in _ANY_TYPE else name_in(scalar)
        if not text and not (scalar.style and kind in _TAKE_EMPTY):
            continue
        kind = kind or guess(job.known, key.value)
        if not kind:
            job.names.unclaimed.append(scalar)
            continue
        made = Site(kind, _without_robot(text, kind), str(key.value), slot_of(scalar))
        bare = kind == "frame" and is_stripped
        site = made._replace(is_sure=param is not None, together=id(key), bare=bare, param=param)
        job.names.sites.append(site._replace(node=job.node, reach=reach))


def _without_robot(text: str, kind: str) -> str:
    """Return a name as it is for one robot, without a placeholder; empty for a prefix of the robot."""
    if kind in _PREFIXES and is_robot(text):
        return ""
    return without_robot(text, "/" if kind in _BELOW else "")


def name_in(scalar: yaml.ScalarNode) -> str:
    """Return the text of a scalar if rcl reads it as a string; otherwise empty."""
    text = str(scalar.value)
    if scalar.tag != STRING or (text in _BOOLEANS and not scalar.style):
        return ""
    if scalar.style or not _NUMBER.match(text):
        return text
    try:
        # 1e-9 is a string for PyYAML and a number for rcl.
        float(text)
    except ValueError:
        return text
    return ""
