# SPDX-License-Identifier: Apache-2.0
"""MoveIt's files of public repositories: intended scalars change and nothing else, or a true reason.

What is expected is worked out here from the parsed text; nothing of it comes from the package.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

import pytest
import yaml
from paths import CORPUS, FIXTURES

from multibot_rewrite.base.model import InputError, MultibotError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.related_files.context import Context, fill_template, make_context
from multibot_rewrite.related_files.moveit.file_kind import file_kind
from multibot_rewrite.related_files.moveit.rewrite import rewrite_moveit
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml

HOME = CORPUS / "moveit"
COUNTS = FIXTURES / "moveit_corpus.json"
FILES = sorted(it for it in HOME.rglob("*") if it.is_file()) if HOME.is_dir() else []
LAYOUTS: Mapping[str, Mapping[str, str]] = {
    "L1": {"layout": "L1"},
    "L2": {"layout": "L2", "affix": "prefix", "groups": "rename"},
    "L3": {"layout": "L3", "affix": "prefix"},
    "L4": {"layout": "L4", "groups": "rename"},
}
GRAPH, SPELLED = "amr7", "seven"
Names = Mapping[str, Mapping[str, None]]
needs_corpus = pytest.mark.skipif(not FILES, reason=f"no corpus of MoveIt files: looked for {HOME}")


@cache
def description(folder: str) -> Names:
    """Return what the folder's URDFs and SRDFs declare; what its files name where there is no URDF."""
    found: dict[str, dict[str, None]] = {it: {} for it in ("joint", "link", "frame", "group")}
    tree = builtin_tree((), NEWEST_LTS)
    for kind in ("urdf", "srdf"):
        for path in sorted((CORPUS / kind / folder).rglob(f"*.{kind}")):
            try:
                declared = collect(read_document(path.read_bytes(), path.name), tree).declared
            except MultibotError:
                continue
            for word in found:
                found[word] |= dict.fromkeys(declared.get(word, ()))
    if not found["joint"]:
        for path in (HOME / folder).rglob("*"):
            gather(yaml.compose(path.read_text(), Loader=yaml.CSafeLoader), found)
    return found


def gather(node: yaml.Node | None, found: Mapping[str, dict[str, None]]) -> None:
    """Joints of every ``joints`` list and of joint limits, groups of every solver."""
    pairs = node.value if isinstance(node, yaml.MappingNode) else []
    for key, value in pairs:
        if key.value == "joints" and isinstance(value, yaml.SequenceNode):
            found["joint"] |= {it.value: None for it in value.value if "$" not in it.value}
        if key.value == "joint_limits" and isinstance(value, yaml.MappingNode):
            found["joint"] |= {it.value: None for it, _ in value.value if "$" not in it.value}
        below = value.value if isinstance(value, yaml.MappingNode) else []
        if any(it.value == "kinematics_solver" for it, _ in below):
            found["group"][key.value] = None
        gather(value, found)
    for item in node.value if isinstance(node, yaml.SequenceNode) else []:
        gather(item, found)


def scalars(node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    if isinstance(node, yaml.ScalarNode):
        yield node
    for item in node.value if isinstance(node, yaml.SequenceNode) else []:
        yield from scalars(item)
    for key, value in node.value if isinstance(node, yaml.MappingNode) else []:
        yield from scalars(key)
        yield from scalars(value)


# What a launch file fills in with the robot's own prefix: it is out of a name that has the robot's.
STANDS = re.compile(r"(?:\$\((?:arg|var) \w+\)|\$\{\w+\}|<\w+>)[_/]?(?=\w)")


def allowed(layout: str, old: str, names: Names) -> set[str]:
    """All that a scalar may become."""
    plain = STANDS.sub("", old, count=1)
    found = {old, plain, *(allowed(layout, plain, names) if plain != old else ())}
    prefix = layout in ("L2", "L3")
    for kind, separator in (("joint", "_"), ("link", "/"), ("frame", "/"), ("group", "_")):
        renamed = layout in ("L2", "L4") or (layout == "L3" and kind != "group")
        if renamed and old in names[kind]:
            found.add(f"{SPELLED}{separator}{old}" if prefix else f"{old}{separator}{SPELLED}")
    if old.startswith("/") and layout != "L4":
        found.add(f"/{GRAPH}{old}")
    if layout == "L4":
        found |= {f"{old}_{GRAPH}", f"{old}/{GRAPH}"}
    return found


def text_of(document: YamlText, context: Context) -> str:
    return fill_template(rewrite_moveit(document, context).template, GRAPH, SPELLED)


def prove(path: Path, layout: str, counted: Counter[str]) -> None:
    file = str(path.relative_to(HOME))
    names = description(path.relative_to(HOME).parts[0])
    context = make_context(names, make_naming(**LAYOUTS[layout]), (), distro=NEWEST_LTS)  # type: ignore[arg-type]
    document = read_yaml(path.read_bytes(), file)
    try:
        kind = file_kind(document)
        text = text_of(document, context)
    except InputError as error:
        assert "\n" not in str(error) and str(error).startswith(file)
        counted[str(error).partition("; ")[0].removeprefix(file)] += 1
        return
    counted[f"taken: {kind}"] += 1
    source = document.bom + document.text
    if document.root is None:
        assert text == source
        return
    after = read_yaml(text.encode(), file)
    assert after.root is not None
    pairs = list(zip(scalars(document.root), scalars(after.root), strict=True))
    assert len(pairs) == len(list(scalars(after.root)))
    assert structure(document.root) == structure(after.root), file
    back = text[len(after.bom) :]
    spans = set()
    for old, new in pairs:
        assert new.value in allowed(layout, old.value, names), (file, layout, old.value, new.value)
        closed = old.value in names["joint"] and old.value not in names["group"]
        if closed and layout != "L1":
            assert new.value != old.value, (file, layout, old.value, old.start_mark.line + 1)
        spans.add((new.start_mark.index, new.end_mark.index, raw(document, old)))
    for start, end, was in sorted(spans, reverse=True):
        back = back[:start] + was + back[end:]
    assert back == document.text, (file, layout)


def structure(node: yaml.Node) -> object:
    """Return maps, lists and scalars without their text."""
    if isinstance(node, yaml.ScalarNode):
        return ""
    if isinstance(node, yaml.SequenceNode):
        return [structure(it) for it in node.value]
    return [(structure(key), structure(value)) for key, value in node.value]


def raw(document: YamlText, node: yaml.ScalarNode) -> str:
    return document.text[node.start_mark.index : node.end_mark.index]


@pytest.mark.more
@needs_corpus
@pytest.mark.sample(4)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_intended_scalars_change_and_nothing_else(layout: str) -> None:
    counted: Counter[str] = Counter()
    for path in FILES:
        prove(path, layout, counted)
    assert dict(counted) == json.loads(COUNTS.read_text())
