# SPDX-License-Identifier: Apache-2.0
"""The documentation: every link leads somewhere, on GitHub and on the site; the site is whole."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from functools import cache, partial
from html.parser import HTMLParser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from paths import ROOT

import multibot_rewrite

SITE = ROOT / "docs" / "site"
FENCED = re.compile(r"^( *)(`{3,}).*?^\1\2`*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#{1,6} (.+?)#*$", re.MULTILINE)
STARTS = re.compile(r"^(https?|mailto):")


def listed() -> list[Path]:
    """Return the pages that a clone has."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    names = done.stdout.split() or ["README.md"]
    return [ROOT / it for it in names if (ROOT / it).exists() and not it.startswith("fixtures/")]


PAGES = listed()
MOST_PAGES, MOST_LINES = 40, 6100
# Words of the pages for users, and of those for contributors.
MOST_WORDS, MOST_WORDS_OF_CONTRIBUTORS = 35_000, 23_000
# Written by programs of the repository.
MADE = ("measurements.md", "robots.md", "vendors.md", "strangers.md", "launch-idioms.md")


@cache
def anchors(page: Path) -> frozenset[str]:
    """Return the anchors that GitHub makes of headings: lower case, no punctuation, a dash for a
    space.

    The algorithm is that of github-slugger; a second heading of the same words ends with -1.
    """
    made: list[str] = []
    for heading in HEADING.findall(FENCED.sub("", page.read_text())):
        words = re.sub(r"\]\([^)]*\)", "", heading).strip().lower()
        slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        made.append(f"{slug}-{made.count(slug)}" if slug in made else slug)
    return frozenset(made)


def links(page: Path) -> list[str]:
    text = CODE.sub("", FENCED.sub("", page.read_text()))
    return [it for it in LINK.findall(text) if not STARTS.match(it)]


def leads(page: Path, link: str) -> bool:
    path, _, anchor = unquote(link).partition("#")
    target = (page.parent / path).resolve() if path else page
    inside = target.is_relative_to(ROOT) and target.exists()
    return inside and (not anchor or target.suffix != ".md" or anchor in anchors(target))


@pytest.mark.parametrize("page", PAGES, ids=lambda it: str(it.relative_to(ROOT)))
def test_links_lead_somewhere_on_github(page: Path) -> None:
    assert [it for it in links(page) if not leads(page, it)] == []


def test_pages_are_few_and_have_links() -> None:
    docs = [it for it in PAGES if it.is_relative_to(ROOT / "docs")]
    assert 20 < len(docs) <= MOST_PAGES
    hand_written = [it for it in docs if it.name not in MADE]
    assert sum(len(it.read_text().splitlines()) for it in hand_written) < MOST_LINES
    assert sum(len(links(it)) for it in PAGES) > 200


def test_pages_have_few_words() -> None:
    def words(*folders: Path) -> int:
        pages = (page for it in folders for page in it.glob("*.md"))
        return sum(len(it.read_text().split()) for it in pages)

    docs = ROOT / "docs"
    assert words(docs, docs / "tutorials") <= MOST_WORDS
    assert words(docs / "contributing") <= MOST_WORDS_OF_CONTRIBUTORS


@pytest.mark.parametrize("link", ["nowhere.md", "plan.md#nowhere", "../../outside", "#nowhere"])
def test_a_link_to_nowhere_is_seen(link: str) -> None:
    assert leads(ROOT / "docs" / "index.md", "plan.md#states")
    assert not leads(ROOT / "docs" / "index.md", link)


@pytest.mark.slow
def test_pictures_are_what_a_build_writes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(SITE))
    from layout_pictures import FOLDER, pictures

    made = pictures()
    assert {it.name for it in FOLDER.glob("layout-*.svg")} == made.keys()
    stale = [name for name, text in made.items() if (FOLDER / name).read_text() != text]
    assert stale == [], "run python docs/site/layout_pictures.py"
    # What collides is red: everything before a rewrite, nothing after one.
    assert [name for name, text in made.items() if "#c4261d" in text] == ["layout-before.svg"]


def test_badges_say_what_the_package_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are files of the repository: nothing is asked of a server, and none is left out."""
    monkeypatch.syspath_prepend(str(SITE))
    from badges import FOLDER, badges

    made = badges()
    assert {it.name for it in FOLDER.glob("badge-*.svg")} == made.keys()
    stale = [name for name, text in made.items() if (FOLDER / name).read_text() != text]
    assert stale == [], "run python docs/site/badges.py"
    top = (ROOT / "README.md").read_text().partition("\n## ")[0]
    assert re.findall(r"\[!\[[^]]*\]\(docs/pictures/(badge-[^)]+)\)", top) == [*made]
    assert "<title>Python: 3.10 to 3.14</title>" in made["badge-python.svg"]
    assert "<title>ROS 2: humble, jazzy, kilted, lyrical, rolling</title>" in made["badge-ros.svg"]
    assert "shields.io" not in (ROOT / "README.md").read_text()


class Html(HTMLParser):
    """Where a page leads to, what it loads, and its anchors."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.leads: list[str] = []
        self.loads: list[str] = []
        self.ids: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {key: value or "" for key, value in attrs}
        self.ids.add(given.get("id", ""))
        if tag == "a" and "href" in given:
            self.leads.append(given["href"])
        if tag in ("script", "img", "iframe") and "src" in given:
            self.loads.append(given["src"])
        if tag == "link" and given.get("rel") in ("stylesheet", "icon", "preconnect"):
            self.loads.append(given["href"])


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the site as for readers; a warning is an error, but for one that ``-q`` would hide."""
    pytest.importorskip("mkdocstrings", reason="no mkdocs: pip install '.[docs]'")
    folder = tmp_path_factory.mktemp("site")
    words = ["build", "--strict", "-f", str(SITE / "mkdocs.yml"), "-d", str(folder)]
    command = [sys.executable, "-m", "mkdocs", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def read(site: Path) -> dict[Path, Html]:
    return {it: Html(it.read_text()) for it in site.rglob("*.html") if it.name != "404.html"}


def lost(read: dict[Path, Html], site: Path) -> Iterator[str]:
    for page, html in read.items():
        for link in (*html.leads, *html.loads):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            file = target / "index.html" if target.is_dir() else target
            anchor = unquote(parts.fragment)
            if not file.exists() or (anchor and file in read and anchor not in read[file].ids):
                yield f"{page.relative_to(site)}: {link}"


@pytest.mark.deep
def test_links_lead_somewhere_on_the_site(read: dict[Path, Html], site: Path) -> None:
    assert len(read) > 60
    assert list(lost(read, site)) == []


@pytest.mark.deep
def test_the_site_fetches_nothing_from_elsewhere(read: dict[Path, Html]) -> None:
    assert [it for html in read.values() for it in html.loads if STARTS.match(it)] == []
    # The theme's component that asks GitHub for the stars of ``repo_url``.
    assert not any('data-md-component="source"' in page.read_text() for page in read)


@pytest.mark.deep
def test_files_of_the_repository_are_at_its_host(read: dict[Path, Html], site: Path) -> None:
    found = [it for html in read.values() for it in html.leads if "/blob/" in it or "/tree/" in it]
    ours = [it.partition("/HEAD/")[2] for it in found if "/multibot_rewrite/" in it]
    assert "examples/launch_tutorial" in ours
    assert [it for it in ours if not (ROOT / it.partition("#")[0]).exists()] == []


@pytest.mark.deep
def test_every_public_call_is_explained(read: dict[Path, Html], site: Path) -> None:
    ids = read[site / "api" / "index.html"].ids
    assert {f"multibot_rewrite.{it}" for it in multibot_rewrite.__all__} <= ids
    assert "multibot_rewrite.Rewrite.not_verified" in ids
    assert "Raises InputError" in (site / "api" / "index.html").read_text()


class Quiet(SimpleHTTPRequestHandler):
    """Serves a folder and writes no log."""

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def address(site: Path) -> Iterator[str]:
    """Yield the site as a reader opens it: its search asks a server."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(site)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


@pytest.mark.deep
@pytest.mark.live
def test_the_site_in_a_browser(address: str, tmp_path: Path) -> None:
    """Pictures are shown, the switch makes it dark, and the search finds a page."""
    pytest.importorskip("selenium", reason="no selenium: pip install '.[test]'")
    from selenium import webdriver
    from selenium.webdriver.support.wait import WebDriverWait

    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not (chromium and driver):
        pytest.skip("no browser: apt install chromium chromium-driver")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    flags = ("--headless", "--no-sandbox", "--disable-gpu", "--window-size=1400,900")
    for flag in (*flags, f"--user-data-dir={tmp_path}"):
        options.add_argument(flag)
    browser = webdriver.Chrome(options, webdriver.ChromeService(driver))
    wait, ask = WebDriverWait(browser, 60), browser.execute_script
    try:
        browser.get(f"{address}/tutorials/layouts/index.html")
        wide = "return [...document.querySelectorAll('article img')].map(it => it.naturalWidth)"
        wait.until(lambda _: len(ask(wide)) >= 5 and all(ask(wide)))
        colour = "return getComputedStyle(document.body).backgroundColor"
        light = ask(colour)
        assert ask("return document.body.dataset.mdColorScheme") == "default"
        ask("document.querySelector('label[for=__palette_1]').click()")
        wait.until(lambda _: ask("return document.body.dataset.mdColorScheme") == "slate")
        assert ask(colour) != light
        ask("document.querySelector('input[name=query]').focus()")
        browser.switch_to.active_element.send_keys("frame_prefix")
        hits = "return [...document.querySelectorAll('.md-search-result__link')].map(it => it.href)"
        wait.until(lambda _: ask(hits))
        assert any("/coming-from/" in it or "/recipes/" in it for it in ask(hits))
    finally:
        browser.quit()
