# SPDX-License-Identifier: Apache-2.0
"""The plugin definitions: every mistake is refused by file and line, and all that ships is in order."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from description_calls import (
    NEWEST_LTS,
    TYPES,
    PluginDefinition,
    builtin_tree,
    load_definitions,
)
from paths import fixture_text

from multibot_rewrite import DefinitionsError, rewrite
from multibot_rewrite.base.releases import RELEASES, ROS_1, has_release

HEAD = "[plugin mine]\nabout: a test\n"
NEW_PLUGIN = fixture_text("definitions_new_plugin.txt")
ROBOT = fixture_text("definitions_robot.urdf")


def write(folder: Path, text: str) -> str:
    path = folder / "my.vocab"
    path.write_text(text, encoding="utf-8")
    return str(path)


def complaint(path: str) -> str:
    """Return what the loader says about a file, wherever it notices."""
    with pytest.raises(DefinitionsError) as caught:
        load_definitions((path,), NEWEST_LTS).sections(*TYPES)
        builtin_tree((path,), NEWEST_LTS)
    return str(caught.value)


def builtin() -> list[PluginDefinition]:
    return load_definitions((), NEWEST_LTS).sections(*TYPES)


@pytest.mark.parametrize(
    ("row", "words"),
    [
        pytest.param("@x uses lnik", "unknown kind 'lnik'", id="kind"),
        pytest.param("@x uses link lnik", "unknown kind 'lnik'", id="second-kind"),
        pytest.param("@x declares", "@x has no kind", id="no-kind"),
        pytest.param("@x uses form=list", "@x has no kind", id="no-kind-but-form"),
        pytest.param("@x renames link", "declares, uses, keep", id="role"),
        pytest.param("@x", "declares, uses, keep", id="no-role"),
        pytest.param("some words here", "declares, uses, keep", id="prose"),
        pytest.param("@x uses link colour=red", "unknown option 'colour'", id="option"),
        pytest.param("@x uses link form=lsit", "unknown form 'lsit'", id="form"),
        pytest.param("@x uses link form=", "unknown form ''", id="empty-form"),
        pytest.param("colour: red", "unknown setting 'colour'", id="setting"),
        pytest.param("source:", "source: is ''", id="empty-setting"),
        pytest.param("ros: 3", "ros: is '3', use 1 or 2", id="ros"),
        pytest.param("ros: 1\nros: 2", "ros:", id="ros-twice"),
        pytest.param("insert: maybe", "insert: is 'maybe', use yes or no", id="insert"),
        pytest.param("switches: odom", "'odom' is not PARAMETER=TOPIC[=on]", id="switches"),
        pytest.param("publishes: odom=Odometry", "'odom=Odometry' is not TOPIC", id="type"),
        pytest.param("publishes: odom=", "'odom=' is not TOPIC or TOPIC=TYPE", id="empty-type"),
        pytest.param("publishes: a =nav_msgs/msg/Odometry", "is not TOPIC", id="no-topic"),
        pytest.param("serves: a=x/msg/{b}", "is not TOPIC", id="half-a-type"),
        pytest.param("subscribes: {a/b", "'{a/b' is not TOPIC", id="open-brace"),
        pytest.param("subscribes: ?a/b", "'?a/b' is not TOPIC", id="no-condition"),
        pytest.param("x uses topic publishes=Imu", "publishes=Imu is no type", id="row-type"),
        pytest.param("with: nope", "there is no [block nope]", id="block"),
        pytest.param("with: ros nope", "there is no [block nope]", id="second-block"),
    ],
)
def test_a_wrong_row_is_refused(tmp_path: Path, row: str, words: str) -> None:
    path = write(tmp_path, HEAD + row + "\n")
    message = complaint(path)
    # A missing block is reported at its section, a wrong value where it stands.
    lines = (1, 4) if "\n" in row else (1,) if row.startswith("with:") else (3,)
    assert message.startswith(tuple(f"{path}:{line}: " for line in lines))
    assert words in message


@pytest.mark.parametrize(
    "bad",
    [
        "/a", "//a", "a//b", "a/", "a/@x", "a@", "@", "@x/y", "a@x/b", "a@@x", "../a", ".", "*",
        "a/*", "@*", "text()", "a[@x]", "a[@x=]", "a[x=y]", "a[@x=y", "a[1]", "a'b", "a|b", "a=b",
        "a[@x=y]b",
    ],
)  # fmt: skip
def test_a_bad_path_is_refused(tmp_path: Path, bad: str) -> None:
    path = write(tmp_path, f"{HEAD}{bad} uses link\n")
    message = complaint(path)
    assert message.startswith(f"{path}:3: ")
    assert repr(bad) in message


@pytest.mark.parametrize(
    "good", ["a", "a/b", "a@x", "@x", "a_1/b_2@x", "a-b", "a[@x=y]/b", "a[@x=y]@z", "a/b[@x=y-1]"]
)
def test_a_good_path_is_taken(tmp_path: Path, good: str) -> None:
    path = write(tmp_path, f"{HEAD}{good} uses link\n")
    (mine,) = load_definitions((path,), NEWEST_LTS).find("plugin", "mine")
    assert [site.path for site in mine.sites] == [good]


def test_a_second_site_at_one_path_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, HEAD + "@x uses link\n\n@x uses joint\n")
    assert complaint(path) == f"{path}:5: @x is in line 3 already; remove one"


@pytest.mark.more
@pytest.mark.parametrize(
    ("text", "line"),
    [
        pytest.param("[gadget mine]\n", 1, id="type"),
        pytest.param("[plugin]\n", 1, id="no-name"),
        pytest.param("[]\n", 1, id="empty"),
        pytest.param("# a\n\n[plugin a]\n@x uses link\n\n[plguin b]\n", 6, id="later"),
        pytest.param("[plugin mine\n@x uses link\n", 1, id="no-bracket"),
        pytest.param("[plugin mine\n@x[@a=b] uses link\n", 1, id="bracket-in-another-line"),
        pytest.param("[plugin mine] uses link\n", 1, id="more-behind"),
        pytest.param("@x uses link\n[plugin mine]\n", 1, id="text-first"),
        pytest.param("# a\n\nhello\n[plugin mine]\n", 3, id="text-after-comment"),
        pytest.param(" [plugin mine]\n@x uses link\n", 1, id="indented"),
        pytest.param("[element mine]\n@x uses link\nat: robbot\n", 1, id="at"),
        pytest.param("[element mine]\nat: robot\nselect: gadget\n", 1, id="select"),
        pytest.param("[element mine]\nat: robot\n[element a.mine]\nat: robot\n", 3, id="same-tag"),
    ],
)
def test_a_wrong_section_is_refused(tmp_path: Path, text: str, line: int) -> None:
    path = write(tmp_path, text)
    assert complaint(path).startswith(f"{path}:{line}: ")


@pytest.mark.parametrize(
    "text",
    [
        pytest.param("[block a]\nwith: a\n", id="itself"),
        pytest.param("[block a]\nwith: b\n[block b]\nwith: a\n", id="each-other"),
    ],
)
def test_a_block_in_a_circle_is_refused(tmp_path: Path, text: str) -> None:
    path = write(tmp_path, text)
    assert complaint(path).startswith(f"{path}:")


def test_an_unreadable_file_is_named(tmp_path: Path) -> None:
    path = str(tmp_path / "missing.vocab")
    assert complaint(path).startswith(f"{path}: cannot be read: ")


def test_a_file_that_is_not_utf8_is_named(tmp_path: Path) -> None:
    path = tmp_path / "latin.vocab"
    path.write_bytes(HEAD.encode() + "# spät\n".encode("latin-1"))
    assert complaint(str(path)).startswith(f"{path}: cannot be read: ")


def test_a_mistake_in_a_section_that_is_used_stops_the_rewrite(tmp_path: Path) -> None:
    path = write(tmp_path, "[plugin my_winch]\n@name declares nodes\n")
    with pytest.raises(DefinitionsError, match="unknown kind 'nodes'") as caught:
        rewrite(ROBOT.format(library="my_winch"), "r1", definitions=[path])
    assert str(caught.value).startswith(f"{path}:2: ")


def test_settings_and_notes_are_read(tmp_path: Path) -> None:
    path = write(tmp_path, HEAD + "about: in two lines\nserves: a b\n@x uses link # why not\n")
    (mine,) = load_definitions((path,), NEWEST_LTS).find("plugin", "mine")
    assert (mine.about, mine.topics, mine.line) == ("a test in two lines", ("a", "b"), 1)
    assert (mine.sites[0].note, mine.sites[0].line) == ("why not", 5)


def test_places_are_known_before_a_section_is_read(tmp_path: Path) -> None:
    text = "[element reel]\nabout: one of many\nat: winch link\n@at uses link\nat: crane\n"
    definitions = load_definitions((write(tmp_path, text),), NEWEST_LTS)
    assert definitions.places()["reel"] == ["winch", "link", "crane"]


def test_an_own_site_wins_over_its_block(tmp_path: Path) -> None:
    text = "[block both]\n@a uses link\n@b uses link\n[plugin mine]\nwith: both\n@a uses joint\n"
    (mine,) = load_definitions((write(tmp_path, text),), NEWEST_LTS).find("plugin", "mine")
    assert {site.path: site.kinds for site in mine.sites} == {"@a": ("joint",), "@b": ("link",)}


@pytest.mark.slow
def test_the_builtin_definitions_has_no_mistake() -> None:
    rewriters = builtin()
    assert {section.type for section in rewriters} == set(TYPES)
    assert builtin_tree((), NEWEST_LTS).formats.keys() >= {"robot"}


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("type_", TYPES)
def test_a_builtin_name_has_one_section_for_each_ros(type_: str) -> None:
    sections = [r for r in builtin() if r.type == type_]
    count = Counter((name, r.ros) for r in sections for name in r.names)
    assert [key for key, times in count.items() if times > 1] == []
    # A section for both versions of ROS beside one for a single version leaves the choice open.
    plain = {name for name, ros in count if not ros}
    assert [name for name, ros in count if ros and name in plain] == []


@pytest.mark.more
def test_every_builtin_section_says_what_it_is() -> None:
    silent = [f"{r.file}:{r.line} {r.name}" for r in builtin() if not (r.about or r.source)]
    assert silent == []


@pytest.mark.parametrize("release", RELEASES)
def test_a_name_is_one_in_releases_that_read_its_value(release: str) -> None:
    definitions = load_definitions((), release)
    for section in definitions.sections("plugin"):
        values = definitions.values(section.names[0], section.ros == ROS_1)
        for site in (it for it in section.sites if values and it.role != "keep"):
            row = values.rows.get(site.path)
            assert not row or has_release(row.releases, release), (section.name, site.path)


def test_every_value_kept_says_why() -> None:
    kept = [(r.name, s.path) for r in builtin() for s in r.sites if s.role == "keep" and not s.note]
    assert kept == []


@pytest.mark.parametrize("library", ["my_winch", "my_hoist"])
def test_a_new_plugin_is_rewritten(tmp_path: Path, library: str) -> None:
    path = write(tmp_path, NEW_PLUGIN)
    result = rewrite(ROBOT.format(library=library), "r1", definitions=[path])
    inside = result.text[result.text.index("<plugin") :]
    assert '<plugin name="winch_r1"' in inside
    assert "<rope><from>base/r1</from></rope>" in inside
    assert '<cable joint="lift_r1"/>' in inside
    assert "<brakes>lift_r1, other</brakes>" in inside
    assert "<label>hook</label>" in inside
    assert "<spool_frame>spool/r1</spool_frame>" in inside
    assert [finding.code for finding in result.findings] == ["MB211"]


def test_without_its_file_the_plugin_is_reported() -> None:
    codes = [f.code for f in rewrite(ROBOT.format(library="my_winch"), "r1").findings]
    assert codes[0] == "MB902"
    assert codes.count("MB901") == 4


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("section", "expected"),
    [
        pytest.param("[element joint]\nat: robot\nmy@link uses link\n", '"lift_r1"', id="element"),
        pytest.param(
            "[plugin gazebo_ros_p3d]\nmine uses link\n",
            "<body_name>base/r1</body_name>",
            id="plugin",
        ),
        pytest.param(
            "[plugin gazebo_ros_p3d]\nmine uses link\n", "<mine>base/r1</mine>", id="addition"
        ),
    ],
)
def test_a_builtin_section_is_never_lost_without_a_word(
    tmp_path: Path, section: str, expected: str
) -> None:
    path = write(tmp_path, section)
    plugin = ROBOT.format(library="gazebo_ros_p3d").replace("<rope>", "<mine>base</mine><rope>")
    plugin = plugin.replace("<rope>", "<body_name>base</body_name><rope>")
    try:
        text = rewrite(plugin, "r1", definitions=[path]).text
    except DefinitionsError as error:
        assert str(error).startswith(f"{path}:1: ")
    else:
        assert expected in text
