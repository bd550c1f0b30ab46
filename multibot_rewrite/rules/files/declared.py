# SPDX-License-Identifier: Apache-2.0
"""Parameters of a file against what their nodes declare: unknown, of another type, out of bounds."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.grouping import dicts_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import MISTYPED, Guesses, meant_name, nearest
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.description.sources.packages import packages_below, sources_around
from multibot_rewrite.knowledge.declared import DECLARED, DEMANDED, READ, YAML, Declared, stands_for
from multibot_rewrite.knowledge.packages import older
from multibot_rewrite.related_files.named_file import NamedFile
from multibot_rewrite.related_files.params.name_sites import params_at
from multibot_rewrite.related_files.params.sections import MANAGER, PARAMETERS
from multibot_rewrite.rules.declaration import remark_at
from multibot_rewrite.rules.files.parameter_files import (
    beyond,
    facts_of_node,
    of_parameter,
    of_release,
)
from multibot_rewrite.rules.files.plugin_names import older_nodes
from multibot_rewrite.rules.files.plugins import RENAMED
from multibot_rewrite.rules.files.section_facts import Section, Setting, sections
from multibot_rewrite.system.parameters import Value

# What every node has, or every controller and plugin; prefixes end in a dot.
_EVERYWHERE = lazy_compile(
    r"use_sim_time|start_type_description_service|qos_overrides\..*|diagnostic_updater\..*|bond_\w+|type"
    r"|params_file|update_rate|is_async|async_parameters\..*|introspection.*|enable_parameter_\w+"
    r"|.*plugin(?!.*?plugin)\w*|robot_description\w*|fallback_controllers|node_options_args|autostart_node|service_\w+"
)
_ARRAY = lazy_compile(r"(\w+?)_array(?:_fixed_\d+)?")
_WORD = lazy_compile(r"\w+")
_CAPITALS = lazy_compile(r"[A-Z][A-Z0-9]*_[A-Z0-9_]+")
ID = "<id>."
_WORDS = {bool: "bool", int: "int", float: "double", str: "string"}


def unknown_parameters(file: NamedFile) -> Iterator[Finding]:
    """Report parameters that no release of their node declares, with a name nearly that of one."""
    for section in sections(file):
        # What is asked for by whatever name there is counts for none.
        unknown = [
            it
            for it, found in section.known
            if all(fact.how == READ and fact.path.endswith(">") for fact in found)
        ]
        package = section.node.package if section.node else ""
        stale = older(package, file.context.distro)
        for it, near in _meant_by(section, unknown, file.context.distro):
            if near:
                message = f"{section.title} has no parameter {it.name!r}"
                hint = f"did you mean {near!r}?{stale and f' {stale}'}"
                yield remark_at(it.key, message, hint, NOTE if stale else "")


def _meant_by(
    section: Section, given: Iterable[Setting], release: str
) -> Iterator[tuple[Setting, str]]:
    """Yield (setting, probable name) for each parameter that its node is not known to have."""
    unknown = [
        it for it in given if not _is_known(section, it) and PARAMETERS not in it.name.split(".")
    ]
    if not unknown:
        return
    facts = [it for it in section.facts if it.how != READ]
    paths = [it.path for it in of_release(facts, release)]
    there = [it for it in paths if "<" not in it]
    if section.node is None:
        # Parameters of a plugin in the blocks that the file gives it: ``scan`` of a layer's sources.
        blocks = sorted({it.name.partition(".")[0] for it in section.given if "." in it.name})
        inner = [it.removeprefix(ID) for it in paths if it.startswith(ID)]
        there += (f"{block}.{it}" for block in blocks for it in inner if "<" not in it)
    above = sorted({it.name.rpartition(".")[0] for it in unknown})
    there += dict.fromkeys(name for group in above for name in _names_in_group(group, paths))
    said = {it.name for it in section.given}
    free = [it for it in there if it not in said]
    # Group -> last word -> parameter.
    parts = ((name.rpartition("."), name) for name in free)
    groups = dicts_by_key((group, last, name) for (group, _, last), name in parts)
    guesses = Guesses()
    for it in unknown:
        yield (
            it,
            "" if _renamed(it.name) in said else _near_parameter(it.name, free, groups, guesses),
        )


def _renamed(name: str) -> str:
    """Return today's name of a parameter that has another one elsewhere; empty for none."""
    *above, last = name.split(".")
    return ".".join((*above, RENAMED[last])) if last in RENAMED else ""


def _names_in_group(above: str, paths: Sequence[str]) -> Iterator[str]:
    """Yield the names that a pattern (``joint_limits.<joint>.max_velocity``) allows in a group."""
    for path in paths:
        pattern, _, last = path.rpartition(".")
        stand = stands_for(pattern, above) if "<" in pattern and "<" not in last else {}
        if stand and all("." not in word for word in stand.values()):
            yield f"{above}.{last}"


def _is_known(section: Section, it: Setting) -> bool:
    """Return whether every node has such a parameter, or it holds names."""
    of_node = section.node is not None and bool(params_at(section.node, it.name, it.key))
    return of_node or _EVERYWHERE.fullmatch(it.name) is not None


def _near_parameter(
    name: str, known: Sequence[str], groups: Mapping[str, Mapping[str, str]], guesses: Guesses
) -> str:
    """Return the known parameter that was meant: a near name in its place, or the same elsewhere."""
    above, _, last = name.rpartition(".")
    beside = groups.get(above, {})
    if RENAMED.get(last) in beside:
        return beside[RENAMED[last]]
    near = (
        meant_name(last, beside) or _longer(last, beside) or guesses.nearest(last, beside, MISTYPED)
    )
    return beside.get(near, "") or meant_name(name, known)


def _longer(name: str, known: Iterable[str]) -> str:
    """Return the one known name that continues this one, as ``has_jerk_limits`` does ``has_jerk``."""
    longer = [it for it in known if "_" in name and it.startswith(f"{name}_")]
    return longer[0] if len(longer) == 1 else ""


def wrong_types(file: NamedFile) -> Iterator[Finding]:
    """Report values of another type than declared; an error where no release takes the value."""
    for section in sections(file):
        for it, known in section.known:
            if type_ := _wrong_type(it, of_parameter(known, file.context.distro)):
                given = _type_of(it.value) if it.value is not None else ""
                message = f"{section.title}: {it.name} is {_a_type(given)}, not {_a_type(type_)}"
                level = ERROR if _is_refused(file, section, it, known) else ""
                yield remark_at(it.node, message, _other_type(type_, given, it), level)


def _is_refused(file: NamedFile, section: Section, it: Setting, known: Sequence[Declared]) -> bool:
    """Return whether every release refuses a value that its node surely gets."""
    package, around = section.node.package if section.node else "", sources_around(file.file)
    reached = package != "nav2_costmap_2d" or "/" in section.title.partition(":")[0]
    if any(older_nodes(file)) or not reached:
        return False
    if package and around and package in packages_below((around,)):
        return False
    facts = (of_parameter(known, release) for release in RELEASES)
    return all(_wrong_type(it, found) for found in facts if found)


def _wrong_type(it: Setting, known: Sequence[Declared]) -> str:
    """Return the type that a value must have and has not; empty if it is right or unknown."""
    if it.value is None or it.value == [] or _is_filled_in(it.value):
        return ""
    read = [fact for fact in known if fact.how != READ]
    exact = [fact for fact in read if fact.path == it.name] or read
    facts = [fact for fact in exact if fact.how == DEMANDED] or exact
    types = {fact.type for fact in facts}
    if len(types) != 1:
        return ""
    (type_,) = types
    # What code gives as a default may be a variable of any type.
    sure = all(fact.how in (YAML, DEMANDED) for fact in facts) or type_ in ("double", "int", "bool")
    return type_ if sure and _compared_type(type_) not in ("", _type_of(it.value)) else ""


def not_read(file: NamedFile) -> Iterator[Finding]:
    """Report parameters of a node whose package declares all of its own, and not these."""
    for section in sections(file):
        facts = [fact for fact in section.facts if fact.how != DEMANDED]
        # All that a package declares: in a file, or in code that puts together no name.
        whole = all(it.how == YAML or (it.how == DECLARED and "<" not in it.path) for it in facts)
        if section.node is None or not facts or not whole:
            continue
        unread = [it for it, found in section.known if not found]
        for it, near in _meant_by(section, unread, file.context.distro):
            if not near:
                message = f"{section.title} declares no parameter {it.name!r}"
                yield remark_at(
                    it.key, message, f"nothing reads it; delete it, see {facts[0].source}"
                )


def in_the_manager(file: NamedFile) -> Iterator[Finding]:
    """Report parameters of a controller in the section of its manager, which reads their class."""
    known = file.known
    if known is None:
        return
    for section in sections(file):
        if section.node is None or section.node.name != MANAGER:
            continue
        for it in section.given:
            name, _, rest = it.name.partition(".")
            class_ = section.whole.get(f"{name}.type")
            node = known.types.get(str(class_.value)) if class_ else None
            facts = facts_of_node(known.nodes[node], "", file.file, file.roots) if node else ()
            if any(fact.how == YAML and fact.has_name(rest) for fact in facts):
                message = f"{section.title}: {it.name} is a parameter of {name}, and not read here"
                yield remark_at(it.key, message, f"move it to {name}: {PARAMETERS}:", WARNING)


def below_unknown_names(file: NamedFile) -> Iterator[Finding]:
    """Report parameters below a name that its list lacks: ``constraints.JOINT``."""
    for section in sections(file):
        for it, known in section.known:
            for fact in known if len(known) == 1 and known[0].how == YAML else ():
                for word, name in stands_for(fact.path, it.name).items():
                    listed = section.whole.get(section.at + word.strip("<>"))
                    names = listed.value if listed else None
                    if isinstance(names, list) and names and name not in names:
                        yield _unlisted_name(section, it, name, [str(each) for each in names], word)


def _unlisted_name(
    section: Section, it: Setting, name: str, names: Sequence[str], word: str
) -> Finding:
    """Return the finding about a parameter below a name that its list lacks."""
    near = nearest(name, names)
    hint = f"did you mean {near!r}?" if near else "nothing reads it"
    message = f"{section.title}: {it.name} is for {name!r}, which is not in {word.strip('<>')}"
    return remark_at(it.key, message, hint, WARNING if near else "")


def of_other_releases(file: NamedFile) -> Iterator[Finding]:
    """Report parameters that the node declares in other releases only."""
    release = file.context.distro
    for section in sections(file):
        for it, known in section.known:
            facts = [fact for fact in known if fact.how != READ]
            if not facts or of_release(facts, release) or _is_known(section, it):
                continue
            others = [at for at in RELEASES if of_release(facts, at)]
            message = f"{section.title}: {it.name} is not in {release}, only in {', '.join(others)}"
            yield remark_at(it.key, message, f"delete it; see {facts[0].source}")


def out_of_bounds(file: NamedFile) -> Iterator[Finding]:
    """Report values that generate_parameter_library, or the node's code, rejects."""
    for section in sections(file):
        for it, facts in _declarations(section, file.context.distro):
            alone = sum(fact.how != DEMANDED for fact in facts) == 1
            for fact in facts:
                if not _has_type_of(fact, it) or not (alone or fact.how == DEMANDED):
                    continue
                said = [beyond(*check, it.value) for check in fact.checks]
                for words in filter(None, said):
                    message = f"{section.title}: {it.name} is {it.value!r}, and has to be {words}"
                    yield remark_at(it.node, message, f"correct it; declared in {fact.source}")


def _is_filled_in(value: Value | None) -> bool:
    """Return whether a value is a word in capitals, which Nav2's launch files replace."""
    return isinstance(value, str) and _CAPITALS.fullmatch(value) is not None


def _declarations(section: Section, release: str) -> Iterator[tuple[Setting, list[Declared]]]:
    """Yield each parameter with its declarations in a release: by name, without any by pattern."""
    for it, known in section.known:
        found = [fact for fact in of_release(known, release) if fact.how != READ]
        exact = [fact for fact in found if fact.path == it.name]
        if found and not (_is_filled_in(it.value) and not _is_misspelt(it.value, exact or found)):
            yield it, exact or found


def _is_misspelt(value: Value | None, facts: Sequence[Declared]) -> bool:
    """Return whether a word in capitals is nearly one of the known ones."""
    words = (word for fact in facts for check in fact.checks for word in _WORD.findall(check[1]))
    return isinstance(value, str) and nearest(value, words, MISTYPED) not in ("", value)


def _has_type_of(fact: Declared, it: Setting) -> bool:
    """Return whether a value has the type of a declaration. An empty list is one of any."""
    type_ = _compared_type(fact.type)
    if it.value == []:
        return type_.endswith("_array")
    return it.value is not None and type_ == _type_of(it.value)


def _type_of(value: Value) -> str:
    if isinstance(value, list):
        return f"{_WORDS[type(value[0])]}_array" if value else "array"
    return _WORDS[type(value)]


def _compared_type(type_: str) -> str:
    """Return the type that rclcpp compares; empty where any is taken."""
    array = _ARRAY.fullmatch(type_)
    word = f"{array[1]}_array" if array else type_.partition("_fixed")[0]
    return word if word.removesuffix("_array") in _WORDS.values() else ""


def _a_type(type_: str) -> str:
    return f"{'an' if type_.startswith('int') else 'a'} {type_}"


def _other_type(type_: str, given: str, it: Setting) -> str:
    """Return what to do about a value of another type."""
    if type_ == "double" and given == "int":
        return f"write {it.value}.0"
    if type_.startswith("double_array") and given == "int_array" and isinstance(it.value, list):
        return f"write [{', '.join(f'{value}.0' for value in it.value)}]"
    return "rclcpp throws InvalidParameterTypeException, and the node does not come up"
