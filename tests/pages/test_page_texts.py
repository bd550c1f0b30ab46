# SPDX-License-Identifier: Apache-2.0
"""The words and tags of the page around its drawings: filters, findings, explanations, robots, head."""

from __future__ import annotations

import re

import pytest

from multibot_rewrite.base.findings.finding import Finding, Rule
from multibot_rewrite.live.watching import Outcome, Verdict
from multibot_rewrite.pages.finding_list import (
    Sources,
    explanations,
    filters,
    finding_list,
    with_code,
)
from multibot_rewrite.pages.page import Framed, source_hash, to_html
from multibot_rewrite.pages.page_sections import make_ids, make_sections, robot_cards
from multibot_rewrite.pages.scene import DrawnGroup, DrawnNode, FindingRow, Scene
from multibot_rewrite.pages.states import MISSING, OK, Targets
from multibot_rewrite.system.coverage import SEEN, Coverage, Covered
from multibot_rewrite.system.records import Caveat, Environment

NOTHING = Targets((), (), ())


class WrittenRule(Rule):
    """A rule without a page."""

    why, fix = "Why <it>.", "Fix `it`."

    @property
    def what(self) -> str:
        return f"What `{self.code}` is."


RULES = {
    code: WrittenRule(code, name, level)
    for code, name, level in (("MG1", "two-nodes", "error"), ("MG2", "odd-name", "warning"))
}
SOURCES = Sources(RULES, {"a:b.urdf:7": ["6 <a>", "7 <b> c", "8 <c>"]})


def node(name: str, robot: str, state: str = OK, is_robot: bool = False) -> DrawnNode:
    return DrawnNode(name, robot, state, is_robot)


def scene(*robots: str, rows: tuple[FindingRow, ...] = (), **more: object) -> Scene:
    """Each robot has two nodes, one of which is missing; a tool is of no robot."""
    groups = [
        DrawnGroup(it, (node(f"/{it}/a", it), node(f"/{it}/b", it, MISSING)), (), ())
        for it in robots
    ]
    shared = DrawnGroup("", (node("/tool", ""), node(robots[0], robots[0], OK, True)), (), ())
    made = Scene(
        Outcome(Verdict.PLANNED, "as planned"), "both", robots, (*groups, shared), (), (),
        tuple(it.finding for it in rows), rows, Environment(), (), frozenset(),
    )  # fmt: skip
    return made._replace(**more)  # type: ignore[arg-type]


def row(
    *robots: str, code: str = "MG1", level: str = "error", place: str = "", **more: object
) -> FindingRow:
    found = Finding(code, level, "is <bad>")._replace(robot=robots[0] if robots else "", **more)  # type: ignore[arg-type]
    return FindingRow(found, NOTHING, robots, place)


def findings(made: Scene) -> str:
    return "".join(finding_list(made, make_ids(made), make_sections(made), SOURCES))


def cards(made: Scene) -> str:
    return "".join(robot_cards(made, make_sections(made), RULES))


def test_filters_have_the_levels_and_robots_that_there_are() -> None:
    made = scene("r1", "<r2>", rows=(row(level="warning"), row(level="note")))
    assert "".join(filters(made)) == (
        '<p id="filters" hidden><label>level <select name="level"><option value="">all levels</option>'
        '<option value="warning">warning</option></select></label> '
        '<label>robot <select name="robot"><option value="">all robots</option>'
        '<option value="0">r1</option><option value="1">&lt;r2&gt;</option>'
        '<option value="-1">no robot</option></select></label> '
        '<label>name <input type="search" name="text" placeholder="node, topic, frame"></label> '
        '<output aria-live="polite"></output></p>\n'
    )


def test_a_finding_with_all_that_is_known_of_it() -> None:
    one = row(
        "r1",
        "r2",
        place="a:b.urdf:7",
        hint="do <it>",
        node="/r1/a",
        names=("/t", "/u"),
        robots=("r1", "r2"),
    )
    assert findings(scene("r1", "r2", rows=(one,))) == (
        '<section id="findings">\n<h2>Findings</h2>\n'
        '<details class="finding" id="finding-0" data-level="error" data-robot="0 1" data-hits="">'
        '<summary><b class="level error">error</b><a class="rule" href="#rule-MG1">MG1</a>'
        '<b class="who" title="r1, r2">r1, r2</b><span class="what">'
        '<a class="place" href="#g0"><code>/r1/a</code></a> is &lt;bad&gt;'
        "<small>do &lt;it&gt;</small></span></summary>"
        "<dl><div><dt>Where</dt><dd>/r1/a, /t, /u</dd></div>"
        "<div><dt>Robots</dt><dd>r1, r2</dd></div>"
        "<div><dt>Why it matters</dt><dd>Why &lt;it&gt;.</dd></div>"
        "<div><dt>What to do</dt><dd>Fix <code>it</code>.</dd></div>"
        "<div><dt>Written in</dt><dd><code>a:b.urdf:7</code></dd></div></dl>"
        "<pre>6 &lt;a&gt;\n<b>7 &lt;b&gt; c</b>\n8 &lt;c&gt;</pre></details>\n</section>\n"
    )


def test_a_finding_of_nobody() -> None:
    assert findings(scene("r1", rows=(row(code="MX9"),))) == (
        '<section id="findings">\n<h2>Findings</h2>\n'
        '<details class="finding" id="finding-0" data-level="error" data-robot="-1" data-hits="">'
        '<summary><b class="level error">error</b><a class="rule" href="#rule-MX9">MX9</a>'
        '<b class="who" title=""></b><span class="what"><a class="place" href="#shared">show</a>'
        " is &lt;bad&gt;</span></summary><dl></dl></details>\n</section>\n"
    )


def test_what_a_finding_is_about_is_named_by_its_ids() -> None:
    one = row("r1")._replace(targets=Targets(("/r1/b", "/tool"), (), ()))
    found = findings(scene("r1", rows=(one,)))
    assert 'data-hits="n1 n2"' in found and 'href="#g0-n1"' in found


def test_many_robots_and_names_are_shortened() -> None:
    one = row(
        "r1", names=tuple(f"/t{at}" for at in range(22)), robots=("r1", "r2", "r3", "r4", "r5")
    )
    found = findings(scene("r1", rows=(one,)))
    assert '<b class="who" title="r1, r2, r3, r4, r5">r1, r2, r3 and 2 more</b>' in found
    assert "/t19 and 2 more</dd>" in found and "/t20" not in found
    # Without a robot of its own, those that it concerns are named.
    one = row("r1", "r2")
    other = one._replace(finding=one.finding._replace(robot=""))
    assert 'title="r1, r2">r1, r2</b>' in findings(scene("r1", "r2", rows=(other,)))


def test_where_nothing_is_found_no_more_is_said_than_was_seen() -> None:
    rows = (Covered("r1", 2, 1, 2, 0),)
    made = scene("r1", outcome=Outcome(Verdict.INCONCLUSIVE, "not <sure>"))
    assert findings(made._replace(coverage=Coverage(rows, compared=SEEN))) == (
        '<section id="findings">\n<h2>Findings</h2>\n<p class="none">1 robot, 2 nodes: 1 known, 1'
        " started as it is, all seen; no findings: not &lt;sure&gt;</p>\n</section>\n"
    )


def test_codes_are_explained_once_and_in_order() -> None:
    assert "".join(explanations(["MG2", "MG1", "MG2", "MX9"], RULES)) == (
        '<section id="rules">\n<h2>What the codes mean</h2>\n'
        '<details id="rule-MG1"><summary class="bad"><b>MG1</b> two-nodes <span>error</span>'
        "</summary>\n<div><p><b></b>What <code>MG1</code> is.</p><p><b>Why: </b>Why &lt;it&gt;.</p>"
        "<p><b>Fix: </b>Fix <code>it</code>.</p></div></details>\n"
        '<details id="rule-MG2"><summary class="odd"><b>MG2</b> odd-name <span>warning</span>'
        "</summary>\n<div><p><b></b>What <code>MG2</code> is.</p><p><b>Why: </b>Why &lt;it&gt;.</p>"
        "<p><b>Fix: </b>Fix <code>it</code>.</p></div></details>\n</section>\n"
    )
    assert "".join(explanations(["MX9"], RULES)) == ""
    assert with_code("`a` < `b` `c") == "<code>a</code> &lt; <code>b</code> `c"


def test_robots_with_findings_are_first_and_equal_ones_are_one_card() -> None:
    rows = (
        row("r2", "r3", names=("/r2/t",), robots=("r2", "r3"), node="/r2/a"),
        row("r2", "r3", code="MX9", level="warning", node="/r2/n"),
    )
    assert cards(scene("r1", "r2", "r3", rows=rows)) == (
        '<div class="cards" role="list" aria-label="robots">\n'
        '<div class="card bad" role="listitem" data-robot="1 2"><h3><a href="#g1">r2</a>, '
        '<a href="#g2">r3</a></h3><p>2 robots, 1 error, 1 warning each; 2 nodes running</p><ul>'
        '<li><a class="brief error" href="#finding-0" title="is &lt;bad&gt;"><b>two nodes</b>'
        " <code>/r2/t</code></a></li>"
        '<li><a class="brief warning" href="#finding-1" title="is &lt;bad&gt;"><b>MX9</b>'
        " <code>/r2/n</code></a></li></ul></div>\n"
        '<div class="card odd" role="listitem" data-robot="0"><h3><a href="#g0">r1</a></h3>'
        "<p>as planned; 1 node running</p></div>\n</div>\n"
    )


def test_what_is_of_no_robot_has_a_card_where_it_is_found() -> None:
    found = cards(scene("r1", rows=(row(node="/tool"),)))
    assert (
        '<div class="card bad" role="listitem" data-robot="-1">'
        '<h3><a href="#shared">shared, or of no robot</a></h3><p>1 error; 1 node running</p>'
    ) in found


def test_a_card_of_another_robot_has_its_own_names() -> None:
    """r2 has a finding more, so that it has a card of its own."""
    both = row("r1", "r2", message="of r1", names=("/r1/t",), robots=("r1", "r2"))
    first, second = re.findall(
        r'title="(.*?)"><b>two nodes</b> <code>(.*?)<',
        cards(scene("r1", "r2", rows=(both, row("r2", code="MX9")))),
    )
    assert {first, second} == {("of r1", "/r1/t"), ("of r2", "/r2/t")}


@pytest.mark.parametrize(
    ("outcome", "rows", "said"),
    [
        (Outcome(Verdict.PLANNED, ""), (), "as planned"),
        (Outcome(Verdict.INCONCLUSIVE, ""), (), "nothing wrong seen"),
        (Outcome(Verdict.PLANNED, "", planned=False), (), "nothing wrong seen"),
        (Outcome(Verdict.PLANNED, ""), (row("r1", level="note"),), "notes only"),
    ],
)
def test_the_state_of_a_robot(outcome: Outcome, rows: tuple[FindingRow, ...], said: str) -> None:
    assert f"<p>{said}; 1 node running</p>" in cards(scene("r1", outcome=outcome, rows=rows))


def test_only_robots_whose_nodes_are_known_are_as_planned() -> None:
    rows = (Covered("r1", 2, 2, 2, 0), Covered("r2", 2, 1, 2, 0))
    made = scene("r1", "r2", rows=(row("r1"),))._replace(coverage=Coverage(rows))
    assert "<p>as planned as far as known; 1 node running</p>" in cards(made)


def test_many_findings_and_robots_of_a_card_are_folded() -> None:
    made = cards(scene("r1", rows=tuple(row("r1") for _ in range(7))))
    assert "<details><summary>2 more</summary><ul><li>" in made
    assert made.count("<li>") == 7 and made.partition("<details>")[0].count("<li>") == 5
    assert "<details>" not in cards(scene("r1", rows=tuple(row("r1") for _ in range(5))))
    many = [f"r{at}" for at in range(10)]
    made = cards(scene(*many))
    assert (
        '<a href="#g7">r7</a> <details><summary>2 more robots</summary><a href="#g8">r8</a>, '
        '<a href="#g9">r9</a></details></h3><p>10 robots, as planned; 10 nodes running</p>'
    ) in made
    assert "<details>" not in cards(scene(*many[:8]))


def head(made: Scene) -> str:
    text = to_html(made, RULES).decode()
    return text[text.index("<header") : text.index('<div class="cards"')]


def test_the_head_of_the_page() -> None:
    """It says how much was there; a good verdict with findings is not drawn as good."""
    caveats = (Caveat("a", True, "cut <off>"), Caveat("b", False, "a note"))
    made = scene(
        "r1", "r2", rows=(row("r1", level="warning"),), environment=Environment(caveats=caveats),
        outcome=Outcome(Verdict.PLANNED, "as planned", reasons=("a rule was left out", "cut <off>")),
    )._replace(coverage=Coverage((Covered("r1", 2, 1, 1, 0),), compared=SEEN))  # fmt: skip
    assert head(made) == (
        '<header class="unsure">\n<p>multibot check</p>\n<h1>as planned</h1>\n<ul><li>1 warning</li>'
        "<li>2 robots: r1, r2</li><li>1 robot, 2 nodes: 1 known, 1 started as it is, 1 of 2"
        " seen</li><li>layout both: tf topic and frames per robot</li></ul>\n"
        '<p class="doubt">cut &lt;off&gt;</p>\n<p class="doubt">a rule was left out</p>\n'
    )


@pytest.mark.parametrize(
    ("verdict", "level", "look"),
    [
        (Verdict.PLANNED, "note", "good"), (Verdict.PLANNED, "error", "unsure"),
        (Verdict.INCONCLUSIVE, "error", "unsure"), (Verdict.WRONG, "error", "bad"),
        (Verdict.WRONG, "note", "bad"),
    ],
)  # fmt: skip
def test_the_colour_of_the_head(verdict: Verdict, level: str, look: str) -> None:
    made = scene("r1", rows=(row("r1", level=level),), outcome=Outcome(verdict, "so"))
    found = head(made)
    assert found.startswith(f'<header class="{look}">') and f"<li>1 {level}</li>" in found


def test_a_graph_without_a_plan_has_a_look_not_a_layout() -> None:
    outcome = Outcome(Verdict.PLANNED, "so", by="who <says>", planned=False)
    found = head(scene("r1", layout="mine", outcome=outcome))
    assert "<p>who &lt;says&gt;</p>" in found and "<li>no findings</li>" in found
    assert "<li>looks like layout mine</li>" in found
    assert (
        "<title>so: 1 robot, layout mine</title>"
        in to_html(scene("r1", layout="mine", outcome=outcome)).decode()
    )


def test_a_serious_finding_beside_a_note_is_enough() -> None:
    rows = (row("r1", level="note"), row("r1", level="error"))
    made = scene("r1", rows=rows)
    assert head(made).startswith('<header class="unsure">')
    assert "</div>\n</header>\n<main>\n" in to_html(made, RULES).decode()


def environment(**known: object) -> str:
    made = scene("r1", environment=Environment()._replace(**known))  # type: ignore[arg-type]
    text = to_html(made, RULES).decode()
    return text[text.index('<section id="environment">') : text.index("</main>")]


def test_how_the_graph_was_observed() -> None:
    caveats = (Caveat("a", True, "cut <off>"), Caveat("b", False, "tools"))
    assert environment(
        domain=7, range="SUBNET", static_peers=("a", "b"), rmw="rmw_x", discovery_server="host:1",
        super_client=True, participants=3, settled="timeout", seconds=2.25, caveats=caveats,
    ) == (
        '<section id="environment">\n<h2>Environment</h2>\n<dl>'
        "<div><dt>domain</dt><dd>7</dd></div><div><dt>RMW</dt><dd>rmw_x</dd></div>"
        "<div><dt>discovery range</dt><dd>SUBNET</dd></div>"
        "<div><dt>static peers</dt><dd>a b</dd></div>"
        "<div><dt>discovery server</dt><dd>host:1, super client</dd></div>"
        "<div><dt>participants</dt><dd>3</dd></div>"
        "<div><dt>observed for</dt><dd>2.2 s (timeout)</dd></div></dl>\n"
        '<p class="incomplete"><b>incomplete</b> cut &lt;off&gt;</p>\n'
        '<p class="note"><b>note</b> tools</p>\n</section>\n'
    )  # fmt: skip


def test_what_was_not_set_is_none_and_zenoh_has_a_router() -> None:
    assert (
        "<div><dt>static peers</dt><dd>none</dd></div>"
        "<div><dt>discovery server</dt><dd>none</dd></div>"
    ) in environment(settled="quiet")
    assert "(no more changes)" in environment(settled="quiet")
    found = environment(rmw="rmw_zenoh_cpp", discovery_server="tcp/a:1")
    assert "<div><dt>router</dt><dd>tcp/a:1</dd></div>" in found and "discovery" not in found


def test_the_page_lets_nothing_in() -> None:
    """W3C, Content Security Policy Level 3: only the style and the scripts that are in it, by hash."""
    text = to_html(scene("r1"), RULES).decode()
    style = re.search(r"<style>(.*?)</style>", text, re.DOTALL)
    script = re.search(r"<script>(.*?)</script>", text, re.DOTALL)
    assert style and script
    own = f"style-src {source_hash(style[1])}; script-src {source_hash(script[1])}"
    end = "base-uri 'none'; form-action 'none'"
    policy = '<meta http-equiv="Content-Security-Policy" content="{}">'
    assert policy.format(f"default-src 'none'; {own}; {end}") in text
    framed = Framed('<p class="a">', "'sha256-s'", "'sha256-t'")
    text = to_html(scene("r1"), RULES, robots=framed).decode()
    own = (
        f"style-src {source_hash(style[1])} 'sha256-s'; img-src data: blob:; "
        f"script-src {source_hash(script[1])} 'sha256-t'"
    )
    assert policy.format(f"default-src 'none'; {own}; {end}") in text
    assert (
        '<section id="robots">\n<h2>The robots</h2>\n<iframe title="the robots in 3D"'
        ' sandbox="allow-scripts" srcdoc="&lt;p class=&quot;a&quot;&gt;"></iframe>\n</section>\n'
    ) in text
    # echo -n abc | openssl dgst -sha256 -binary | base64
    assert source_hash("abc") == "'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='"
    assert text.startswith('<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n')
    assert '<meta name="viewport" content="width=device-width, initial-scale=1">' in text
    assert '<meta name="color-scheme" content="light dark">' in text
