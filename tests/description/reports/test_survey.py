# SPDX-License-Identifier: Apache-2.0
"""What a survey counts, and how surveys add up."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from lxml import etree
from surveyed_robot import inventory, surveyed

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.checks.mentions import find_mentions
from multibot_rewrite.description.pipeline import prepare
from multibot_rewrite.description.reports.survey import (
    Loaded,
    MentionPlace,
    Survey,
    Tally,
    add,
    ranked,
    share,
    survey,
)
from multibot_rewrite.description.rewriters.builtin import builtin_tree
from multibot_rewrite.description.steps.document import slot_values

EMPTY = Survey(0, {}, {}, {})


def plugin(library: str, body: str = "") -> str:
    return f'<gazebo><plugin name="p" filename="{library}">{body}</plugin></gazebo>'


def paths(found: Survey, exact: bool = True) -> dict[str, int]:
    return {it.path: tally.times for it, tally in found.mentions.items() if it.exact == exact}


def test_plugins_are_counted_by_library_and_whether_they_are_known() -> None:
    known, unknown = plugin("libgazebo_ros_diff_drive.so"), plugin("/opt/x/libacme.so")
    found = surveyed(known + unknown + unknown)
    assert {it: tally.times for it, tally in found.loaded.items()} == {
        Loaded("plugin", "libgazebo_ros_diff_drive.so", True): 1,
        Loaded("plugin", "libacme.so", False): 2,
    }
    assert share(found, "plugin") == (3, 1)


def test_a_plugin_without_a_library_goes_by_its_class() -> None:
    found = surveyed('<gazebo><plugin name="acme::Drive" filename=""/></gazebo>')
    assert list(found.loaded) == [Loaded("plugin", "acme::Drive", False)]


def test_a_plugin_known_only_as_some_ros_node_is_unknown() -> None:
    found = surveyed(plugin("libacme.so", "<ros><namespace>/n</namespace></ros>"))
    assert list(found.loaded) == [Loaded("plugin", "libacme.so", False)]


def test_hardware_classes_are_counted_apart_and_sensors_are_none() -> None:
    system = (
        '<ros2_control name="s" type="system"><hardware><plugin>{}</plugin></hardware>'
        '<sensor name="x"/></ros2_control>'
    )
    known = "topic_based_ros2_control/TopicBasedSystem"
    found = surveyed(system.format(known) + system.format("acme/Arm"))
    assert set(found.loaded) == {
        Loaded("hardware", known, True),
        Loaded("hardware", "acme/Arm", False),
    }
    assert share(found, "plugin") == (0, 0)
    assert share(found, "hardware") == (2, 1)


def test_claims_are_counted_by_the_kind_that_they_turn_out_to_be() -> None:
    found = surveyed('<gazebo reference="hip"/><gazebo reference="nobody"/>')
    assert found.claims == {"model": 1, "link": 4, "joint": 2, "unresolved": 1}


@pytest.mark.parametrize(
    ("body", "path"),
    [
        ("<x><jointName>hip</jointName></x>", "/x/jointName"),
        ('<x frame="base"/>', "/x@frame"),
        ('<param name="a">base</param>', "/param[a]"),
        ('<y xmlns="http://gazebosim.org/schema">base</y>', "/y"),
        ('<q:y xmlns:q="urn:q">base</q:y>', "/q:y"),
        ("<x/>base", ""),
    ],
)
def test_where_a_mention_stands(body: str, path: str) -> None:
    found = surveyed(plugin("/opt/lib/libacme.so", body))
    assert paths(found) == {f"robot/gazebo/plugin[libacme.so]{path}": 1}


@pytest.mark.parametrize("value", ["a base b", "arm, hip", "camera/base", "r::hip", "x:=base"])
def test_a_name_inside_a_value_is_counted_apart(value: str) -> None:
    found = surveyed(plugin("libacme.so", f"<x>{value}</x>"))
    assert paths(found, exact=True) == {}
    assert paths(found, exact=False) == {"robot/gazebo/plugin[libacme.so]/x": 1}


@pytest.mark.parametrize("value", ["based", "base_2", "1 2 3", "Base"])
def test_what_only_looks_like_a_name_is_none(value: str) -> None:
    assert surveyed(plugin("libacme.so", f"<x>{value}</x>")).mentions == {}


def test_what_is_claimed_or_kept_is_no_mention() -> None:
    known = plugin("libgazebo_ros_diff_drive.so", "<left_joint>hip</left_joint>")
    assert surveyed(f'{known}<gazebo reference="base"/>').mentions == {}
    # joint@type is kept by the vocabulary whatever it says.
    assert surveyed('<link name="fixed"/>').mentions == {}


def test_the_first_place_is_remembered() -> None:
    found = surveyed(f"\n\n{plugin('libacme.so', '<x>hip</x><x>base</x>')}")
    mention = MentionPlace("robot/gazebo/plugin[libacme.so]/x", True)
    assert found.mentions[mention] == Tally(2, 1, "a.urdf:3", "hip")


def test_surveys_add_up_and_keep_the_first_place() -> None:
    one = surveyed(plugin("libacme.so", "<x>hip</x><x>hip</x>"), "one.urdf")
    two = surveyed(plugin("libacme.so", "<x>base</x><y>arm</y>"), "two.urdf")
    total = add([one, two])
    assert total.files == 2
    assert total.loaded[Loaded("plugin", "libacme.so", False)].times == 2
    assert total.claims["link"] == one.claims["link"] + two.claims["link"] == 8
    x = MentionPlace("robot/gazebo/plugin[libacme.so]/x", True)
    assert total.mentions[x] == Tally(3, 2, "one.urdf:1", "hip")
    assert total.mentions[x._replace(path=x.path[:-1] + "y")].files == 1


def test_nothing_adds_nothing() -> None:
    one = surveyed(plugin("libacme.so", "<x>hip</x>"))
    assert add([EMPTY, one, EMPTY]) == one
    assert add([]) == EMPTY


def test_the_most_frequent_comes_first_then_the_name() -> None:
    tallies = {
        MentionPlace(name, True): Tally(n, 1, "", "") for name, n in (("b", 1), ("a", 1), ("c", 2))
    }
    assert [mention.path for mention, _ in ranked(tallies.items())] == ["c", "a", "b"]


def test_the_walk_is_that_of_the_warnings() -> None:
    """Exact and inside together are the MB901 of a rewrite that renames every link and joint."""
    body = plugin("libacme.so", '<x>hip</x><y a="base arm"/><z>3</z>')
    text = f'<robot name="r"><link name="base"/><link name="arm"/><joint name="hip"/>{body}</robot>'
    found = survey(inventory(text), builtin_tree((), NEWEST_LTS))
    warned = prepare(text.encode(), "a.urdf", make_naming(), builtin_tree((), NEWEST_LTS)).findings
    count = Counter(finding.code for finding in warned)
    assert sum(tally.times for tally in found.mentions.values()) == count["MB901"] == 2


# ---------------------------------------------------------------- real files


@pytest.mark.more
def test_every_plugin_of_the_corpus_is_counted(corpus: dict[str, Path]) -> None:
    """Counted a second way: elements <plugin> with a library, wherever a <gazebo> block has them."""
    files = list(corpus.values())[::10]
    surveys = [
        survey(inventory(path.read_text(), path.name), builtin_tree((), NEWEST_LTS))
        for path in files
    ]
    total = add(surveys)
    query = etree.XPath("count(/robot//gazebo//plugin)")
    counts = [query(etree.fromstring(path.read_bytes())) for path in files]
    assert share(total, "plugin")[0] == sum(counts) > 100
    assert total.files == len(files)


@pytest.mark.more
def test_no_mention_of_the_corpus_is_lost(corpus: dict[str, Path]) -> None:
    for path in list(corpus.values())[::40]:
        found = inventory(path.read_text(), path.name)
        names = {*found.declared["link"], *found.declared["joint"]}
        values = slot_values(found.document.root)
        warned = find_mentions(found, values, names, builtin_tree((), NEWEST_LTS))
        tallies = survey(found, builtin_tree((), NEWEST_LTS)).mentions.values()
        assert sum(tally.times for tally in tallies) == len(warned)
