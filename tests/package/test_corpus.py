"""Every real file is rewritten and proved, or refused for a reason that is on record and true."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from expected_names import ROBOT, changed_slots, graph_problems, is_insertion
from paths import FIXTURES
from real_robots import WHEELS, wheel_files
from refusal_reasons import Outcome, is_true, reason

from multibot_rewrite import MultibotError, ProofError, rewrite, rewrite_all, strip

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
# Rewritten as a whole from the tree, not by insertion.
RECOMPUTED = ("collision",)


def outcome(data: bytes, options: Mapping[str, object]) -> Outcome:
    """Rewrite one file and look at the result with other eyes."""
    try:
        result = rewrite(data, ROBOT, **options)
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
    """The refused files with the reason; fails where a result is wrong."""
    outcomes = {name: outcome(path.read_bytes(), options) for name, path in files.items()}
    wrong = [f"{name}: {found.problem}" for name, found in outcomes.items() if found.problem]
    assert not wrong, f"{len(wrong)} of {len(files)} files:\n" + "\n".join(wrong[:20])
    return {name: found.reason for name, found in outcomes.items() if found.reason}


def on_record(part: str, files: Mapping[str, Path]) -> dict[str, str]:
    """The committed refusals of the files that are here."""
    table: dict[str, dict[str, str]] = json.loads(REFUSALS.read_text())
    return {name: why for name, why in table[part].items() if name in files}


def test_corpus(corpus: dict[str, Path]) -> None:
    assert len(corpus) >= LEAST_CORPUS
    assert survey(corpus, {}) == on_record("corpus", corpus)


def test_no_record_of_a_file_that_is_not_there(corpus: dict[str, Path]) -> None:
    assert json.loads(REFUSALS.read_text())["corpus"].keys() <= corpus.keys()


def test_every_refusal_is_true(corpus: dict[str, Path]) -> None:
    for name, why in on_record("corpus", corpus).items():
        assert is_true(why, corpus[name].read_bytes()), f"{name}: {why}"


def test_every_refusal_of_a_wheel_file_is_true(wheels: dict[str, Path]) -> None:
    for name, why in on_record("wheels", wheels).items():
        assert is_true(why, wheels[name].read_bytes()), f"{name}: {why}"


def test_wheels(wheels: dict[str, Path]) -> None:
    assert survey(wheels, {}) == on_record("wheels", wheels)


def test_enough_wheels(wheels: dict[str, Path]) -> None:
    here = {name.partition("/")[0] for name in wheels}
    assert len(here) >= LEAST_WHEELS, f"only {sorted(here)}: pip install {' '.join(WHEELS)}"
    assert len(wheels) >= LEAST_WHEEL_FILES
    assert wheels == wheel_files()


@pytest.mark.deep
@pytest.mark.parametrize("options", DEEP, ids=str)
def test_corpus_with_options(corpus: dict[str, Path], options: Mapping[str, object]) -> None:
    refused = survey(corpus, options)
    done = [name for name, why in refused.items() if why.startswith("MB106")]
    # Some files were expanded with the namespace robot1: for L1 nothing is left to do.
    assert all(ROBOT.encode() in corpus[name].read_bytes() for name in done)
    assert {k: v for k, v in refused.items() if k not in done} == on_record("corpus", corpus)


@pytest.mark.deep
@pytest.mark.parametrize("options", DEEP, ids=str)
def test_wheels_with_options(wheels: dict[str, Path], options: Mapping[str, object]) -> None:
    assert survey(wheels, options) == on_record("wheels", wheels)


@pytest.mark.deep
def test_a_fleet_of_every_file(corpus: dict[str, Path]) -> None:
    refused = on_record("corpus", corpus)
    for name, path in corpus.items():
        if name not in refused:
            data = path.read_bytes()
            *_, last = rewrite_all(data, FLEET)
            assert last.data == rewrite(data, FLEET[-1]).data, name
