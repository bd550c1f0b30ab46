# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the words that a launch file gives its nodes: transforms, rules, files, programs.

Source: tf2_ros jazzy static_transform_broadcaster_program.cpp (angles in radians, eight or nine words
without flags), tf2 buffer_core.cpp (a frame is not its own parent, a quaternion has length one).
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from itertools import chain, pairwise
from math import isclose, pi

import yaml

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import IN_SUBSTITUTION, lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import SLIP, differ_in_numbers, nearest, slip_of
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.checks.numbers import number
from multibot_rewrite.description.sources.packages import packages_below, sources_around
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.planning.records import Run
from multibot_rewrite.planning.way_checks import RULE_WITHOUT_NAME
from multibot_rewrite.producers.launch.handed_on import document_of
from multibot_rewrite.producers.launch.known_node import STATIC
from multibot_rewrite.producers.launch.launched import Launched, world_files
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.producers.launch.records import LaunchedNode
from multibot_rewrite.related_files.params.sections import is_for, meant_for, raw_sections
from multibot_rewrite.related_files.yaml_text import line_of
from multibot_rewrite.rules.declaration import LAUNCH, OF_NO_NODE, at, launch_rule, section_message
from multibot_rewrite.rules.description.files import reading
from multibot_rewrite.system.records import Place
from multibot_rewrite.system.words import last_word

_ANGLES = ("--roll", "--pitch", "--yaw")
_QUATERNION = ("--qx", "--qy", "--qz", "--qw")
# More than a turn: nobody writes so many radians.
_TURN = 2 * pi


@launch_rule("MG711", "static-transform-implausible")
def implausible(launched: Launched) -> Iterator[Finding]:
    """Report each implausible transform of each static publisher."""
    for it in launched.nodes:
        if it.fact.known != STATIC:
            continue
        for message, hint in _transform_faults(it):
            yield at(implausible, it.place, f"{it.full_name}: {message}", hint)


def _transform_faults(it: Run) -> Iterator[tuple[str, str]]:
    """Yield (what is wrong, what to do) for a static transform's arguments."""
    given = {one.parameter: one.default for one in it.fact.frames}
    parent, child = (given.get(key, "") for key in ("frame_id", "child_frame_id"))
    if parent and parent == child:
        yield f"sends a transform from {parent} to itself", "name two different frames"
    flags = {old: new for old, new in pairwise(it.arguments) if old.startswith("--")}
    # Without flags they go by their order: with yaw, pitch and roll, or with a quaternion.
    turn = {8: ("--yaw", "--pitch", "--roll"), 9: _QUATERNION}.get(len(it.arguments), ())
    places = ("--x", "--y", "--z", *turn) if turn else ()
    named = flags or dict(zip(places, it.arguments, strict=False))
    for flag, word in named.items():
        value = number(word)
        if flag in _ANGLES and value is not None and abs(value) > _TURN + 0.01:
            radians = f"{value * pi / 180:.4g}"
            yield f"{flag} {word} is more than a turn in radians", f"degrees? write {radians}"
        elif not flags and value is None:
            hint = "numbers come first, then the two frames; or use flags, as --frame-id"
            yield f"{word} is in the place of {flag}", hint
    found = [number(named[it]) for it in _QUATERNION if it in named]
    if len(found) == len(_QUATERNION) and None not in found:
        length = sum(it * it for it in found if it is not None) ** 0.5
        if not isclose(length, 1, abs_tol=0.1):
            words = " ".join(named[it] for it in _QUATERNION)
            yield f"the quaternion {words} is no rotation", "without a rotation write 0 0 0 1"


def _matches_nothing(launched: Launched) -> Iterator[Finding]:
    """Report rules for a mistyped name of a node, if no parameter has or switches off the name."""
    library = built_in(launched.release).nodes
    for it in launched.nodes:
        above = f"{it.full_name.rpartition('/')[0]}/"
        ends = (*it.fact.endpoints, *library.get(it.fact.known, it.fact).endpoints)
        names = [end.name.removeprefix(above).lstrip("/~") for end in ends]
        for old, new in it.rules:
            bare = old.lstrip("/~")
            # Of an image the names of its transports are below its own.
            real = {bare, bare.rpartition("/")[0], new.lstrip("/~")}
            asked = ":" not in old and real.isdisjoint(names)
            near = nearest(bare, names, SLIP) if asked else ""
            if near and not bare.startswith("__"):
                message = f"{it.full_name}: the remap rule for {old} matches nothing"
                yield at(matches_nothing, it.place, message, f"did you mean {near}?")


matches_nothing = RULE_WITHOUT_NAME._replace(
    check=_matches_nothing, formats=(LAUNCH,), examples="MR103-launch"
)


@launch_rule("MG713", "file-not-there")  # fmt: skip
def not_there(launched: Launched) -> Iterator[Finding]:
    """Report missing parameter files, files of parameters, those after ``-file`` and ``-d``, worlds."""
    told: set[tuple[str, int, str]] = set()
    for note in launched.graph.notes:
        if note.parameters and note.file and _is_of_this_machine(note.file):
            told.add((note.place.file, note.place.line, note.file))
            yield at(not_there, note.place, note.message, _PATH, names=(note.file,))
    named = [
        (it.full_name, it.place, str(it.values[parameter].value))
        for it in launched.nodes
        for parameter in ("config_file", "yaml_filename")
        if parameter in it.values
    ]
    for node in launched.graph.nodes:
        words = [word for flag, word in pairwise(node.arguments) if flag in ("-d", "-file")]
        who = node.name or node.executable
        named += [(who, node.place, path) for path in (*words, *world_files(node))]
    for who, place, path in named:
        key = (place.file, place.line, path)
        is_meant = os.path.isabs(path) and _is_of_this_machine(path)
        if is_meant and not os.path.exists(path) and key not in told:
            told.add(key)
            message = f"{who} is given {path}, which is not there"
            yield at(not_there, place, message, _PATH, names=(path,))


def _sections_of_no_node(launched: Launched) -> Iterator[Finding]:
    """Report sections of no running node; a file that a launch makes is not a user's file."""
    every = {it.full_name for it in launched.nodes} | {it.name for it in launched.system.nodes}
    nodes = lists_by_key((last_word(it), it) for it in every)
    started = lists_by_key(((it.place, it.program), it.full_name) for it in launched.nodes)
    # Of others only their code has the name.
    named = {it.full_name for it in launched.nodes if it.fact.is_known}
    readers: dict[tuple[str, str], dict[str, None]] = defaultdict(dict)
    for node in launched.graph.nodes:
        names = started.get((node.place, f"{node.package}/{node.executable}"), ())
        named |= {*names} if node.name else set()
        for it in (one for one in node.parameters if one.file and names):
            readers[it.file, it.text] |= dict.fromkeys(names)
    found: dict[Place, tuple[str, list[str]]] = {}
    for (file, text), own in readers.items():
        names = [*own]
        with suppress(InputError):
            sections = raw_sections(document_of(file, text))
            by_word = lists_by_key((last_word(it.path), it) for it in sections)
            wild = [it.path for it in sections if "*" in it.path]
            unread = sorted({*by_word} - {*nodes} - {*built_in(launched.release).nodes})
            reaching = any(is_for(path, node) for path in wild for node in every)
            lost = named.issuperset(names) and not (reaching or by_word.keys() & nodes.keys())
            if sections and lost:
                place = Place(file, line_of(sections[0].keys[0]))
                message = (
                    f"no section of it matches a node: {' and '.join(names)} get nothing of it"
                )
                near = nearest(last_word(names[0]), by_word)
                what = f"{near} is nearly its name" if near else f"it has {shorten([*by_word], 3)}"
                # The nodes of its sections may be started elsewhere.
                level = ERROR if near else WARNING
                told = at(of_no_node, place, message, f"write {names[0]}: {what}", level=level)
                yield told._replace(names=(*names,))
            for reader in names:
                word = last_word(reader)
                section = meant_for(by_word.get(word, ()), reader, nodes.get(word, ()))
                if not lost and reader in named and word not in by_word:
                    section = next(iter(by_word.get(_mistyped(word, unread), ())), None)
                if section:
                    place = Place(file, line_of(section.keys[0]))
                    found.setdefault(place, (section.path, []))[1].append(reader)
    for place, (path, names) in found.items():
        yield at(of_no_node, place, *section_message(path, names))


def _mistyped(word: str, others: list[str]) -> str:
    """Return the name that is ``word`` but for a letter or two or its case, as left is not right."""
    near = slip_of(word, others)
    begins = [[part[:1].casefold() for part in it.split("_")] for it in (word, near)]
    return near if begins[0] == begins[1] and not differ_in_numbers(word, near) else ""


of_no_node = OF_NO_NODE._replace(check=_sections_of_no_node)


# That of libyaml is faster.
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_LEFT = lazy_compile(rf"<[A-Za-z_]\w*>|\$\({IN_SUBSTITUTION}\)|\$\{{\w+\}}")


def _placeholders(launched: Launched) -> Iterator[Finding]:
    """Report placeholders in parameter files as nodes get them, and in the words that start them."""
    given: list[tuple[Place, str]] = []
    files: dict[tuple[str, str], Place] = {}
    for it in launched.graph.nodes:
        given += [(it.place, one) for one in chain(it.arguments, *it.remappings)]
        for given_file in it.parameters:
            files.setdefault((given_file.file, given_file.text), it.place)
    for (file, text), start in files.items():
        with suppress(yaml.YAMLError):
            for one in yaml.scan(text, Loader=_LOADER) if _LEFT.search(text) else ():
                line = Place(file, one.start_mark.line + 1) if file else start
                given += [(line, one.value)] if isinstance(one, yaml.ScalarToken) else []
    told = set()
    started = {it.place.file for it in launched.graph.nodes}
    for place, value in given:
        left = _LEFT.search(value)
        if left and place.file in started and left[0].startswith("$(find-pkg-"):
            continue
        if left and " " not in _LEFT.sub("", value) and (place.file, left[0]) not in told:
            told.add((place.file, left[0]))
            message = f"the placeholder {left[0]} stays in {value!r}: the launch fills nothing in"
            hint = "replace it (ParameterFile with allow_substs, ReplaceString), or leave it out"
            yield at(placeholder_left, place, message, hint)


placeholder_left = reading.leftover._replace(
    check=_placeholders, level=ERROR, formats=(LAUNCH,), examples="MB105-launch"
)


@launch_rule("MG715", "include-argument-not-read")
def argument_not_read(launched: Launched) -> Iterator[Finding]:
    """Report arguments that the other file does not contain in its text."""
    for place, file, name, near in launched.graph.unread:
        hint = f"did you mean {near}?" if near else "leave it out, or write one that it declares"
        level = ERROR if near else WARNING
        message = f"{file} does not read the argument {name}"
        yield at(argument_not_read, place, message, hint, level=level)


_PATH = "correct the path, or install the file"
# Programs write there what others read.
_TEMPORARY = ("/tmp", "/var/tmp", "/dev/shm")


def _is_of_this_machine(path: str) -> bool:
    """Return whether the folder of a path is on this machine, and is none for temporary files."""
    folder = os.path.dirname(path)
    return os.path.isdir(folder) and folder not in _TEMPORARY


@launch_rule("MG714", "program-misspelt")
def misspelt(launched: Launched) -> Iterator[Finding]:
    """Report programs that a known package does not have."""
    known: dict[str, set[str]] = defaultdict(set)
    for node in built_in(launched.release).nodes.values():
        for path in node.programs or (node.kind,):
            package, slash, program = path.rpartition("/")
            known[package if slash else node.package].add(program)
    for package, _, program in (path.partition("/") for path in programs().passing):
        known[package].add(program)
    for it in launched.graph.nodes:
        every = known.get(it.package, ())
        if not it.executable or "::" in it.executable or it.executable in every:
            continue
        if other := _package_meant(it, known):
            message = f"{it.executable} is of the package {it.package}, which is not known"
            yield at(misspelt, it.place, message, f"did you mean {other}?", level=NOTE)
            continue
        near = nearest(it.executable, sorted(every), SLIP)
        # Programs are called with and without ``_node``, with and without a file ending.
        bare = {path.removesuffix(".py").removesuffix("_node") for path in (it.executable, near)}
        if near and len(bare) > 1:
            message = f"package {it.package} has no program {it.executable}"
            yield at(misspelt, it.place, message, f"did you mean {near}?")


def _package_meant(it: LaunchedNode, known: Mapping[str, Collection[str]]) -> str:
    """Return the package that was meant by a nearly equal name and has the program; empty for none."""
    near = "" if it.package in known else nearest(it.package, sorted(known), SLIP)
    if it.executable not in known.get(near, ()) or differ_in_numbers(near, it.package):
        return ""
    around = sources_around(it.place.file)
    return "" if around and it.package in packages_below((around,)) else near
