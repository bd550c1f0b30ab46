# SPDX-License-Identifier: Apache-2.0
"""What describes the package to others: each file is what its reader takes, and all of them agree."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from typing import Any

import pytest
import yaml
from paths import ROOT

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
URLS: dict[str, str] = PROJECT["urls"]
MANIFEST = ET.parse(ROOT / "package.xml").getroot()
FORMS = sorted(path.name for path in (ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))


def assert_by_schema(name: str, file: str) -> None:
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{name}", file]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_the_citation_is_by_its_schema() -> None:
    assert_by_schema("citation-file-format", "CITATION.cff")


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
def test_an_issue_form_is_by_its_schema(form: str) -> None:
    kind = "config" if form == "config.yml" else "forms"
    assert_by_schema(f"github-issue-{kind}", f".github/ISSUE_TEMPLATE/{form}")


def test_the_citation_says_what_the_package_says() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    for key, theirs in (("title", "name"), ("version", "version"), ("license", "license")):
        assert citation[key] == PROJECT[theirs]
    assert [it["name"] for it in citation["authors"]] == [it["name"] for it in PROJECT["authors"]]


CHANGES = (ROOT / "CHANGELOG.rst").read_text()


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_the_change_log_is_what_bloom_takes() -> None:
    """The newest version is that of the package, and each of its entries is read."""
    changelog = pytest.importorskip("catkin_pkg.changelog", reason="no catkin_pkg")
    found = changelog.populate_changelog_from_rst(changelog.Changelog(PROJECT["name"]), CHANGES)
    version, _, _ = next(iter(found.foreach_version(reverse=True)))
    assert version == PROJECT["version"]
    lists = [it for it in found.get_content_of_version(version) if hasattr(it, "bullets")]
    (_, text, *_) = re.split(r"\n\S+ \([\d-]+\)\n-+\n", CHANGES)
    assert sum(len(it.bullets) for it in lists) == text.count("\n* ") > 0
    assert f"Changelog for package {PROJECT['name']}\n" in CHANGES


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_bloom_finds_what_is_not_released() -> None:
    """A release gives the section Forthcoming a version and a date."""
    version = pytest.importorskip("catkin_pkg.package_version", reason="no catkin_pkg")
    newest = f"\n{PROJECT['version']} ("
    text = CHANGES.replace(newest, f"\nForthcoming\n-----------\n* New\n{newest}", 1)
    assert version.get_forthcoming_label(text if "\nForthcoming\n" not in CHANGES else CHANGES)


def test_the_newest_changes_are_one_line_each_in_groups() -> None:
    _, text, *_ = re.split(r"\n\S+(?: \([\d-]+\))?\n-+\n", CHANGES)
    lines = [it for it in text.splitlines() if it]
    groups = [it.strip("*") for it in lines if it.startswith("**")]
    assert groups == [it for it in ("Added", "Changed", "Fixed") if it in groups] != []
    assert [it for it in lines if not it.startswith(("* ", "**"))] == []
    assert [it for it in lines if len(it) > 150] == []
    assert len(lines) <= 120


@pytest.mark.more
def test_the_manifest_is_what_ros_takes() -> None:
    package = pytest.importorskip("catkin_pkg.package", reason="no catkin_pkg")
    warnings: list[str] = []
    found = package.parse_package(str(ROOT), warnings=warnings)
    assert warnings == []
    assert [it.name for it in found.authors] == [it["name"] for it in PROJECT["authors"]]
    assert found.get_build_type() == "ament_python"


def test_the_links_of_the_project_are_of_one_repository() -> None:
    """The one that the site and the examples of CI name."""
    site = (ROOT / "docs" / "site" / "mkdocs.yml").read_text()
    (home,) = re.findall(r'SITE_REPOSITORY, "([^"]+)"', site)
    assert {it.partition("/issues")[0].partition("/blob/")[0] for it in URLS.values()} == {home}
    for page in ("Changelog", "Documentation"):
        assert (ROOT / URLS[page].partition("/blob/main/")[2]).is_file()
    urls = {it.get("type"): it.text for it in MANIFEST.iter("url")}
    assert urls == {"repository": URLS["Repository"], "bugtracker": URLS["Issues"]}
    assert URLS["Repository"] == home


def test_what_is_always_needed_has_no_condition() -> None:
    needed = {it.text for it in MANIFEST.iter("exec_depend") if not it.get("condition")}
    optional = {it.text for it in MANIFEST.iter("exec_depend") if it.get("condition")}
    assert needed == {"python3-lxml", "python3-yaml", "python3-rich", "python3-jsonschema", "xacro"}
    assert {"rclpy", "launch", "launch_ros", "ros2cli", "tf2_msgs"} <= optional


def test_no_address_is_made_up() -> None:
    """Domains for examples are not ours (RFC 2606), nor is any but that of the repository's owner."""
    (maintainer,) = MANIFEST.iter("maintainer")
    owner = URLS["Repository"].split("/")[3]
    assert maintainer.get("email") == f"{owner}@users.noreply.github.com"
    assert "OWNER" not in "".join(URLS.values())
    assert all("email" not in author for author in PROJECT["authors"])


def test_the_guide_names_the_loop_and_every_marker() -> None:
    guide = (ROOT / "CONTRIBUTING.md").read_text()
    tool = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["pytest"]["ini_options"]
    assert 'python -m pytest -m "not live and not slow"' in guide
    assert [it for it in tool["markers"] if f"`{it.partition(':')[0]}`" not in guide] == []
    assert "--strict-markers" in tool["addopts"]
