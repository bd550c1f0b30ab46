# SPDX-License-Identifier: Apache-2.0
"""The report in a real browser: nothing is fetched, nothing from the graph runs, clicks find things."""

from __future__ import annotations

import json
import shutil
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import nav2_graphs
import pytest
import report_pages

from multibot_rewrite.pages.page import to_html
from multibot_rewrite.pages.scene import Scene

pytest.importorskip("selenium", reason="no selenium: pip install '.[test]'")
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.select import Select

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
DRIVER = shutil.which("chromedriver")
NO_BROWSER = "no browser: apt install chromium chromium-driver"
if not (BROWSER and DRIVER):
    warnings.warn(f"the report is not seen in a browser: {NO_BROWSER}", stacklevel=1)
pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(not (BROWSER and DRIVER), reason=NO_BROWSER),
]
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1280,900",
)
Open = Callable[[bytes], webdriver.Chrome]


def browser(folder: Path, script: bool = True) -> webdriver.Chrome:
    options = webdriver.ChromeOptions()
    options.binary_location = BROWSER or ""
    for flag in (*FLAGS, f"--user-data-dir={folder}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    if not script:
        blocked = {"profile.managed_default_content_settings.javascript": 2}
        options.add_experimental_option("prefs", blocked)
    return webdriver.Chrome(options, webdriver.ChromeService(DRIVER))


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    driver = browser(tmp_path_factory.mktemp("profile"))
    yield driver
    driver.quit()


@pytest.fixture
def show(chromium: webdriver.Chrome, tmp_path: Path) -> Iterator[Open]:
    """Yield a function that opens a page; nothing may have been fetched or complained about."""
    file = tmp_path / "report.html"

    def open_(data: bytes) -> webdriver.Chrome:
        file.write_bytes(data)
        forget(chromium)
        chromium.get(file.as_uri())
        return chromium

    yield open_
    assert chromium.get_log("browser") == []
    assert set(fetched(chromium)) == {file.as_uri()}


def forget(driver: webdriver.Chrome) -> None:
    driver.get("about:blank")
    for kind in ("browser", "performance"):
        driver.get_log(kind)


def fetched(driver: webdriver.Chrome) -> Iterator[str]:
    """Every address that was asked for since the log was read last."""
    for entry in driver.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            # What follows # is not sent.
            yield message["params"]["request"]["url"].partition("#")[0]


def spoiled() -> bytes:
    plan = nav2_graphs.nav2()
    return to_html(nav2_graphs.scene(plan, nav2_graphs.spoiled(plan)))


def swarm() -> bytes:
    plan = nav2_graphs.fleet(30, 4)
    graph = nav2_graphs.moved(nav2_graphs.healthy(plan), "/robot7/topic1", "/topic1")
    return to_html(nav2_graphs.scene(plan, nav2_graphs.without_node(graph, "/robot9/driver")))


def every(driver: webdriver.Chrome, css: str) -> list[Any]:
    return driver.find_elements(By.CSS_SELECTOR, css)


def seen(driver: webdriver.Chrome, css: str) -> list[Any]:
    return [element for element in every(driver, css) if element.is_displayed()]


def row(driver: webdriver.Chrome, code: str) -> Any:
    return next(it for it in every(driver, "#findings .finding") if code in it.text)


def labels(driver: webdriver.Chrome, css: str) -> set[str]:
    """Return what stands in parts of a drawing, in front of what is told on a hover."""
    script = "return arguments[0].querySelector('text').textContent"
    return {driver.execute_script(script, part) for part in every(driver, css)}


def in_view(driver: webdriver.Chrome, element: Any) -> bool:
    script = """const box = arguments[0].getBoundingClientRect();
    return box.height > 0 && box.top >= 0 && box.bottom <= innerHeight;"""
    return bool(driver.execute_script(script, element))


def test_faults_are_first(show: Open) -> None:
    driver = show(spoiled())
    assert every(driver, "h1")[0].text.lower() == "not as planned"
    texts = [it.text for it in seen(driver, "#findings .finding")]
    assert len(texts) == len(
        nav2_graphs.scene(nav2_graphs.nav2(), nav2_graphs.spoiled(nav2_graphs.nav2())).findings
    )
    assert any("publishes /cmd_vel, which no node reads" in text for text in texts)
    assert in_view(driver, every(driver, "#findings .finding")[0])


@pytest.mark.parametrize(
    ("code", "marked", "ends"),
    [
        ("MG101", {"/robot2/bt_navigator"}, {"missing"}),
        (
            "MG308",
            {"/robot1/collision_monitor", "/robot1/diff_drive", "/cmd_vel", "/robot1/cmd_vel"},
            {"leak", "missing"},
        ),
        ("MG321", {"/robot2/amcl", "/robot1/scan", "/robot2/scan"}, {"cross-talk", "missing"}),
        ("MG401", {"lidar_link/robot1"}, set()),
    ],
)
def test_a_click_on_a_finding_shows_what_it_is_about(
    show: Open, code: str, marked: set[str], ends: set[str]
) -> None:
    driver = show(spoiled())
    assert every(driver, ".hit") == []
    row(driver, code).find_element(By.CSS_SELECTOR, "summary .level").click()
    assert labels(driver, "g.hit") == marked
    row(driver, code).find_element(By.CSS_SELECTOR, "a.place").click()
    assert labels(driver, "g.hit") == marked
    assert any(in_view(driver, part) for part in every(driver, "g.hit"))
    strokes = {part.value_of_css_property("stroke") for part in seen(driver, "g.hit > rect")}
    assert "rgb(255, 207, 51)" in strokes
    lines = {path.get_attribute("class") for path in every(driver, "path.hit")}
    assert lines == {f"e {state} hit" for state in ends}
    driver.find_element(By.TAG_NAME, "body").send_keys(Keys.ESCAPE)
    assert every(driver, ".hit") == []


def test_findings_are_filtered_by_level_and_robot(show: Open) -> None:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.with_end(nav2_graphs.spoiled(plan), "/robot2/gripper", "/robot2/grip")
    scene = nav2_graphs.scene(plan, graph)
    driver = show(to_html(scene))
    pairs = [(row.finding.level, row.robots) for row in scene.rows]
    level, robot = (Select(it) for it in every(driver, "#filters select"))
    assert len(seen(driver, "#findings .finding")) == len(pairs)
    robot.select_by_visible_text("robot2")
    assert len(seen(driver, "#findings .finding")) == sum("robot2" in it[1] for it in pairs)
    level.select_by_visible_text("warning")
    shown = seen(driver, "#findings .finding")
    assert len(shown) == pairs.count(("warning", ("robot2",))) == 1
    assert every(driver, "#filters output")[0].text == f"1 of {len(pairs)} rows"
    robot.select_by_visible_text("all robots")
    level.select_by_visible_text("all levels")
    assert len(seen(driver, "#findings .finding")) == len(pairs)


def test_what_every_node_has_is_shown_on_request(show: Open) -> None:
    driver = show(spoiled())
    assert seen(driver, ".more") == []
    every(driver, "label[for=more]")[0].click()
    assert len(seen(driver, ".more")) == 3
    assert "/rosout" in labels(driver, ".more g.t")


def test_a_part_of_the_drawing_is_marked_by_click_and_by_key(show: Open) -> None:
    driver = show(spoiled())
    node = next(it for it in every(driver, "#g0 g.n") if "velocity_smoother" in it.text)
    node.click()
    assert labels(driver, "g.hit") == {"/robot1/velocity_smoother"}
    assert len(every(driver, "path.hit")) >= 2
    driver.find_element(By.TAG_NAME, "body").send_keys(Keys.ESCAPE)
    topic = next(it for it in every(driver, "#g0 g.t") if "/cmd_vel_smoothed" in it.text)
    driver.execute_script("arguments[0].focus()", topic)
    driver.switch_to.active_element.send_keys(Keys.ENTER)
    assert labels(driver, "g.hit") == {"/robot1/cmd_vel_smoothed"}


def test_findings_are_reached_with_the_keyboard(show: Open) -> None:
    driver = show(spoiled())
    link = row(driver, "MG321").find_element(By.CSS_SELECTOR, "a.place")
    driver.execute_script("arguments[0].focus()", link)
    link.send_keys(Keys.ENTER)
    assert labels(driver, "g.hit") == {"/robot2/amcl", "/robot1/scan", "/robot2/scan"}


def test_a_code_opens_what_it_means(show: Open) -> None:
    driver = show(spoiled())
    (folded,) = every(driver, "#rule-MG321")
    assert "avoids obstacles, with the data of the other" not in folded.text.lower()
    row(driver, "MG321").find_element(By.CSS_SELECTOR, "a.rule").click()
    assert "avoids obstacles, with the data of the other" in folded.text.lower()
    assert in_view(driver, folded)
    assert every(driver, ".hit") == []


def test_a_row_of_many_robots_is_found_by_each_of_them(show: Open) -> None:
    plan = nav2_graphs.fleet(5, 4)
    graph = nav2_graphs.healthy(plan)
    for robot in plan.robots:
        graph = nav2_graphs.moved(graph, f"/{robot.name}/topic1", "/topic1", "driver")
    driver = show(to_html(nav2_graphs.scene(plan, graph)))
    Select(every(driver, "#filters select")[1]).select_by_visible_text("robot4")
    shown = seen(driver, "#findings .finding")
    assert ["robot1, robot2, robot3 and 2 more" in it.text for it in shown] == [True]


def test_a_large_fleet_opens_where_something_is_wrong(show: Open) -> None:
    driver = show(swarm())
    drawings = seen(driver, "svg.graph")
    assert len(drawings) == 3
    assert len(seen(driver, "svg.overview g.tile")) == 2
    assert len(seen(driver, ".card")) == 3
    row(driver, "MG320").click()
    assert labels(driver, "g.hit") >= {"/topic1"}
    # The name of a healthy robot leads into what is folded away.
    every(driver, ".card h3 summary")[0].click()
    next(it for it in seen(driver, ".card a") if it.text == "robot20").click()
    assert in_view(driver, every(driver, "#g19 > summary")[0])


def colours(driver: webdriver.Chrome, dark: bool) -> tuple[int, int]:
    """How bright page and letters are, 0 to 765."""
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})
    body = every(driver, "body")[0]
    return brightness(body.value_of_css_property("background-color")), brightness(
        body.value_of_css_property("color")
    )


def brightness(colour: str) -> int:
    inside = colour[colour.index("(") + 1 : -1]
    return sum(int(part) for part in inside.split(",")[:3])


def test_the_page_is_light_or_dark_as_the_reader_has_it(show: Open) -> None:
    driver = show(spoiled())
    page, letters = colours(driver, dark=False)
    assert page > 700 and letters < 150
    dark_page, dark_letters = colours(driver, dark=True)
    assert dark_page < 150 and dark_letters > 600
    fills = {it.value_of_css_property("fill") for it in every(driver, "#g0 svg.graph text")[:40]}
    assert all(brightness(fill) > 350 for fill in fills)
    colours(driver, dark=False)


def test_what_is_open_is_printed_without_switches(show: Open) -> None:
    driver = show(swarm())
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    assert seen(driver, "#filters, #more, label[for=more]") == []
    assert len(seen(driver, "svg.graph")) == 3 and seen(driver, "#findings .finding")
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


@pytest.mark.parametrize("case", ["healthy", "spoiled", "swarm", "nasty"])
def test_nothing_is_wider_than_the_page(show: Open, case: str) -> None:
    plan = nav2_graphs.nav2()
    pages = {
        "healthy": lambda: to_html(nav2_graphs.scene(plan, nav2_graphs.healthy(plan))),
        "spoiled": spoiled,
        "swarm": swarm,
        "nasty": lambda: to_html(nav2_graphs.scene(*nav2_graphs.nasty(plan))),
    }
    driver = show(pages[case]())
    every(driver, "label[for=more]")[0].click()
    for wide in (1280, 800):
        driver.set_window_size(wide, 900)
        widths = "return [document.documentElement.scrollWidth, innerWidth]"
        there, room = driver.execute_script(widths)
        assert there <= room <= wide
    driver.set_window_size(1280, 900)
    # Names stay in their boxes.
    script = """return [...document.querySelectorAll('.graph g.n, .graph g.t')].filter((part) => {
      const box = part.querySelector('rect').getBoundingClientRect();
      return [...part.querySelectorAll('text')].some((text) => {
        const inner = text.getBoundingClientRect();
        return inner.width && (inner.right > box.right + 1 || inner.left < box.left - 1);
      });
    }).map((part) => part.textContent)"""
    assert driver.execute_script(script) == []


def test_names_from_the_graph_run_nothing(show: Open) -> None:
    driver = show(to_html(nav2_graphs.scene(*nav2_graphs.nasty(nav2_graphs.nav2()))))
    for it in every(driver, "#findings .finding")[:6]:
        it.click()
    script = "return [typeof window.pwned, document.images.length, document.scripts.length]"
    assert driver.execute_script(script) == ["undefined", 0, 1]
    text = driver.find_element(By.TAG_NAME, "body").text
    assert "</script><script>window.pwned=1</script>" in text


def test_a_hundred_robots_are_few_elements(show: Open) -> None:
    plan = nav2_graphs.fleet(100, 20)
    graph = nav2_graphs.moved(nav2_graphs.healthy(plan), "/robot50/topic2", "/topic2")
    driver = show(to_html(nav2_graphs.scene(plan, graph)))
    # How long a browser works is by how much there is.
    assert driver.execute_script("return document.all.length") < 15_000
    row(driver, "MG320").click()
    assert "/topic2" in labels(driver, "g.hit")


# ---------------------------------------------------------------- what a reader sees at once

# Visible text that is cut by its box, runs out of the page, or has something else upon it.
UNREADABLE = """return [...document.querySelectorAll(
    'h1, header li, .card a, .card p, .finding b, .finding .what, #filters label, h2, .legend li')]
  .filter((part) => part.checkVisibility()).filter((part) => {
    const box = part.getBoundingClientRect();
    const wraps = getComputedStyle(part).display === 'block';
    if (wraps && part.scrollWidth > part.clientWidth + 1) return true;
    if (box.left < 0 || box.right > document.documentElement.clientWidth) return true;
    if (box.top < 0 || box.bottom > innerHeight) return false;
    const line = part.getClientRects()[0];
    const top = document.elementFromPoint(line.left + 2, line.top + line.height / 2);
    return !(part.contains(top) || top.contains(part));
  }).map((part) => part.outerHTML)"""


def painted(driver: webdriver.Chrome, css: str) -> tuple[int, int, int]:
    """Return the colour of a background."""
    colour = every(driver, css)[0].value_of_css_property("background-color")
    red, green, blue = (int(part) for part in colour[colour.index("(") + 1 : -1].split(",")[:3])
    return red, green, blue


@pytest.mark.parametrize(
    ("state", "scene", "wide", "dark"),
    [
        ("healthy", report_pages.healthy, 1280, False),
        ("tf-collision", report_pages.tf_collision, 1280, False),
        ("twenty-robots", report_pages.twenty, 1280, False),
        ("narrow", report_pages.spoiled, 600, False),
        ("dark", report_pages.spoiled, 1280, True),
        ("inconclusive", report_pages.inconclusive, 1280, False),
    ],
)
def test_a_screenshot_shows_verdict_robots_and_findings(
    state: str, scene: Callable[[], Scene], wide: int, dark: bool, show: Open, tmp_path: Path
) -> None:
    made = scene()
    driver = show(to_html(made))
    size = {"width": wide, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        light, letters = colours(driver, dark)
        assert driver.save_screenshot(str(tmp_path / f"{state}.png"))
        assert driver.execute_script(UNREADABLE) == []
        assert in_view(driver, every(driver, "h1")[0])
        assert in_view(driver, every(driver, ".card")[0])
        assert driver.execute_script("return document.documentElement.scrollWidth") <= wide
        assert len(seen(driver, "#findings .finding")) == len(made.rows)
        assert (light < letters) is dark
        red, green, _ = painted(driver, "header")
        kind = every(driver, "header")[0].get_attribute("class")
        assert {"good": green > red, "bad": red > green, "unsure": red > green}[kind]
        drawn = tmp_path / f"{state}.png"
        assert drawn.stat().st_size > 20_000
    finally:
        colours(driver, dark=False)
        driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_an_opened_finding_says_why_and_what_to_do(show: Open) -> None:
    driver = show(spoiled())
    first = row(driver, "MG321")
    assert "Why it matters" not in first.text
    first.find_element(By.CSS_SELECTOR, "summary .level").click()
    words = ("Where", "/robot2/amcl, /robot1/scan", "Why it matters", "What to do")
    assert all(word in first.text for word in words)
    driver.find_element(By.TAG_NAME, "body").send_keys(Keys.ESCAPE)


def test_a_line_of_a_card_leads_to_its_finding(show: Open) -> None:
    driver = show(to_html(report_pages.twenty()))
    (brief,) = (it for it in every(driver, ".brief") if "topic names miss" in it.text)
    brief.click()
    (picked,) = every(driver, ".finding.picked")
    assert "MG303" in picked.text and picked.get_attribute("open")
    assert in_view(driver, picked.find_element(By.TAG_NAME, "summary"))


def test_a_name_filters_findings_and_drawings(show: Open) -> None:
    driver = show(spoiled())
    typed = every(driver, "#filters input")[0]
    typed.send_keys("robot2/AMCL")
    codes = {it.text for it in seen(driver, ".finding a.rule")}
    assert codes == {"MG321", "MG401"}
    # What it is connected to stays.
    assert "/robot2/amcl" in labels(driver, "#g1 > .frame:not(.more) .n:not(.off)")
    assert "/robot2/velocity_smoother" in labels(driver, "#g1 > .frame:not(.more) .n.off")
    assert "/robot1/scan" in labels(driver, "#g1 > .frame:not(.more) .t:not(.off)")
    assert "/robot2/plan" not in labels(driver, "#g1 > .frame:not(.more) .t:not(.off)")
    assert not every(driver, "#tf .group")[0].is_displayed()
    typed.clear()
    typed.send_keys(Keys.SPACE)
    assert every(driver, ".off") == [] and every(driver, "#tf .group")[0].is_displayed()


def test_a_robot_filters_cards_and_drawings_as_well(show: Open) -> None:
    driver = show(spoiled())
    robot = Select(every(driver, "#filters select")[1])
    robot.select_by_visible_text("robot2")
    assert [it.text for it in seen(driver, ".card h3")] == ["robot2"]
    assert [it.get_attribute("id") for it in seen(driver, "#graph .group")] == ["g1"]
    robot.select_by_visible_text("all robots")
    assert len(seen(driver, "#graph .group")) == 3


def test_a_drawing_is_larger_and_as_it_was(show: Open) -> None:
    driver = show(spoiled())
    width = "return document.querySelector('#g0 svg').getBoundingClientRect().width"
    larger, smaller, fit = every(driver, "#g0 > .frame:not(.more) .zoom button")
    before = driver.execute_script(width)
    larger.click()
    assert driver.execute_script(width) == pytest.approx(before * 1.3, abs=2)
    # It is moved by dragging.
    pane = every(driver, "#g0 .pane")[0]
    left = driver.execute_script("return arguments[0].scrollLeft", pane)
    webdriver.ActionChains(driver).drag_and_drop_by_offset(pane, -60, 0).perform()
    assert driver.execute_script("return arguments[0].scrollLeft", pane) > left
    fit.click()
    assert driver.execute_script(width) == pytest.approx(before, abs=2)
    smaller.click()
    assert driver.execute_script(width) < before


def test_it_reads_and_links_without_scripts(
    tmp_path_factory: pytest.TempPathFactory, tmp_path: Path
) -> None:
    file = tmp_path / "report.html"
    file.write_bytes(swarm())
    driver = browser(tmp_path_factory.mktemp("profile"), script=False)
    try:
        driver.get(file.as_uri())
        assert every(driver, "#filters")[0].is_displayed() is False
        assert seen(driver, "#findings .finding") and seen(driver, "svg.graph")
        every(driver, "label[for=more]")[0].click()
        assert seen(driver, ".more")
        row(driver, "MG320").find_element(By.CSS_SELECTOR, "a.place").click()
        (target,) = every(driver, "g:target")
        assert in_view(driver, target)
    finally:
        driver.quit()
