"""The names in a section -> splices that rename them for a robot, and findings about them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import (
    SPELLERS,
    expressible,
    frames_differ,
    is_component,
    is_plain,
    is_shared_frame,
)
from multibot_rewrite.companions.names.node_topics import (
    FROM_NODE,
    FROM_PARENT,
    IN_FULL,
    Facts,
    spell_topic,
)
from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.params.known_nodes import KnownNodes, in_release
from multibot_rewrite.companions.params.name_sites import NameSite, SectionNames
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.yaml_text import Splice, YamlText, finding_at, pairs, replaced
from multibot_rewrite.model import ERROR, WARNING, Finding
from multibot_rewrite.rosnames import check_topic_name

# Kinds of names that must be declared in the description.
_CLOSED = {"joint": ("joint",), "link": ("link",), "sensor": ("sensor",)}
_PREFIXES = ("stem", "link_prefix", "joint_prefix")
_PLACEHOLDER = re.compile(r"<[^>]*>|\$\([^)]*\)|\$?\{[^}]*\}")
# Kinds that are only guessed where the description declares the name.
_UNSURE = ("frame", "sensor", "interface")
# Patterns that match everything or nothing hold no robot's name.
_OPEN_PATTERNS = frozenset({".*", "*", "[*]", "(?!)", "^$"})


class ParamsJob(NamedTuple):
    """One parameter file to rewrite, and all that its steps need.

    ``robots`` are the namespaces and tags of the fleet's robots.
    """

    document: YamlText
    context: Context
    known: KnownNodes
    facts: Facts
    robots: frozenset[str] = frozenset()


def name_splices(
    job: ParamsJob, section: ParamSection, names: SectionNames
) -> Iterator[Splice | Finding]:
    """A splice for every name of a section that changes, and a finding where that is not possible."""
    keys: dict[int, tuple[yaml.ScalarNode, list[str]]] = {}
    for site in names.sites:
        if site.at >= 0:
            words = keys.setdefault(
                id(site.scalar), (site.scalar, str(site.scalar.value).split("."))
            )[1]
            words[site.at] = _text(job.context, site)
        elif site.kind in ("topic", "service"):
            yield from _topic(job, section, site)
        elif site.kind in SPELLERS:
            yield from _replaced(job, site, _text(job.context, site))
        elif site.kind == "off":
            yield from _off(job, site)
    for key, words in keys.values():
        if (text := ".".join(words)) != key.value:
            yield replaced(key, text)


def _text(context: Context, site: NameSite) -> str:
    # A value that is a frame only by its parameter's name may be a word such as enu.
    guessed = site.param is None and site.kind in _UNSURE
    if guessed and not _is_certain(context, site):
        return site.value
    speller = SPELLERS.get(site.kind)
    return speller(context, site.value) if speller else site.value


def _is_certain(context: Context, site: NameSite) -> bool:
    if site.kind == "interface":
        return any(is_component(context, it) for it in site.value.split("/")[:-1])
    return is_declared(context.names, site.kind, site.value.lstrip("/")) or site.value == "odom"


def _replaced(job: ParamsJob, site: NameSite, text: str) -> Iterator[Splice | Finding]:
    if text == site.value:
        return
    if site.scalar.style in ("|", ">"):
        message = f"{site.key.value} is a block of text, so the name in it is not rewritten"
        hint = f"write it on one line: {site.key.value}: {site.value.strip()}"
        yield finding_at(job.document, site.scalar, "MF119", WARNING, message, hint)
        return
    yield replaced(site.scalar, text)


def _topic(job: ParamsJob, section: ParamSection, site: NameSite) -> Iterator[Splice | Finding]:
    result = spell_topic(
        job.context, section.path, site.kind, site.value, _reach(job, section, site), job.facts
    )
    yield from _replaced(job, site, result.text)
    if result.wrong_target:
        message = f"{site.key.value}: remap rules turn {result.text} into {result.wrong_target}"
        hint = "remove the name from the remap rules of this node or from this file"
        yield finding_at(job.document, site.scalar, "MF120", WARNING, message, hint)
    if result.made_absolute and result.text != site.value:
        message = "relative topics of a costmap are resolved below the costmap: made absolute"
        hint = "Kilted resolves them below the robot: set distro: kilted if the file is for that"
        yield finding_at(job.document, site.scalar, "MF121", WARNING, message, hint)


def _reach(job: ParamsJob, section: ParamSection, site: NameSite) -> str:
    words = site.param.absolute if site.param else ""
    if not words:
        return FROM_NODE
    if in_release(words, job.context.distro) or _is_binary_filter(site):
        return IN_FULL
    return FROM_PARENT


def _is_binary_filter(site: NameSite) -> bool:
    """The one filter that does not resolve its topics in the robot's namespace."""
    layer = {key.value: value.value for key, value in pairs(site.layer)}
    return "BinaryFilter" in str(layer.get("plugin", ""))


def _off(job: ParamsJob, site: NameSite) -> Iterator[Splice | Finding]:
    """A switch that makes the node put a namespace before frames that are renamed already."""
    if site.value.lower() in ("true", "yes", "on", "y"):
        yield Splice(site.scalar.start_mark.index, site.scalar.end_mark.index, "false")
    elif "$" in site.value or "<" in site.value:
        message = f"{site.key.value} is {site.value} and must turn out false"
        hint = "true adds the namespace to frames that already have the robot's name"
        yield finding_at(job.document, site.scalar, "MF116", WARNING, message, hint)


def name_findings(job: ParamsJob, section: ParamSection, names: SectionNames) -> Iterator[Finding]:
    """Findings about a section's names, repeated keys and missing values."""
    for site in names.sites:
        yield from _name_finding(job, site)
    guessed = [site.key for site in names.sites if site.param is None and _is_taken(job, site)]
    if guessed and section.node is None and not section.wild:
        words = ", ".join(dict.fromkeys(key.value for key in guessed))
        message = (
            f"node {section.path} is not known; parameters that hold names are guessed: {words}"
        )
        hint = "describe the node in a file under parameters:"
        yield finding_at(job.document, guessed[0], "MF114", WARNING, message, hint)
    for key in names.twice:
        message = f"{key.value!r} is set twice in one section; the later value counts"
        yield finding_at(job.document, key, "MF108", WARNING, message, "remove one of them")
    for key in names.empty:
        message = f"{key.value!r} has no value"
        hint = 'rcl rejects the whole file; write a value, or ""'
        yield finding_at(job.document, key, "MF109", WARNING, message, hint)


def _name_finding(job: ParamsJob, site: NameSite) -> Iterator[Finding]:
    """The finding about one name, if any."""
    draft = None
    if site.kind == "frame" or site.kind in _CLOSED:
        draft = _undeclared(job, site)
    elif site.kind in ("topic", "service"):
        draft = _invalid_topic(site)
    elif site.kind in _PREFIXES:
        draft = _inexpressible(job, site)
    elif site.kind in ("doubles", "exclusive", "pattern", "text"):
        draft = _not_rewritten(job, site)
    if draft:
        code, level, message, hint = draft
        yield finding_at(job.document, site.scalar, code, level, message, hint)
    if not is_plain(site.value) and (found := _PLACEHOLDER.search(site.value)):
        message = f"the placeholder {found[0]} stays; a launch file must replace it"
        hint = "if it stands for the robot's name, write the value without it"
        yield finding_at(job.document, site.scalar, "MF110", WARNING, message, hint)


def _is_taken(job: ParamsJob, site: NameSite) -> bool:
    """Does the guess change the value?"""
    return site.kind in ("topic", "service") or _text(job.context, site) != site.value


_Draft = tuple[str, str, str, str]


def _undeclared(job: ParamsJob, site: NameSite) -> _Draft | None:
    """A name that the description does not declare."""
    names, value = job.context.names, site.value.lstrip("/")
    known = names.declared.get("link" if site.kind == "frame" else site.kind, {})
    if not known or not is_plain(site.value) or is_declared(names, site.kind, value):
        return None
    if site.kind == "frame":
        if value in job.known.sent or is_shared_frame(job.context, value):
            return None
        what = "frame" if site.param else "possible frame"
        message = f"{what} {value!r} is not in the description"
        hint = _near(value, known) or "some node must publish it with the robot's name"
        return "MF112", WARNING, message, hint
    if "/" in value and site.kind == "joint" and value.rpartition("/")[2] in known:
        return None
    if site.param is None:
        return None
    message = f"{site.kind} {value!r} is not in the description"
    return "MF111", WARNING, message, _near(value, known) or "it stays unchanged; correct it"


def _near(value: str, known: Iterable[str]) -> str:
    from difflib import get_close_matches  # only a message needs it

    near = get_close_matches(value, list(known), 1, 0.6)
    return f"did you mean {near[0]!r}?" if near else ""


def _invalid_topic(site: NameSite) -> _Draft | None:
    fault = check_topic_name(site.value) if is_plain(site.value) else None
    if not fault:
        return None
    message = f"{site.value!r} is not a valid {site.kind} name: {fault.reason}"
    return "MF113", WARNING, message, "it stays unchanged; correct it"


def _inexpressible(job: ParamsJob, site: NameSite) -> _Draft | None:
    if expressible(job.context, site.kind):
        return None
    message = f"{site.key.value} can only add a prefix, but the fleet uses a postfix"
    return "MF117", WARNING, message, "set affix: prefix"


def _not_rewritten(job: ParamsJob, site: NameSite) -> _Draft | None:
    """Parameters that this tool does not rewrite."""
    key, value = site.key.value, site.value
    if site.kind == "doubles":
        level = ERROR if frames_differ(job.context) and is_plain(value) else WARNING
        return "MF115", level, f"{key} {value!r} adds a prefix to frames a second time", 'write ""'
    if site.kind == "exclusive":
        idle = not value or value.lower() in ("false", "no", "off")
        hint = "set it for each robot, in a parameter file that is loaded after this one"
        return (
            None if idle else ("MF118", WARNING, f"{key} {value} is the same for all robots", hint)
        )
    if value in _OPEN_PATTERNS or not (site.kind == "pattern" or _mentions(job.context, value)):
        return None
    message = f"names in {key} {value!r} are not rewritten"
    return "MF122", WARNING, message, "check that it works for each robot"


def _mentions(context: Context, value: str) -> bool:
    words = "".join(c if c.isalnum() or c in "_-/" else " " for c in value).split()
    return any(is_declared(context.names, kind, it) for it in words for kind in ("link", "joint"))


def robot_in_name(
    job: ParamsJob, sections: Iterable[ParamSection], pages: Iterable[SectionNames]
) -> Iterator[Finding]:
    """A name that holds a robot's name: the file was written for that robot."""
    scalars = [(key, key.value) for section in sections for key in section.keys]
    scalars += [(it.scalar, it.value) for names in pages for it in names.sites if it.kind != "keep"]
    for scalar, value in scalars:
        found = job.robots.intersection(value.strip("/").split("/"))
        for robot in sorted(found):
            message = f"{value} includes the robot name {robot}, so the file is for that robot only"
            hint = "remove the robot name from every name; the build adds it for each robot"
            yield finding_at(job.document, scalar, "MF126", ERROR, message, hint)
            return


def unclaimed_names(job: ParamsJob, pages: Sequence[SectionNames]) -> Iterator[Finding]:
    """Names of the description at parameters that are not known to hold names."""
    claimed = {it.value: it.kind for names in pages for it in names.sites if _is_robots(job, it)}
    declared = {
        name: kind
        for kind in ("link", "joint")
        for name in job.context.names.declared.get(kind, ())
    }
    either = {**claimed, **declared}
    for names in pages:
        found = [(it, either[it.value]) for it in names.unclaimed if it.value in either]
        found += [(it, declared[it.value]) for it in names.keys if it.value in declared]
        for scalar, kind in found:
            message = f"{scalar.value!r} is a {kind} of the robot, but the parameter is not known"
            hint = "if it is a name, describe the parameter in a file under parameters:"
            yield finding_at(job.document, scalar, "MF123", WARNING, message, hint)


def _is_robots(job: ParamsJob, site: NameSite) -> bool:
    """A frame or absolute topic that changes for a robot; relative topics are common words."""
    if site.kind == "frame":
        return site.at < 0 and _text(job.context, site) != site.value
    return site.kind == "topic" and site.value.startswith("/") and is_plain(site.value)
