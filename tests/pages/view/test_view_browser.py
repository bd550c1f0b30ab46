# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: it draws, and a click tells what a name was."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from graph_cases import healthy
from paths import ROBOTS
from view_pages import with_places

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.system.json import to_json

pytest.importorskip("selenium", reason="no selenium: pip install '.[test]'")
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.select import Select
from selenium.webdriver.support.wait import WebDriverWait

BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(not (BROWSER and DRIVER), reason="no chromium and chromedriver on the PATH"),
]
FLAGS = ("--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader")
# How many colours the picture has: an empty stage has one.
COLOURS = """
draw();
const gl = renderer.getContext(), size = 4 * gl.drawingBufferWidth * gl.drawingBufferHeight;
const data = new Uint8Array(size), seen = new Set();
gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, data);
for (let at = 0; at < size; at += 4) seen.add(data.slice(at, at + 4).join());
return seen.size;
"""


@pytest.fixture
def chromium(tmp_path: Path) -> Iterator[webdriver.Chrome]:
    options = webdriver.ChromeOptions()
    options.binary_location = str(BROWSER)
    for flag in (*FLAGS, "--enable-unsafe-swiftshader", "--window-size=1200,800"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    made = webdriver.Chrome(options, webdriver.ChromeService(str(DRIVER)))
    yield made
    made.quit()


def test_the_page_draws_and_tells(chromium: webdriver.Chrome, tmp_path: Path) -> None:
    out = tmp_path / "view.html"
    words = [str(ROBOTS / "rover.urdf"), "robot1", "robot2"]
    assert main(["view", *words, "-o", str(out), "-q"]) == 0
    chromium.get(out.as_uri())
    WebDriverWait(chromium, 30).until(
        lambda it: it.find_element(By.TAG_NAME, "body").get_attribute("data-ready")
    )
    assert chromium.execute_script(COLOURS) > 20
    chromium.find_element(By.ID, "robot1 link base_link/robot1").click()
    about = chromium.find_element(By.ID, "about").text
    assert "base_link/robot1" in about
    assert "rover.urdf:" in about
    # No two names of a view cover each other, and none is beyond its edge.
    chromium.find_element(By.ID, "labels").click()
    areas = """
const size = [stage.clientWidth, stage.clientHeight], chosen = data.robots[0].built.slice(0, 1);
show("robot1");
return [chosen[0].labels.length, ...size, spread(chosen, ...size)]"""
    count, width, height, taken = chromium.execute_script(areas)
    assert 1 < len(taken) <= count
    for number, (x, y, end, bottom) in enumerate(taken):
        assert (min(x, y) >= 0, end <= width, bottom <= height) == (True, True, True)
        for other in taken[:number]:
            assert other[2] < x or end < other[0] or other[3] < y or bottom < other[1]
    Select(chromium.find_element(By.ID, "right")).select_by_visible_text(
        "robot1 before the rewrite"
    )
    assert chromium.execute_script(COLOURS) > 20
    # The picture is for keys, too, and says which.
    canvas = chromium.find_element(By.CSS_SELECTOR, "#stage canvas")
    assert "arrow keys" in str(canvas.accessible_name)
    place = "return [...camera.position.toArray(), camera.position.distanceTo(controls.target)]"
    seen = [chromium.execute_script(place)]
    for key in (Keys.ARROW_LEFT, Keys.ARROW_UP, "+"):
        canvas.send_keys(key)
        seen.append(chromium.execute_script(place))
    *turned, near = (it[3] for it in seen)
    assert turned == pytest.approx([near / 0.9] * 3)
    assert len({tuple(it[:3]) for it in seen}) == 4
    canvas.send_keys("0")
    assert chromium.execute_script(place) == pytest.approx(seen[0])
    # A robot and what it was before stand at one place, so two views can be compared.
    built = "return data.robots[1].built.map((it) => it.root.position.y)"
    assert chromium.execute_script(built) == [1.5, 1.5]
    chromium.find_element(By.ID, "robot2 plugin 0").click()
    about = chromium.find_element(By.ID, "about").text
    assert "libgazebo_ros_diff_drive.so" in about and "left_wheel_joint_robot2" in about
    assert "lidar_link/robot2" not in about
    chromium.find_element(By.ID, "robot1 link base_link/robot1").click()
    chromium.find_element(By.XPATH, "//summary[text()='robot1']").click()
    before = chromium.execute_script(
        "return data.robots[0].built[0].moving['left_wheel_joint_robot1'].turn.quaternion.y"
    )
    chromium.execute_script(
        "const it = document.querySelector('#about input'); it.value = 1;"
        "it.dispatchEvent(new Event('input'))"
    )
    after = chromium.execute_script(
        "return data.robots[0].built[0].moving['left_wheel_joint_robot1'].turn.quaternion.y"
    )
    assert before != after
    assert [it for it in chromium.get_log("browser") if it["level"] == "SEVERE"] == []


def test_what_tf_has_is_over_the_robots(chromium: webdriver.Chrome, tmp_path: Path) -> None:
    graph, out = tmp_path / "graph.json", tmp_path / "view.html"
    graph.write_bytes(to_json(with_places(healthy("postfix"))))
    words = [str(ROBOTS / "rover.urdf"), "robot1", "robot2", "--from", str(graph)]
    assert main(["view", *words, "-o", str(out), "-q"]) == 0
    chromium.get(out.as_uri())
    WebDriverWait(chromium, 30).until(
        lambda it: it.find_element(By.TAG_NAME, "body").get_attribute("data-ready")
    )

    def apart(link: str) -> str:
        robot = link.rpartition("/")[2]
        place = chromium.find_element(By.ID, f"{robot} apart {link}")
        return str(place.get_attribute("textContent"))

    assert apart("camera_optical_frame/robot1") == apart("lidar_link/robot1") == "tf: the same"
    assert apart("lidar_link/robot2") == "tf: 0.030 m, 0.0° off, and fixed"
    assert apart("left_wheel/robot2") == "tf: 0.000 m, 40.1° off"
    chromium.find_element(By.XPATH, "//summary[text()='robot2']").click()
    chromium.find_element(By.ID, "as-heard").click()
    assert apart("left_wheel/robot2") == "tf: the same"
    # robot2 is planned at y 1.5; its base was heard 1 m ahead of odom.
    at = "const at = new THREE.Vector3(), it = ghosts.find((it) => it.name === arguments[0]);"
    at += "it.group.updateWorldMatrix(true, false); at.setFromMatrixPosition(it.group.matrixWorld);"
    at += "return at.toArray()"
    found = chromium.execute_script(at, "lidar_link/robot2")
    assert found == pytest.approx([1.1, 1.5, 0.14], abs=1e-6)
    seen = "draw(); return ghosts.filter((it) => it.parts[0].visible).length"
    assert chromium.execute_script(seen) == 18
    Select(chromium.find_element(By.ID, "left")).select_by_visible_text("robot1")
    assert chromium.execute_script(seen) == 9
    chromium.find_element(By.ID, "tf").click()
    assert chromium.execute_script(seen) == 0
    assert [it for it in chromium.get_log("browser") if it["level"] == "SEVERE"] == []


def test_a_page_is_fitted_to_its_size_until_it_is_turned(
    chromium: webdriver.Chrome, tmp_path: Path
) -> None:
    """As in a report, which may give its frame a size after the frame's page has run."""
    assert main(["view", str(ROBOTS / "rover.urdf"), "-o", str(tmp_path / "view.html"), "-q"]) == 0
    outer = tmp_path / "outer.html"
    outer.write_text('<iframe src="view.html" style="display: none"></iframe>')
    chromium.get(outer.as_uri())
    place = """
const drawn = renderer.domElement.clientWidth === stage.clientWidth;
return innerWidth === arguments[0] && drawn && camera.position.distanceTo(controls.target)"""
    seen = []
    for width, key in (900, ""), (200, Keys.ARROW_LEFT), (900, ""):
        chromium.switch_to.default_content()
        style = f"document.querySelector('iframe').style = 'width: {width}px; height: 500px'"
        chromium.execute_script(style)
        chromium.switch_to.frame(chromium.find_element(By.TAG_NAME, "iframe"))
        now = partial(chromium.execute_script, place, width)
        seen.append(WebDriverWait(chromium, 30).until(lambda _, now=now: now()))
        assert chromium.execute_script(COLOURS) > 20
        chromium.find_element(By.CSS_SELECTOR, "#stage canvas").send_keys(key)
    assert seen[1:] == pytest.approx([seen[1]] * 2) and seen[0] != pytest.approx(seen[1])


def test_the_robots_head_a_report(chromium: webdriver.Chrome, tmp_path: Path) -> None:
    """The frame inherits the policy of the report: what it forbids is in the log."""
    fleet, graph, out = (str(tmp_path / it) for it in ("fleet.yaml", "graph.json", "report.html"))
    robots = "robots: [{name: robot1, pose: {x: 0}}, {name: robot2, pose: {x: 2}}]"
    Path(fleet).write_text(f"description: {ROBOTS / 'rover.urdf'}\n{robots}\n")
    Path(graph).write_bytes(to_json(healthy("postfix")))
    main(["check", fleet, "--from", graph, "--report", out, "-q"])
    chromium.get(Path(out).as_uri())
    chromium.switch_to.frame(chromium.find_element(By.TAG_NAME, "iframe"))
    WebDriverWait(chromium, 30).until(
        lambda it: it.find_element(By.TAG_NAME, "body").get_attribute("data-ready")
    )
    # The frame may be drawn a moment after it is ready.
    WebDriverWait(chromium, 30).until(lambda it: it.execute_script(COLOURS) > 20)
    assert [it for it in chromium.get_log("browser") if it["level"] == "SEVERE"] == []
