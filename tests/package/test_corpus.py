# SPDX-License-Identifier: Apache-2.0
"""Every real file is rewritten and verified, or refused for a reason that is on record and true."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import pytest
from expected_names import ROBOT, changed_slots, graph_problems, is_insertion
from paths import FIXTURES
from real_robots import WHEELS, wheel_files
from refusal_reasons import Outcome, is_true, reason

from multibot_rewrite import MultibotError, ProofError, rewrite, rewrite_all, strip
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.checks.twice import already_rewritten
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document

pytestmark = pytest.mark.slow

REFUSALS = FIXTURES / "corpus_refusals.json"
LEAST_CORPUS, LEAST_WHEELS, LEAST_WHEEL_FILES = 1000, 3, 100
FLEET = tuple(f"r{number}" for number in range(1, 11))
DEEP = (
    {"layout": "L1"},
    {"layout": "L2", "affix": "prefix"},
    {"layout": "L3"},
    {"layout": "L4", "affix": "prefix"},
    {"layout": "L4", "topics": "namespace"},
    {"layout": "L4", "topics": "prefix"},
    {"layout": "L2", "topics": "postfix"},
    {"separators": {"link": "_", "joint": "/"}},
)
# Names that robots get because of what they are or where they stand.
RARELY = ("left", "right", "front", "rear", "arm", "gripper", "lidar", "l", "alice", "husky", "ur5")
OFTENER = ("base", "camera", "robot")
# Rewritten as a whole from the tree, not by insertion.
RECOMPUTED = ("collision",)


def outcome(data: bytes, options: Mapping[str, object]) -> Outcome:
    """Rewrite one file and look at the result with other eyes.

    Some files were expanded with the namespace robot1: they carry it already.
    """
    try:
        result = rewrite(data, ROBOT, again=True, **options)
    except ProofError as error:
        return Outcome("", str(error))
    except MultibotError as error:
        return Outcome(reason(error), "")
    except Exception as error:
        return Outcome("", f"{type(error).__name__}: {error}")
    return Outcome("", "; ".join(problems(data, result.data, options)))


def problems(data: bytes, output: bytes, options: Mapping[str, object]) -> Iterator[str]:
    """Whatever is wrong with a rewritten file."""
    yield from graph_problems(data, output, options)
    for slot, new in changed_slots(data, output):
        if slot.tag not in RECOMPUTED and not is_insertion(slot.value, new):
            yield f"{slot} became {new!r}"
    if strip(output, ROBOT, **options) != data:  # type: ignore[arg-type]
        yield "strip does not give the input back"


def survey(files: Mapping[str, Path], options: Mapping[str, object]) -> dict[str, str]:
    """Return the refused files with the reason; fails where a result is wrong."""
    outcomes = {name: outcome(path.read_bytes(), options) for name, path in files.items()}
    wrong = [f"{name}: {found.problem}" for name, found in outcomes.items() if found.problem]
    assert not wrong, f"{len(wrong)} of {len(files)} files:\n" + "\n".join(wrong[:20])
    return {name: found.reason for name, found in outcomes.items() if found.reason}


def on_record(part: str, files: Mapping[str, Path]) -> dict[str, str]:
    """Return the committed refusals of the files that are here."""
    table: dict[str, dict[str, str]] = json.loads(REFUSALS.read_text())
    return {name: why for name, why in table[part].items() if name in files}


@pytest.mark.parametrize(
    "part", [0, *(pytest.param(it, marks=pytest.mark.deep) for it in range(1, 48))]
)
def test_corpus(corpus: dict[str, Path], part: int) -> None:
    assert len(corpus) >= LEAST_CORPUS
    some = dict(sorted(corpus.items())[part::48])
    assert survey(some, {}) == on_record("corpus", some)


def refused_as_rewritten(files: Mapping[str, Path], robots: Sequence[str]) -> dict[str, set[str]]:
    """For each robot the files that are rewritten for it already."""
    found: dict[str, set[str]] = {robot: set() for robot in robots}
    for name, path in files.items():
        inventory = collect(read_document(path.read_bytes(), name), builtin_tree((), NEWEST_LTS))
        for robot in robots:
            if any(already_rewritten(inventory, [robot], again=False)):
                found[robot].add(name)
    return found


@pytest.mark.deep
def test_files_that_carry_the_robot_are_refused(corpus: dict[str, Path]) -> None:
    """Its name begins or ends links, joints, namespaces or topics; else it is nowhere in them."""
    (found,) = refused_as_rewritten(corpus, [ROBOT]).values()
    texts = {name: path.read_text(errors="replace") for name, path in corpus.items()}
    named = re.compile(rf'<(?:link|joint) name="(?:{ROBOT}[/_.-]|[^"]*[/_.-]{ROBOT}")')
    assert {name for name, text in texts.items() if named.search(text)} <= found
    assert all(ROBOT in texts[name] for name in found)
    assert len(found) > 100


@pytest.mark.deep
def test_a_robot_called_like_a_part_is_hardly_ever_refused(corpus: dict[str, Path]) -> None:
    """At most one file in a hundred; names of base links and cameras are what they are called."""
    found = refused_as_rewritten(corpus, [*RARELY, *OFTENER])
    assert {it: len(found[it]) for it in RARELY if len(found[it]) > len(corpus) // 100} == {}
    assert {it: len(found[it]) for it in OFTENER if len(found[it]) > len(corpus) // 20} == {}


def test_no_record_of_a_file_that_is_not_there(corpus: dict[str, Path]) -> None:
    assert json.loads(REFUSALS.read_text())["corpus"].keys() <= corpus.keys()


def test_every_refusal_is_true(corpus: dict[str, Path]) -> None:
    for name, why in on_record("corpus", corpus).items():
        assert is_true(why, corpus[name].read_bytes()), f"{name}: {why}"


def test_every_refusal_of_a_wheel_file_is_true(wheels: dict[str, Path]) -> None:
    for name, why in on_record("wheels", wheels).items():
        assert is_true(why, wheels[name].read_bytes()), f"{name}: {why}"


@pytest.mark.parametrize(
    "part", [0, *(pytest.param(it, marks=pytest.mark.deep) for it in (1, 2, 3))]
)
def test_wheels(wheels: dict[str, Path], part: int) -> None:
    some = dict(sorted(wheels.items())[part::4])
    assert survey(some, {}) == on_record("wheels", some)


def test_enough_wheels(wheels: dict[str, Path]) -> None:
    here = {name.partition("/")[0] for name in wheels}
    assert len(here) >= LEAST_WHEELS, f"only {sorted(here)}: pip install {' '.join(WHEELS)}"
    assert len(wheels) >= LEAST_WHEEL_FILES
    assert wheels == wheel_files()


@pytest.mark.deep
@pytest.mark.parametrize("part", range(len(DEEP)), ids=lambda it: str(DEEP[it]))
def test_corpus_with_options(corpus: dict[str, Path], part: int) -> None:
    """Other files for each: one look at all of them costs minutes."""
    some = dict(sorted(corpus.items())[part :: 2 * len(DEEP)])
    assert survey(some, DEEP[part]) == on_record("corpus", some)


@pytest.mark.deep
@pytest.mark.parametrize("part", range(len(DEEP)), ids=lambda it: str(DEEP[it]))
def test_wheels_with_options(wheels: dict[str, Path], part: int) -> None:
    some = dict(sorted(wheels.items())[part :: len(DEEP)])
    assert survey(some, DEEP[part]) == on_record("wheels", some)


@pytest.mark.deep
def test_a_fleet_of_many_files(corpus: dict[str, Path]) -> None:
    refused = on_record("corpus", corpus)
    for name, path in sorted(corpus.items())[::10]:
        if name not in refused:
            data = path.read_bytes()
            *_, last = rewrite_all(data, FLEET)
            if b" numbered from " in last.data:
                assert strip(last.data, FLEET[-1]) == data, name
            else:
                alone = rewrite(data, FLEET[-1], world_systems="leave")
                assert last.data == alone.data, name
