# SPDX-License-Identifier: Apache-2.0
"""What a survey counts, and how surveys add up."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from lxml import etree
from paths import CORPUS, ROOT, write_files
from surveyed_robot import inventory, surveyed

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.cli.tables import render
from multibot_rewrite.description.checks.mentions import find_mentions
from multibot_rewrite.description.pipeline import prepare
from multibot_rewrite.description.reports.suggest import Loaded
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.document import slot_values
from tools import unclaimed
from tools.survey import (
    MentionPlace,
    Survey,
    Tally,
    add,
    main,
    percentage,
    ranked,
    report,
    share,
    survey,
    surveyed as surveyed_files,
)

UNCLAIMED = ROOT / "fixtures" / "unclaimed.tsv"
# Percent of the occurrences over the corpus.
LEAST_PLUGINS, LEAST_HARDWARE = 98, 95
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
    # joint@type is kept by the plugin definitions whatever it says.
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


TALLY = Tally(3, 2, "a.urdf:4", "base  link")
SURVEY = Survey(
    2,
    {
        Loaded("plugin", "liba.so", True): TALLY, Loaded("plugin", "libb.so", False): TALLY,
        Loaded("plugin", "libc.so", False): TALLY._replace(times=4),
        Loaded("hardware", "x/Y", True): TALLY._replace(times=1),
    },
    {"link": 3, "frame": 5, "joint": 3},
    {
        MentionPlace("robot/a", True): TALLY, MentionPlace("robot/b", False): TALLY._replace(times=1),
        MentionPlace("robot/c", False): TALLY._replace(times=2),
    },
)  # fmt: skip


def test_how_much_is_known() -> None:
    """Percentages are rounded down, and the most frequent comes first."""
    assert render(report(SURVEY, ["x.urdf: no XML"])) == (
        "2 files read, 1 cannot be read\n  x.urdf: no XML\n\n"
        "3 of 10 plugins known (30.0 %), 1 of 3 names\n"
        "count  files  not known  first seen\n"
        "    4      2  libc.so    a.urdf:4\n"
        "    3      2  libb.so    a.urdf:4\n\n"
        "1 of 1 hardware classes known (100.0 %), 1 of 1 names\n\n"
        "11 values claimed\n  frame 5, joint 3, link 3\n\n"
        "3 unclaimed and exactly a link or joint\n"
        "count  files  path     value      first seen\n"
        "    3      2  robot/a  base link  a.urdf:4\n\n"
        "3 unclaimed with a link or joint inside\n"
        "count  files  path     value      first seen\n"
        "    2      2  robot/c  base link  a.urdf:4\n"
        "    1      2  robot/b  base link  a.urdf:4\n"
    )
    assert (percentage(3, 2), percentage(0, 0)) == (66.6, 100.0)
    assert percentage(2000, 1999) == 99.9


def test_the_program_reads_what_it_can(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_files(here, {"a.urdf": '<robot name="r"/>', "b.urdf": "<robot>", "c.xml": ""})
    assert main(["."]) == 0
    first, second, *_ = capsys.readouterr().out.splitlines()
    assert first == "1 file read, 1 cannot be read"
    assert second.startswith("  ./b.urdf:1:8: not well-formed XML")
    assert main(["nowhere"]) == 2
    assert (
        capsys.readouterr().err
        == "survey: nowhere: there is no such file or folder; correct the path\n"
    )


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


@pytest.mark.deep
def test_the_corpus_is_known_and_its_rest_explained(corpus: dict[str, Path]) -> None:
    total, unreadable = surveyed_files([str(CORPUS / "urdf")])
    # Some have a rest of xacro in them, and what they include is elsewhere.
    assert total.files + len(unreadable) == len(corpus)
    assert len(unreadable) < 30
    assert all("xacro failed" in it for it in unreadable)
    assert percentage(*share(total, "plugin")) >= LEAST_PLUGINS
    assert percentage(*share(total, "hardware")) >= LEAST_HARDWARE
    assert unclaimed.main([str(UNCLAIMED), str(CORPUS / "urdf")]) == 0
