# SPDX-License-Identifier: Apache-2.0
"""Suggested plugin definitions: what is guessed from what; they load and leave nothing unknown."""

from __future__ import annotations

from pathlib import Path

import pytest

import multibot_rewrite
from multibot_rewrite import rewrite
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.checks.unknown import is_unknown
from multibot_rewrite.description.reports.suggest import (
    SuggestedSection,
    definitions_text,
    suggest,
    tag_kind,
)
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, load_definitions
from multibot_rewrite.description.rewriters.tree import Tree, builtin_tree
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document

HERE = Path(multibot_rewrite.__file__).parent / "description" / "rewriters" / "plugin_definitions"
ROBOT = """<robot name="bot"><link name="base"/><link name="arm"/><link name="both"/>
<joint name="hip" type="fixed"><parent link="base"/><child link="arm"/></joint>
<joint name="knee" type="fixed"><parent link="base"/><child link="both"/></joint>
<joint name="both" type="fixed"/>
{}</robot>"""


def described(body: str, tree: Tree | None = None) -> Inventory:
    return collect(
        read_document(ROBOT.format(body).encode(), "bot.urdf"), tree or builtin_tree((), NEWEST_LTS)
    )


def plugin(body: str, attributes: str = 'filename="libacme.so"') -> str:
    return f'<gazebo><plugin name="p" {attributes}>{body}</plugin></gazebo>'


def hardware(body: str) -> str:
    inner = f"<hardware><plugin>acme/Arm</plugin>{body}</hardware>"
    return f'<ros2_control name="s" type="system">{inner}<joint name="hip"/></ros2_control>'


def suggested(body: str) -> list[SuggestedSection]:
    return suggest(described(body))


def text_for(body: str) -> str:
    return definitions_text(suggested(body), "bot.urdf")


def line_for(body: str) -> str:
    """Return the one row or comment that a plugin with this grandchild gets, without its note.

    Of a grandchild, because some tags are known right below any plugin.
    """
    (row,) = text_for(plugin(f"<own>{body}</own>")).splitlines()[5:]
    return row.partition("   #")[0].replace("own/", "", 1)


def loaded(text: str, folder: Path) -> Tree:
    (folder / "new.vocab").write_text(text)
    return Tree(load_definitions((str(folder / "new.vocab"),), NEWEST_LTS))


# ---------------------------------------------------------------- what is guessed


@pytest.mark.parametrize(
    ("child", "row"),
    [
        # From the value.
        ("<x>hip</x>", "x uses joint"),
        ("<x>arm</x>", "x uses link"),
        ("<x>both</x>", "x uses link joint"),
        ("<x_joint>both</x_joint>", "x_joint uses joint link"),
        ('<x y="arm"/>', "x@y uses link"),
        ("<x><y>arm</y></x>", "x/y uses link"),
        ("<x>/arm</x>", "x uses frame"),
        ("<x>hip, knee</x>", "x uses joint form=list"),
        ("<x>hip nobody</x>", "x uses joint form=list"),
        ("<x>bot::arm</x>", "x uses link form=scoped"),
        ("<x>arm/light</x>", "x uses link form=suffixed"),
        ("<x>arm/light/on</x>", "x uses link form=suffixed"),
        ("<x>bot::arm other</x>", "# x: 'bot::arm other'"),
        ("<x>bot::arm, hip</x>", "x uses joint form=list"),
        ("<x>a:=arm</x>", "x uses topic form=remap"),
        ("<x>nobody</x><!-- none -->", "# x: 'nobody'"),
        ("<x>3.5 1e3</x>", "# x: '3.5 1e3'"),
        # From the tag.
        ("<leftJoint>a</leftJoint>", "leftJoint uses joint"),
        ("<left_joint>a</left_joint>", "left_joint uses joint"),
        ("<jointName>a</jointName>", "jointName uses joint"),
        ("<joint_names>a b</joint_names>", "joint_names uses joint form=list"),
        ("<odomFrame>a</odomFrame>", "odomFrame uses frame"),
        ("<frameName>a</frameName>", "frameName uses frame"),
        ("<frame_id>a</frame_id>", "frame_id uses frame"),
        ("<frame_id>arm</frame_id>", "frame_id uses frame"),
        ("<base_link>a</base_link>", "base_link uses link"),
        ("<bodyName>a</bodyName>", "bodyName uses link"),
        ("<body_name>a</body_name>", "body_name uses link"),
        ("<cmdTopic>a</cmdTopic>", "cmdTopic uses topic"),
        ("<topicName>a</topicName>", "topicName uses topic"),
        ("<topic>arm</topic>", "topic uses topic"),
        ("<topic>arm/scan</topic>", "topic uses topic"),
        ("<gztopic>/a</gztopic>", "gztopic uses topic"),
        ("<robotNamespace>a</robotNamespace>", "robotNamespace uses namespace"),
        ("<serviceName>a</serviceName>", "serviceName uses service"),
        ("<joint_states_topic>a</joint_states_topic>", "joint_states_topic uses topic"),
        ("<link>other::a</link>", "link uses link form=scoped"),
        ('<param name="frame_id">a</param>', "param[@name=frame_id] uses frame"),
        ('<parameter name="frame_id">a</parameter>', "parameter[@name=frame_id] uses frame"),
        ('<joint name="a"/>', "joint@name uses joint"),
        ("<frame_rate>a</frame_rate>", "# frame_rate: 'a'"),
        ("<topic>two words</topic>", "# topic: 'two words'"),
        ("<use_topic>true</use_topic>", "# use_topic: 'true'"),
        ("<joint>1</joint>", "# joint: '1'"),
    ],
)
def test_a_guess_from_the_value_or_the_tag(child: str, row: str) -> None:
    assert line_for(child) == row


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("a/IMUTopicName", "topic"),
        ("joint/value", "joint"),
        ("joint/axis", ""),
        ("hardware/param[@name=left_wheel_joint]", "joint"),
        ("@frame", "frame"),
        ("frames", "frame"),
        *(
            (f"joint_{it}", "joint")
            for it in ("name", "names", "id", "ids", "list", "value", "text")
        ),
        ("joint_size", ""),
        ("list/joint", "joint"),
        ("joint/ids", "joint"),
        ("x", ""),
        ("_", ""),
    ],
)
def test_what_the_words_of_a_path_say(path: str, kind: str) -> None:
    assert tag_kind(path) == kind


def test_every_guess_says_why() -> None:
    text = text_for(plugin("<a>hip</a><b>hip, arm</b><cmdTopic>go</cmdTopic><c>1</c>"))
    assert "a uses joint   # guessed: 'hip' is a joint here\n" in text
    why = "'hip, arm' holds the link 'arm' and the joint 'hip'"
    assert f"b uses link joint form=list   # guessed: {why}\n" in text
    assert "cmdTopic uses topic   # guessed: the tag, as in 'go'\n" in text
    assert "\n# c: '1'\n" in text


def test_values_of_several_kinds_at_one_path_all_count() -> None:
    (section,) = suggested(plugin("<x>hip</x><x>arm</x><t>a:=b</t><t>arm</t>"))
    assert [row.guess and row.guess.kinds for row in section.rows] == [
        ("joint", "link"),
        ("topic",),
    ]
    # A rule says nothing of what the others are, nor does a tag.
    (section,) = suggested(plugin("<x_topic>go</x_topic><y>hip</y><y>hip knee</y><y>a:=b</y>"))
    assert [(it.guess and it.guess.kinds, it.guess and it.guess.form) for it in section.rows] == [
        (("topic",), "whole"),
        (("joint",), "list"),
    ]


def test_hardware_without_parameters_needs_none() -> None:
    assert suggested(hardware("")) == []


# ---------------------------------------------------------------- it can be used as it is


NASTY = (
    '<x y="a ] # b">arm</x><param name="a b">hip</param><param name="a]b">hip</param>'
    '<q:y xmlns:q="urn:q">hip</q:y><ü>hip</ü><z>hip&#10;[plugin evil]&#10;</z>'
    "<w> # hip, arm</w><v>'arm' \"q\"</v><keep>hip</keep><at>arm</at>"
)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "body",
    [
        plugin("<x>hip</x>"),
        plugin(""),
        plugin(NASTY),
        plugin("<ros/><x>hip</x>"),
        plugin("<x>hip</x>", 'filename="lib acme ].so"').replace('"p"', '"acme::Class"'),
        plugin("<x>hip</x>", "").replace('"p"', '"acme::Class"'),
        plugin("<x>arm</x>", 'filename="libignition-gazebo6-acme-system.so"'),
        plugin("<ros/><x>hip</x>") + plugin("<x>arm</x><namespace>n</namespace>"),
        hardware('<param name="grip">hip</param>'),
    ],
)
def test_the_suggestion_loads_and_leaves_nothing_unknown(body: str, tmp_path: Path) -> None:
    tree = loaded(text_for(body), tmp_path)
    before = [host for host in described(body).hosts if _unknown(host.node.section)]
    after = [host for host in described(body, tree).hosts if _unknown(host.node.section)]
    assert before and not after


def _unknown(rewriter: object) -> bool:
    return is_unknown(rewriter) or getattr(rewriter, "select", "") == "hardware"  # type: ignore[arg-type]


def test_the_rows_do_what_they_say(tmp_path: Path) -> None:
    body = plugin("<x>hip, knee</x><y>bot::arm</y><topic>go</topic><n>3</n>")
    (tmp_path / "new.vocab").write_text(text_for(body))
    done = rewrite(ROBOT.format(body), "r1", definitions=[str(tmp_path / "new.vocab")])
    assert "<x>hip_r1, knee_r1</x><y>bot_r1::arm/r1</y><topic>go/r1</topic><n>3</n>" in done.text
    assert "MB902" not in {finding.code for finding in done.findings}


def test_a_plugin_that_is_a_ros_node_stays_one(tmp_path: Path) -> None:
    body = plugin("<ros><remapping>a:=go</remapping></ros><x>hip</x>")
    (tmp_path / "new.vocab").write_text(text_for(body))
    done = rewrite(ROBOT.format(body), "r1", definitions=[str(tmp_path / "new.vocab")])
    assert 'name="p_r1"' in done.text
    assert "<remapping>a:=go/r1</remapping>" in done.text
    assert "<x>hip_r1</x>" in done.text


def test_a_plugin_no_section_can_be_called_like_is_a_comment() -> None:
    text = text_for(plugin("<x>hip</x>", 'filename="a b.so"').replace('"p"', '"c d"'))
    assert "\n# no section can be called 'a b.so'\n" in text
    assert "[plugin" not in text


def test_odd_values_become_comments_and_stay_on_their_line() -> None:
    text = text_for(plugin(NASTY))
    assert "evil]'" in text and "\n[plugin evil]" not in text
    assert [line for line in text.splitlines() if line.startswith("[")] == ["[plugin acme]"]
    assert "# {urn:q}y: 'hip'" in text
    assert "# param: 'hip'" in text or "\nparam uses joint " in text


@pytest.mark.more
def test_what_a_small_definitions_lacks_can_be_suggested(corpus: dict[str, Path]) -> None:
    """With the elements alone every plugin and hardware class of the corpus is unknown."""
    texts = {name: (HERE / name).read_text() for name in ("urdf.vocab", "sdf.vocab")}
    bare = Tree(Definitions(texts, NEWEST_LTS))
    guessed = set()
    for path in list(corpus.values())[::6]:
        document = read_document(path.read_bytes(), path.name)
        sections = suggest(collect(document, bare))
        text = definitions_text(sections, path.name)
        tree = Tree(Definitions(texts | {"new.vocab": text}, NEWEST_LTS))
        there = collect(document, tree)
        assert not any(is_unknown(h.node.section) for h in there.hosts if h.node.section), path
        assert len(tree.definitions.sections("plugin", "hardware")) == text.count("\n["), path
        guessed |= _guessed(sections, tree.definitions)
    assert len(guessed) > 50
    assert {kind for _, kinds in guessed for kind in kinds} >= {"joint", "link", "frame", "topic"}


def _guessed(
    sections: list[SuggestedSection], definitions: Definitions
) -> set[tuple[str, tuple[str, ...]]]:
    """Path and kinds of every guessed row, as the plugin definitions has read it."""
    found = set()
    for section in sections:
        (rewriter,) = definitions.find(section.type, section.name)
        kinds = {site.path: site.kinds for site in rewriter.sites}
        for row in section.rows:
            if row.guess is not None:
                assert kinds[row.path] == row.guess.kinds
                found.add((row.path, row.guess.kinds))
    return found
