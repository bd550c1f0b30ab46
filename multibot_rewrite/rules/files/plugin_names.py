# SPDX-License-Identifier: Apache-2.0
"""Classes of plugins in parameter files, against those that packages register for pluginlib.

Sources: pluginlib class_loader_imp.hpp (``createInstance`` throws for a name that no plugin description
has); nav2_ros_common node_utils.hpp (``get_plugin_type_param``: 'plugin' param not defined);
controller_manager.cpp ('type' param was not defined, controller type does not exist).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cache

import yaml

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.nearest import MISTYPED, nearest, slip_of
from multibot_rewrite.base.releases import has_release, releases_with
from multibot_rewrite.base.wording import SEVERAL, shorten, unique
from multibot_rewrite.knowledge.declared import (
    NODE,
    Base,
    Declared,
    canonical,
    declared_by,
    packages,
    plugin_bases,
)
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.evidence.hardware import TYPE
from multibot_rewrite.related_files.named_file import NamedFile
from multibot_rewrite.related_files.params.sections import (
    MANAGER,
    ParamSection,
    RawSection,
    controller_types,
)
from multibot_rewrite.related_files.yaml_text import pairs
from multibot_rewrite.rules.declaration import at, remark_at
from multibot_rewrite.rules.description.files import values
from multibot_rewrite.rules.files.demands import Demand, demands, value_of
from multibot_rewrite.rules.files.parameter_files import of_release
from multibot_rewrite.rules.files.section_facts import (
    Section,
    Setting,
    is_set_in_other_file,
    sections,
)

_CONTROLLER = "controller_interface::ControllerInterface"
_DWB, _CRITIC = "dwb_critics", "Critic"
_CRITIC_SCOPES = {
    "dwb_core::TrajectoryCritic": _DWB,
    "mppi::critics::CriticFunction": "mppi::critics",
}


def unknown_classes(file: NamedFile) -> Iterator[Finding]:
    """Report classes that no package of the release registers, in parameters and kinematics."""
    release = file.context.distro
    known = file.known.nodes.values() if file.known else ()
    told = {type_ for node in known for type_ in node.deprecated_types}  # MB869
    for it, given, name in _named_classes(file):
        if name not in told:
            where = f"{it.section.title}: {given.name}"
            yield from _class_findings(given.node, where, name, it.words[0], release)
    for it in demands(file, "critics"):
        yield from _unknown_critics(it)
    for section in sections(file):
        own = section.whole.get(TYPE) if section.node is None and not section.at else None
        # A controller may say its class in its own section; whose class is known is a known node.
        class_ = str(own.value) if own else ""
        if own and _package(class_) in _controller_packages():
            where = f"{section.title}: {TYPE}"
            yield from _class_findings(own.node, where, class_, _CONTROLLER, release)


def classes_of_other_releases(file: NamedFile) -> list[str]:
    """Return the classes that only other releases than the file's register by exactly this name."""
    release = file.context.distro
    found = ((plugin_bases()[it.words[0]], name) for it, _, name in _named_classes(file))
    words = ((name, base.classes.get(name, "")) for base, name in found)
    return [name for name, releases in words if releases and not has_release(releases, release)]


def _named_classes(file: NamedFile) -> Iterator[tuple[Demand, Setting, str]]:
    """Yield (demand, setting, class) for the pluginlib classes that a file names."""
    for it in demands(file, "class", "classes"):
        # NAME.plugin of each word of a list.
        plugins = (f"{it.section.at}{word}.plugin" for word in words_of(it.given))
        found = [it.given] if it.check == "class" else [*map(it.section.whole.get, plugins)]
        yield from ((it, given, name) for given in found if given for name in words_of(given))


@cache
def _controller_packages() -> frozenset[str]:
    return frozenset(map(_package, plugin_bases()[_CONTROLLER].classes))


def _package(class_: str) -> str:
    return canonical(class_).partition("::")[0]


def words_of(given: Setting) -> list[str]:
    """Return the words of a list, or of a text."""
    value = given.value
    return [str(word) for word in value] if isinstance(value, list) else str(value or "").split()


def _class_findings(
    node: yaml.Node, where: str, name: str, base: str, release: str
) -> Iterator[Finding]:
    """Yield the finding about a class that no package of the release registers."""
    known = plugin_bases()[base]
    if name in known.classes and has_release(known.classes[name], release):
        return
    said, hint, level = _class_fault(name, base, known, release)
    if said:
        yield remark_at(node, f"{where} is {name!r}, {said}", hint, level)


def _class_fault(name: str, base: str, known: Base, release: str) -> tuple[str, str, str]:
    """Return (fault, hint, level) of a class that the release lacks; empty where it may exist."""
    there = [it for it, words in known.classes.items() if has_release(words, release)]
    if alike := next((it for it in there if canonical(it) == canonical(name)), ""):
        return f"which is written differently in {release}", f"write {alike}", WARNING
    if name in known.older:
        level = WARNING if name in known.ended else ERROR
        return "which ROS 2 has under another name", f"write {known.older[name]}", level
    same = next((it for it in known.classes if canonical(it) == canonical(name)), "")
    if same:
        others = ", ".join(releases_with(known.classes[same]))
        return f"which is not in {release}, only in {others}", _near_hint(name, there), WARNING
    other = next((it for it, of in plugin_bases().items() if name in of.classes), "")
    if other:
        return f"which is a {other}, not a {base}", "name a class of that kind", ERROR
    package, _, last = canonical(name).partition("::")
    if package in packages():
        # Whoever writes a class of his own may put it into the namespace of a package.
        own = [it for it in there if canonical(it).startswith(f"{package}::")]
        by_last = {canonical(it).rpartition("::")[2]: it for it in own}
        slip = by_last.get(slip_of(last.rpartition("::")[2], by_last), "")
        hint = f"did you mean {slip}?" if slip else "see the plugins of its package"
        return "which its package does not have", hint, ERROR if slip else NOTE
    slip = nearest(package, packages(), MISTYPED)
    alike = next((it for it in there if canonical(it) == f"{slip}::{last}"), "")
    # A package that is not known may have it, whatever its name is like.
    unknown = f"a class of {package}, which is not known"
    return (unknown, f"did you mean {alike}?", NOTE) if alike else ("", "", "")


def _near_hint(name: str, there: Sequence[str]) -> str:
    """Return the question whether a class with nearly this name is meant, or where to look."""
    by_name = {canonical(it): it for it in there}
    near = by_name.get(nearest(canonical(name), by_name))
    return f"did you mean {near}?" if near else "see the plugins of its package"


def _unknown_critics(it: Demand) -> Iterator[Finding]:
    """Report critics that their scope lacks; DWB adds the word Critic."""
    base = it.words[0]
    scope, known = _CRITIC_SCOPES[base], plugin_bases()[base].classes
    names = {name.rpartition("::")[2]: name for name in known}
    whole = it.section.whole
    if f"{it.section.at}default_critic_namespaces" in whole:
        return
    for word in words_of(it.given):
        plain = f"{it.section.at}{word}.class" not in whole
        short = scope == _DWB and f"{word}{_CRITIC}" in names
        if plain and word not in names and not short:
            shown = [n.removesuffix(_CRITIC) for n in names] if scope == _DWB else [*names]
            near = slip_of(word, shown)
            message = f"{it.section.title}: no critic of {scope} is called {word!r}"
            if near:
                yield remark_at(it.given.node, message, f"did you mean {near}?", ERROR)


def without_plugin(file: NamedFile) -> Iterator[Finding]:
    """Report plugin names without NAME.plugin, unset sources, and controllers without a type."""
    for it in demands(file, "classes", "blocks"):
        ids, words, whole = it.words[1:], words_of(it.given), it.section.whole
        blocks = it.check == "blocks"
        place = it.words[0] if blocks and it.words else it.given.name.rpartition(".")[0]
        above = f"{it.section.at}{place}." if place else it.section.at
        if blocks and it.words and not any(name.startswith(above) for name in whole):
            continue  # MoveItConfigsBuilder adds its own of all planners where a file has none
        for word in [] if words == [*ids] else words:
            below = f"{above}{word}."
            given = blocks and any(name.startswith(below) for name in whole)
            found = given or f"{below}plugin" in whole
            elsewhere = not found and is_set_in_other_file(file, it.section.title, f"{below}plugin")
            if not found and not elsewhere and not _is_misspelt(it, word, words):
                what = "parameters" if blocks else "plugin"
                message = f"{it.section.title}: {it.given.name} has {word}, which has no {what}"
                name = below + "plugin" if what == "plugin" else below.rstrip(".")
                # Another parameter file, or the launch file, may have it.
                hint = f"add {name}, or take {word} off the list"
                yield remark_at(it.given.node, message, hint, WARNING)
    yield from _without_type(file)


def _is_misspelt(it: Demand, word: str, words: Sequence[str]) -> bool:
    """Return whether parameters have a similar name: MB877 reports that one."""
    own = {name.removeprefix(it.section.at).partition(".")[0] for name in it.section.whole}
    return bool(nearest(word, own - set(words)))


def _without_type(file: NamedFile) -> Iterator[Finding]:
    """Report controllers that a manager's section names without a type."""
    raw = [RawSection(*it[:3]) for it, _ in file.pages]
    types = controller_types(raw)
    own = {fact.path.partition(".")[0] for fact in declared_by(MANAGER)}
    typed = {
        it.path.rpartition("/")[2]
        for it in raw
        if any(k.value == "type" for k, _ in pairs(it.body))
    }
    for section in raw:
        if section.path.rpartition("/")[2] != MANAGER:
            continue
        for key, body in pairs(section.body):
            free = isinstance(body, yaml.MappingNode) and key.value not in own
            # A plugin is hardware, which no manager looks for here.
            free = free and all(it.value != "plugin" for it, _ in pairs(body))
            if free and key.value not in types and key.value not in typed:
                message = f"{section.path}: controller {key.value} has no type"
                # A spawner may be told the type, too.
                yield remark_at(key, message, f"add {key.value}.type: PACKAGE/CLASS", WARNING)


def renamed_nodes(file: NamedFile) -> Iterator[Finding]:
    """Report sections of nodes that have another name since a release before Humble."""
    now = plugin_bases()[NODE].older
    for name, section in older_nodes(file):
        message = f"no supported release has a node {name}: it is called {now[name]}"
        yield remark_at(section.keys[-1], message, f"write {now[name]}")


def older_nodes(file: NamedFile) -> Iterator[tuple[str, ParamSection]]:
    """Yield sections, with their names, of nodes that only releases before Humble call so."""
    for section, _ in file.pages:
        name = section.path.rpartition("/")[2]
        if name in plugin_bases()[NODE].older:
            yield name, section


def missing_parameters(file: NamedFile) -> Iterator[Finding]:
    """Yield the required parameters that are not set: always, in a block, or with another parameter."""
    for section in sections(file):
        facts = of_release(section.facts, file.context.distro)
        needed = [(it, words) for it in facts for check, words in it.checks if check == "required"]
        found = [it for fact, words in needed for it in _not_set(file, section, fact, words)]
        # What a controller has under another name is misspelt, or it is of another class that is called
        # the same; a section with nothing of it adds to one of another file.
        unknown = [it for it, known in section.known if not known and it.name != TYPE]
        is_whole = len(unknown) < len(found) < len(needed)
        controller = section.node is not None and bool(section.node.types)
        yield from found if is_whole or not controller else ()
        for said, hint, *names in _none_of(facts, section.whole) if section.given else ():
            if not any(is_set_in_other_file(file, section.title, it) for it in names):
                yield remark_at(section.given[0].key, f"{section.title}: {said}", hint, WARNING)
    for it in demands(file, "needs"):
        # A value that only a launch file fills in is there, too.
        if it.given.value is True and it.section.at + it.words[0] not in it.section.whole:
            message = f"{it.section.title}: {it.given.name} is true without {it.words[0]}"
            yield remark_at(it.given.key, message, f"add it, or set this to false; see {it.source}")


def without_input(runs: Iterable[Run], release: str) -> Iterator[Finding]:
    """Yield a finding for all nodes that have none of the same parameters, one of which they need."""
    known, lacking = built_in_nodes(release).nodes, defaultdict[tuple[str, ...], list[Run]](list)
    for run in runs:
        node = None if run.untold else known.get(run.fact.known or run.fact.name)
        facts = declared_by(f"{node.package}/{node.name}") if node else ()
        for fault in _none_of(facts, run.values):
            lacking[fault].append(run)
    for (said, hint, *_), nodes in lacking.items():
        who = shorten(unique(it.full_name for it in nodes), SEVERAL)
        yield at(values.missing, nodes[0].place, f"{who}: {said}", hint, level=NOTE)


def _none_of(facts: Iterable[Declared], there: Collection[str]) -> Iterator[tuple[str, ...]]:
    """Yield (message, hint, *names) of parameters where none is set and one has to be."""
    for fact in facts:
        for words in (words for check, words in fact.checks if check == "required_or"):
            names = (fact.path, *words.split())
            if not any(it in there for it in names):
                said = f"none of these is set: {', '.join(names)}"
                yield said, f"add one to its parameter file; see {fact.source}", *names


def _not_set(file: NamedFile, section: Section, fact: Declared, words: str) -> Iterator[Finding]:
    """Yield a finding for each block of a section that lacks a required parameter."""
    listed = value_of(section, words) if words else None
    for block, first in _blocks(section, fact.path):
        _, _, word = block.rpartition(".")
        name = f"{block}.{fact.path.rpartition('.')[2]}" if block else fact.path
        there = f"{section.at}{name}" in section.whole
        there = there or is_set_in_other_file(file, section.title, f"{section.at}{name}")
        if not there and (listed is None or (isinstance(listed, list) and word in listed)):
            message = f"{section.title}: {name} is missing"
            yield remark_at(first, message, f"add it; see {fact.source}", WARNING)


def _blocks(section: Section, path: str) -> Iterator[tuple[str, yaml.ScalarNode]]:
    """Yield each block of a file for a path, with a key; one without a name for the node itself."""
    above = path.rpartition(".")[0]
    if "<" not in path:
        if section.given:
            yield above, section.given[0].key
        return
    found: dict[str, yaml.ScalarNode] = {}
    pattern = above.split(".")
    for it in section.given:
        parts = it.name.split(".")
        pairs = zip(pattern, parts, strict=False)
        fits = all(want.startswith("<") or want == got for want, got in pairs)
        if fits and len(parts) > len(pattern):
            found.setdefault(".".join(parts[: len(pattern)]), it.key)
    yield from found.items()
