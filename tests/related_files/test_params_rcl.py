# SPDX-License-Identifier: Apache-2.0
"""Rewritten parameter files in the real rcl: every node gets what it got, with its names respelled."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from params_corpus import (
    POLICIES,
    ROBOT,
    declared,
    facts,
    files,
    findings_of,
    is_filled,
    is_respelled,
)
from paths import SUPPORT, fixture_text
from real_robots import spread
from related_file_calls import (
    NAMESPACE_SLOT,
    NEWEST_LTS,
    Context,
    ParamSection,
    YamlText,
    built_in_nodes,
    fill_template,
    identify_sections,
    make_context,
    make_naming,
    raw_sections,
    read_yaml,
    rewrite_params,
)

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.model import InputError

INSTALL = "pip install ros-jazzy-rclpy ros-jazzy-rmw-fastrtps-cpp ros-jazzy-common-interfaces"
pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not importlib.util.find_spec("rclpy"),
        reason=f"parameter files are not read with the real rcl: no rclpy here, {INSTALL}",
    ),
]
CHILD = SUPPORT / "rcl_params_child.py"
SECONDS = 300
OWN = fixture_text("params_rcl_own.yaml")


class Case:
    """A file, its text for a robot, and each exact section's node in both."""

    def __init__(self, document: YamlText, context: Context, text: str) -> None:
        self.source, self.text = document.text, text
        sections = identify_sections(raw_sections(document), context, built_in_nodes(NEWEST_LTS))
        exact = {it.path: it for it in sections if not it.wild and not it.shared}
        self.old = [apart(f"/{path}") for path in exact]
        self.new = [apart(full(it)) for it in exact.values()]


def full(section: ParamSection) -> str:
    return section.full.replace(NAMESPACE_SLOT, ROBOT)


def apart(name: str) -> tuple[str, str]:
    namespace, _, last = name.rpartition("/")
    return namespace or "/", last


def cases(sources: dict[str, bytes], policies: Sequence[tuple[str, str]]) -> Iterator[Case]:
    for file, data in sources.items():
        for layout, affix in policies:
            try:
                document = read_yaml(data, file)
                naming = make_naming(layout=layout, affix=affix)
                context = make_context(declared(document), naming, facts(), distro=NEWEST_LTS)  # type: ignore[arg-type]
                related_file = rewrite_params(document, context)
            except InputError:
                continue
            if all(it.level != ERROR for it in findings_of(related_file, [ROBOT])):
                yield Case(document, context, fill_template(related_file.template, ROBOT, ROBOT))


def asked(folder: Path, found: Sequence[Case]) -> list[list[Any]]:
    """Return what rcl makes of both texts of each case."""
    lines = []
    for at, case in enumerate(found):
        for kind, text, nodes in (("old", case.source, case.old), ("new", case.text, case.new)):
            path = folder / f"{at}.{kind}.yaml"
            path.write_text(text, newline="")
            lines.append(json.dumps({"file": str(path), "nodes": nodes}))
    done = subprocess.run(
        [sys.executable, str(CHILD)],
        input="\n".join(lines) + "\n",
        capture_output=True,
        text=True,
        timeout=SECONDS,
        check=False,
    )
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(answers) == len(lines), done.stderr[-2000:]
    return [answers[at : at + 2] for at in range(0, len(answers), 2)]


def wrong(found: Sequence[Case], folder: Path) -> tuple[list[str], int]:
    """Return what differs beyond names, and how many nodes were compared."""
    told, count = [], 0
    for case, (old, new) in zip(found, asked(folder, found), strict=True):
        if old is None:
            continue
        if new is None:
            told.append(f"{case.old}: rcl refuses the rewritten file")
            continue
        for node, before, after in zip(case.new, old, new, strict=True):
            count += 1
            told += [f"{node}: {it}" for it in differences(before, after)]
    return told, count


def differences(before: dict[str, Any], after: dict[str, Any]) -> Iterator[str]:
    left = dict(after)
    for key, value in before.items():
        same = next((it for it in left if is_respelled(key, it)), None)
        if same is None:
            yield f"{key} is gone"
        elif not is_same(key, value, left.pop(same)):
            yield f"{key}: {value!r} became {after[same]!r}"
    for key, value in left.items():
        # No prefix: / says so from Lyrical on, the other parameter before.
        no_prefix = key.endswith("tf_frame_prefix_enable") and not value
        no_prefix = no_prefix or (key.endswith("tf_frame_prefix") and value == "/")
        if ROBOT not in str(value) and not no_prefix:
            yield f"{key}: {value!r} is new"


def is_same(key: str, old: Any, new: Any) -> Any:
    if isinstance(old, str) and isinstance(new, str):
        # nav2_common's ReplaceString puts the robot's namespace in its place.
        bare = re.sub(r"^/?<robot_namespace>/?|\$\{prefix\}", "", old)
        no_prefix = key.endswith("tf_frame_prefix") and (old, new) == ("~", "/")
        return (
            no_prefix
            or is_filled(old, new)
            or any(is_respelled(it, new) for it in (old, bare, f"/{bare}"))
        )
    if isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        return all(is_same(key, *pair) for pair in zip(old, new, strict=True))
    return (
        repr(old) == repr(new)
        or old == new
        or (key.endswith("tf_frame_prefix_enable") and new is False)
    )


@pytest.mark.sample(4)
@pytest.mark.parametrize("policy", POLICIES)
def test_every_node_gets_its_parameters(policy: tuple[str, str], tmp_path: Path) -> None:
    found = list(cases({"own.yaml": OWN.encode()}, [policy]))
    told, count = wrong(found, tmp_path)
    assert told == []
    assert count == 4


def test_real_files(tmp_path: Path) -> None:
    sources = {name: path.read_bytes() for name, path in spread(files(), 25).items()}
    if not sources:
        pytest.skip("no corpus of parameter files beside the repository")
    told, count = wrong(list(cases(sources, POLICIES[1::2])), tmp_path)
    assert told == []
    assert count > 40


@pytest.mark.deep
def test_all_real_files(tmp_path: Path) -> None:
    sources = {name: path.read_bytes() for name, path in files().items()}
    if not sources:
        pytest.skip("no corpus of parameter files beside the repository")
    # Each file by one of the policies: every case is a context and a node of rcl, before and after.
    shares = ([*sources.items()][at :: len(POLICIES)] for at in range(len(POLICIES)))
    every = zip(shares, POLICIES, strict=True)
    found = [it for share, policy in every for it in cases(dict(share), [policy])]
    told, count = wrong(found, tmp_path)
    assert told == []
    assert count > 200
