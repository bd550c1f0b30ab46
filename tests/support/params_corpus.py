# SPDX-License-Identifier: Apache-2.0
"""The corpus of parameter files: what becomes of each, and whether that is as it has to be.

``python tests/support/params_corpus.py`` writes the refusals on record anew.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import yaml
from beside import findings_of
from paths import CORPUS, FIXTURES

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_sets import load_node_set
from multibot_rewrite.related_files.context import fill_template, make_context
from multibot_rewrite.related_files.params.rewrite import rewrite_params
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml

FOLDERS = ("nav2_params", "localization_params", "controllers")
REFUSALS = FIXTURES / "params_refusals.json"
ROBOT = "robot1"
POLICIES = (("L1", "prefix"), ("L2", "prefix"), ("L3", "postfix"), ("L4", "postfix"))
NODE_SETS = ("nav2", "ros2_control", "robot_localization")
SHARED = ("map", "world")
# Frames by the last word of their parameter, in nodes and files of every kind.
FRAMES = re.compile(r"(base_frame|odom_frame|robot_base_frame|base_link_frame)(_id)?")
JOINTS = re.compile(r"(joints?|.*_joints?|joint_names|(left|right)_wheel_names)")


def files() -> dict[str, Path]:
    """Return the parameter files of the corpus, by their path there."""
    found = (path for folder in FOLDERS for path in sorted((CORPUS / folder).rglob("*.y*ml")))
    return {str(path.relative_to(CORPUS)): path for path in found}


class Outcome(NamedTuple):
    """What became of one file: refused for ``reason``, or ``problem`` (empty: as it has to be)."""

    reason: str
    problem: str
    findings: tuple[Finding, ...] = ()


def outcome(data: bytes, file: str, layout: str, affix: str) -> Outcome:
    """Rewrite one file and look at the result with other eyes."""
    try:
        document = read_yaml(data, file)
        naming = make_naming(layout=layout, affix=affix)
        context = make_context(declared(document), naming, facts(), distro=NEWEST_LTS)
        related_file = rewrite_params(document, context)
    except InputError as error:
        return Outcome(reason(str(error), file), "")
    except Exception as error:
        return Outcome("", f"{type(error).__name__}: {error}")
    findings = findings_of(related_file, [ROBOT])
    bad = next((it.code for it in findings if it.level == ERROR), "")
    if bad:
        return Outcome(bad, "", findings)
    text = fill_template(related_file.template, ROBOT, ROBOT)
    return Outcome("", "; ".join(problems(document, text, naming)), findings)


def facts() -> list[object]:
    found = [node for name in NODE_SETS for node in load_node_set(name, NEWEST_LTS)]
    return list(dict.fromkeys(found))


def reason(message: str, file: str) -> str:
    """Return an error without its place and the names in it."""
    text = message.removeprefix(file)
    text = re.sub(r"^[:\d]*: ", "", text)
    return re.sub(r" \([&*]\w+\)", "", text)


def declared(document: YamlText) -> dict[str, dict[str, None]]:
    """Return a description made up of the links and joints that a file names."""
    kinds: dict[str, dict[str, None]] = {it: {} for it in ("link", "joint", "model", "group")}
    for key, value in parameters(document.root):
        for text in texts(value):
            word = key.rpartition(".")[2]
            if JOINTS.fullmatch(word) and "/" not in text:
                kinds["joint"][text] = None
            elif "frame" in word and re.fullmatch(r"\w*(link|base|footprint)\w*", text):
                kinds["link"][text] = None
    return {**kinds, "frame": {}, "sensor": {}}


def parameters(node: yaml.Node | None, above: str = "") -> Iterator[tuple[str, yaml.Node]]:
    if not isinstance(node, yaml.MappingNode):
        return
    for key, value in node.value:
        if isinstance(value, yaml.MappingNode):
            yield from parameters(value, f"{above}.{key.value}")
        else:
            yield f"{above}.{key.value}", value


def texts(node: yaml.Node) -> Iterator[str]:
    items = node.value if isinstance(node, yaml.SequenceNode) else [node]
    for item in items:
        if isinstance(item, yaml.ScalarNode) and item.tag.endswith(":str"):
            yield item.value


def problems(document: YamlText, text: str, naming: Naming) -> Iterator[str]:
    """Yield what is not as it has to be: bytes between scalars, scalars, frames, joints."""
    bare = without_lines(text, document.text)
    if "\r\n" in document.text and "\r\n" not in text:
        yield "line ends changed"
    try:
        root = yaml.compose(bare.removeprefix("\ufeff"), Loader=yaml.CSafeLoader)
        yaml.compose(text.removeprefix("\ufeff"), Loader=yaml.CSafeLoader)
    except yaml.YAMLError as error:
        yield f"no YAML any more: {error}"
        return
    old, new = list(scalars(document.root)), list(scalars(root))
    if len(old) != len(new):
        yield f"{len(old)} scalars became {len(new)}"
        return
    if gaps(document.text, old) != gaps(bare.removeprefix("\ufeff"), new):
        yield "more than scalars changed"
    for before, after in zip(old, new, strict=True):
        if is_filled(before.value, after.value):
            continue
        if not is_respelled(before.value, after.value) and not is_off(before, after):
            yield f"{before.value!r} became {after.value!r}"
        if before.value != after.value and before.tag != after.tag:
            yield f"{before.value!r} was {before.tag}, {after.value!r} is {after.tag}"
    yield from wrong_names(document.root, root, naming)


def is_filled(old: str, new: str) -> bool:
    """Is it as launch files fill it in, but that a name gets the robot's as any other does?"""
    bare = re.sub(
        r"<(robot_namespace|namespace|robot_name)>|\$\(var (namespace|ns)\)|\$\{prefix\}", "", old
    )
    whole = old.replace(old.strip("/"), ROBOT)
    return bare != old and (new == whole if not bare.strip("/") else is_respelled(bare, new))


def without_lines(text: str, source: str) -> str:
    """Return the text without what was inserted: remarks, and repeated lines behind them."""
    kept = []
    lines = text.splitlines(keepends=True)
    over = Counter(map(start_of, lines)) - Counter(map(start_of, source.splitlines()))
    inserting = False
    for line in lines:
        if line.lstrip().startswith("# multibot: "):
            inserting = True
            continue
        inserting = inserting and over[start_of(line)] > 0
        if inserting:
            over[start_of(line)] -= 1
        else:
            kept.append(line)
    whole = "".join(kept)
    # Sections behind the last line begin on a new one.
    return whole if source.endswith("\n") else whole.rstrip("\r\n")


def start_of(line: str) -> str:
    """Return a line's indent and key."""
    return line.partition(":")[0]


def scalars(node: yaml.Node | None) -> Iterator[yaml.ScalarNode]:
    if isinstance(node, yaml.ScalarNode):
        yield node
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from scalars(item)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield from scalars(key)
            yield from scalars(value)


def gaps(text: str, found: list[yaml.ScalarNode]) -> list[str]:
    """Return what stands between the scalars."""
    ends = [0, *(it.end_mark.index for it in found)]
    starts = [*(it.start_mark.index for it in found), len(text)]
    return [text[end:start] for end, start in zip(ends, starts, strict=True)]


def is_respelled(old: str, new: str) -> bool:
    """Return whether the new value is the old one with the robot's name and a slash in front."""
    left = re.sub(rf"/{ROBOT}(?=/|$)|{ROBOT}_|_{ROBOT}|{ROBOT}/", "", new)
    return old == new or left.lstrip("/") == old.lstrip("/")


def is_off(before: yaml.ScalarNode, after: yaml.ScalarNode) -> bool:
    """Is it off, or a prefix of frames that is the namespace, of which controllers make none?"""
    return (before.tag.endswith(":bool") and after.value == "false") or (
        (before.value, after.value) == ("~", "/")
    )


def wrong_names(old: yaml.Node | None, new: yaml.Node | None, naming: Naming) -> Iterator[str]:
    """Frames and joints that are not what the layout makes of them."""
    pairs = zip(parameters(old), parameters(new), strict=True)
    for (key, before), (_, after) in pairs:
        word = key.rpartition(".")[2]
        for was, is_ in zip(texts(before), texts(after), strict=False):
            wanted = expected(word, was, naming)
            if wanted is not None and is_ != wanted and is_ != was.replace("/", "", 1):
                yield f"{key}: {was!r} became {is_!r} and not {wanted!r}"


def expected(word: str, value: str, naming: Naming) -> str | None:
    if not re.fullmatch(r"\w+", value) or value in "yYnN":
        return None
    separator = "/" if FRAMES.fullmatch(word) else "_" if JOINTS.fullmatch(word) else ""
    if not separator or value in SHARED:
        return None
    if naming.layout.short == "L1":
        return value
    return (
        f"{ROBOT}{separator}{value}" if naming.affix == "prefix" else f"{value}{separator}{ROBOT}"
    )


def run(found: dict[str, Path]) -> tuple[list[str], dict[str, list[str]], Counter[str]]:
    """Problems, files by the reason they are refused for, and how often each finding came."""
    wrong, refused, codes = [], {}, Counter()  # type: ignore[var-annotated]
    for file, path in found.items():
        data = path.read_bytes()
        for layout, affix in POLICIES:
            seen = outcome(data, file, layout, affix)
            codes.update(it.code for it in seen.findings)
            if seen.problem:
                wrong.append(f"{file} {layout}: {seen.problem}")
            elif seen.reason:
                refused.setdefault(seen.reason, set()).add(file)
    return wrong, {why: sorted(refused[why]) for why in sorted(refused)}, codes


if __name__ == "__main__":
    wrong, refused, codes = run(files())
    print(*wrong, *codes.most_common(), sep="\n")
    print({why: len(names) for why, names in refused.items()})
    REFUSALS.write_text(json.dumps(refused, indent=1) + "\n")
