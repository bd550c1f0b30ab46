# SPDX-License-Identifier: Apache-2.0
"""Fleet files: what they mean, what is wrong with them in one line, the schema that is published."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import jsonschema
import pytest
import yaml
from fleet_folder import fleet_folder
from paths import ROOT

from multibot_rewrite.base import editors
from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file.checked_yaml import TYPES, _in_words
from multibot_rewrite.fleet.file.fleet_data import SCHEMA, check_files, schema, with_paths
from multibot_rewrite.fleet.file.fleet_file import KINDS, FleetFile, read_fleet
from multibot_rewrite.fleet.file.robot_spec import Pose, RobotSpec
from multibot_rewrite.planning.plan import is_fleet
from tools.pages import fleet_keys

ONE = "robots:\n  - {name: a, description: rover.urdf}\n"
PAGE = (ROOT / "docs" / "fleet-file.md").read_text()
KEYS = fleet_keys.page()


def with_keys(keys: str) -> str:
    return f"robots:\n  - {{name: a, description: rover.urdf{keys and ', '}{keys}}}\n"


def read(folder: Path, text: str, **files: str) -> FleetFile:
    return read_fleet(str(fleet_folder(folder, text, **files)), "", {})


def robot(folder: Path, keys: str, above: str = "") -> RobotSpec:
    return read(folder, above + with_keys(keys)).robots[0]


# ---------------------------------------------------------------- what it means


def test_keys_of_0_2_0(tmp_path: Path) -> None:
    """Three keys have new names; fleet files that were written before are read as they were."""
    old = "companions: {params: nosuch.yaml}"
    with pytest.raises(InputError, match=r"fleet\.yaml:2: .*nosuch\.yaml does not exist"):
        robot(tmp_path, old)
    made = read(tmp_path, f"companions: {{}}\nvocabulary: []\nstack: nav2\n{ONE}")
    assert [it.node_sets for it in made.robots] == [("nav2",)]


@pytest.mark.parametrize(
    ("keys", "above", "field", "value"),
    [
        pytest.param("namespace: b", "", "namespace", "b", id="namespace"),
        pytest.param("namespace: /b", "", "namespace", "b", id="slash"),
        pytest.param("postfix: b", "", "tag", "b", id="postfix"),
        pytest.param("prefix: b", "affix: prefix\n", "tag", "b", id="prefix"),
        pytest.param("model: b.1", "", "model", "b.1", id="model"),
        pytest.param("pose: {x: 1, yaw: 2.5}", "", "pose", Pose(x=1.0, yaw=2.5), id="pose"),
        pytest.param("pose: {}", "", "pose", Pose(), id="origin"),
        pytest.param("colour: red", "", "colour", "red", id="colour"),
        pytest.param("colour: '#00ff7f'", "", "colour", "#00ff7f", id="hex"),
        pytest.param("colour: [1, 2, 3]", "", "colour", (1, 2, 3), id="rgb"),
        pytest.param("node_sets: nav2", "", "node_sets", ("nav2",), id="node_sets"),
        pytest.param(
            "", "node_sets: [nav2, moveit]\n", "node_sets", ("nav2", "moveit"), id="node_sets"
        ),
        pytest.param(
            "node_sets: moveit", "node_sets: nav2\n", "node_sets", ("moveit",), id="own-node-set"
        ),
        pytest.param("node_sets: []", "node_sets: nav2\n", "node_sets", (), id="no-node-set"),
    ],
)
def test_keys_of_a_robot(tmp_path: Path, keys: str, above: str, field: str, value: object) -> None:
    assert getattr(robot(tmp_path, keys, above), field) == value


def test_a_fault_in_an_included_file_has_its_name_and_line(tmp_path: Path) -> None:
    (tmp_path / "more.yaml").write_text(
        f"# robots\n{ONE}  - {{name: a, description: rover.urdf}}\n"
    )
    with pytest.raises(InputError, match=r"more\.yaml:4: robot 'a' is repeated, first in line 3"):
        read(tmp_path, "include: more.yaml\n")


# Keys of a fleet and of a robot that hold one path or several.
OF_FILES = (
    "include", "description", "simulated", "srdf", "rviz", "nodes", "definitions", "simulator_world",
    "controllers", "moveit",
)  # fmt: skip


def test_paths_are_below_the_folder_of_their_file() -> None:
    def data(to: str, up: str) -> dict[str, Any]:
        own: dict[str, Any] = {**dict.fromkeys(OF_FILES, f"{to}a"), "srdf": up, "model": "a"}
        return {
            **own,
            "definitions": [f"{to}a", f"{to}b"],
            "nodl": [f"{to}n"],
            "launch_roots": f"{to}r",
            "launch": [f"{to}a.launch.py x:=1 y:=2", "pkg b.launch.py", f"{to}c.launch.py"],
            "related_files": {"params": [f"{to}p", {"amcl": {"file": "a"}}], "rviz": f"{to}v"},
            "robots": [{"name": "a", **own}],
            "join": [own],
        }

    assert with_paths("f/g", data("", "../a")) == data("f/g/", "f/a")
    small = {"nodl": "none", "launch": "a.launch.py"}
    assert with_paths("f", small) == {"nodl": "none", "launch": ["f/a.launch.py"]}


@pytest.mark.parametrize(
    ("data", "place"),
    [
        *(({key: "no.x"}, (key,)) for key in OF_FILES),
        ({"definitions": [__file__, "no.x"]}, ("definitions",)),
        ({"launch": "no.x a:=1"}, ("launch",)),
        ({"launch": ["pkg a.launch.py", "no.x"]}, ("launch",)),
        (
            {"related_files": {"rviz": __file__, "params": [{"a": {}}, "no.x"]}},
            ("related_files", "params"),
        ),
        ({"robots": [{"name": "a"}, {"srdf": "no.x"}]}, ("robots", 1, "srdf")),
        ({"join": [{"description": "no.x"}]}, ("join", 0, "description")),
    ],
)  # fmt: skip
def test_a_file_that_is_not_there_is_told_with_its_line(
    data: dict[str, Any], place: tuple[str | int, ...], here: Path
) -> None:
    for what in ("does not exist", "is a folder, not a file"):
        with pytest.raises(InputError) as found:
            check_files(data, (), {place: ("f.yaml", 7)})
        assert str(found.value) == f"f.yaml:7: no.x {what}; correct the path"
        (here / "no.x").mkdir(exist_ok=True)


@pytest.mark.parametrize(
    ("text", "fleet"),
    [
        ("robots:\n  - name: a\n", True),
        ("robots: [{name: a}]\n", True),
        ("layout: L1\nrobots:  # all\n# two\n\n- name: a\n", True),
        ("robots:\n  a:\n    tf: /tf\n", False),
        ("amcl:\n", False),
        ("include: common.yaml\nlayout: L1\n", True),
    ],
)
def test_a_fleet_file_is_distinguished_from_a_plan(text: str, fleet: bool) -> None:
    assert is_fleet(text.encode()) is fleet


# ---------------------------------------------------------------- bad input

BAD: dict[str, tuple[str, ...]] = {
    "unknown-key": (f"layot: L2\n{ONE}", "1: unknown key 'layot'; did you mean 'layout'?"),
    "unknown-robot-key": (
        "robots:\n  - name: a\n    descripton: x\n",
        "3: robots[0]: unknown key 'descripton'; did you mean 'description'?",
    ),
    "unknown-related-file": (
        f"{ONE}related_files: {{parms: params.yaml}}\n",
        "3: related_files: unknown key 'parms'; did you mean 'params'?",
    ),
    "unknown-pose-key": (
        with_keys("pose: {yow: 1}"),
        "2: robots[0].pose: unknown key 'yow'; did you mean 'yaw'?",
    ),
    "related-file-at-the-top": (
        f"params: nav2.yaml\n{ONE}",
        "1: unknown key 'params'; write related_files: {params: ...}",
    ),
    "related-file-in-other-words": (
        f"rviz_config: a.rviz\n{ONE}",
        "1: unknown key 'rviz_config'; write related_files: {rviz: ...}",
    ),
    "key-that-begins-several": (
        f"shared: [/scan]\n{ONE}",
        "1: unknown key 'shared'; did you mean one of shared_frames, shared_topics, shared_nodes?",
    ),
    "key-that-is-a-number": (f"1: 2\n{ONE}", "1: unknown key 1; known are include, layout"),
    "key-that-is-a-list": (
        f"[1]: 2\n{ONE}",
        "1:1: not valid YAML: found unhashable key; write plain keys",
    ),
    "two-of-a-name": (
        f"{ONE}  - {{name: a, description: rover.urdf}}\n",
        "3: robot 'a' is repeated",
    ),
    "two-of-a-namespace": (
        f"{ONE}  - {{name: b, namespace: a, description: rover.urdf}}\n",
        "3: 'b' has the namespace 'a' of 'a' (line 2); every robot needs its own",
    ),
    "two-of-a-postfix": (
        f"{ONE}  - {{name: b, postfix: a, description: rover.urdf}}\n",
        "3: 'b' has the prefix or postfix 'a' of 'a' (line 2)",
    ),
    "two-of-a-model": (
        f"{ONE}  - {{name: b, model: a, description: rover.urdf}}\n",
        "3: 'b' has the model 'a' of 'a' (line 2)",
    ),
    "two-of-a-pose": (
        "description: rover.urdf\nrobots:\n  - {name: a, pose: {x: 1}}\n"
        "  - {name: b, pose: {x: 1.0, y: 0}}\n",
        "4: 'b' has the pose of 'a' (line 3)",
    ),
    "missing-description": (
        "robots:\n  - {name: a, description: nope.urdf}\n",
        "2: FOLDER/nope.urdf does not exist; correct the path",
    ),
    "missing-related-file": (
        f"{ONE}related_files:\n  rviz: nope.rviz\n",
        "4: FOLDER/nope.rviz does not exist; correct the path",
    ),
    "related-file-folder": (f"{ONE}related_files: {{params: .}}\n", "3: FOLDER/. is a folder"),
    "missing-include": (f"include: nope.yaml\n{ONE}", "1: FOLDER/nope.yaml does not exist"),
    "missing-nodes": (f"nodes: nope.yaml\n{ONE}", "1: FOLDER/nope.yaml does not exist"),
    "missing-definitions": (f"definitions: [a.vocab]\n{ONE}", "1: FOLDER/a.vocab does not exist"),
    "cyclic-include": (
        f"include: fleet.yaml\n{ONE}",
        " the file includes itself (fleet.yaml -> fleet.yaml); remove one include",
    ),
    "duplicate-key": (
        f"layout: L1\nlayout: L2\n{ONE}",
        "2: the key 'layout' is repeated, first in line 1; remove one of them",
    ),
    "duplicate-key-on-a-line": (
        "robots:\n  - {name: a, name: b, description: rover.urdf}\n",
        "2: the key 'name' is repeated",
    ),
    "tab": ("robots:\n\t- {name: a}\n", "2:1: not valid YAML: a tab; indent with spaces"),
    "anchor": (
        "robots:\n  - &x {name: a, description: rover.urdf}\n  - *x\n",
        "2: anchors and aliases are not allowed: &x; write the value out",
    ),
    "ring-of-aliases": ("robots: &a [*a]\n", "1:13: not valid YAML: the alias is inside"),
    "merge": (
        "x: &d {a: 1}\nrobots:\n  - {<<: *d, name: a}\n",
        "1: anchors and aliases are not allowed: &d; write",
    ),
    "python-tag": (
        "robots: !!python/object:os.system []\n",
        "1:9: not valid YAML: could not determine a constructor for the tag",
    ),
    "empty": ("", " the file is empty; write robots: [{name: robot1}, {name: robot2}]"),
    "only-comments": ("# later\n", " the file is empty; write robots:"),
    "a-list": ("- a\n", "1: the file must hold keys with values; write robots:"),
    "a-word": ("hello\n", "1: the file must hold keys with values"),
    "no-robots": ("layout: L1\n", " there are no robots; write robots:"),
    "empty-robots": ("robots: []\n", "1: robots: the list is empty; write at least one"),
    "robots-as-keys": ("robots: {a: 1}\n", "1: robots: {'a': 1} is not valid; write a list"),
    "robot-as-word": ("robots: [a]\n", "1: robots[0]: 'a' is not valid; write {name: a}"),
    "no-name": ("robots:\n  - {description: rover.urdf}\n", "2: robots[0]: the key 'name' is miss"),
    "name-number": ("robots:\n  - {name: 1}\n", "2: robots[0].name: 1 is not valid; write it in q"),
    "name-on": ("robots:\n  - {name: on}\n", "2: robots[0].name: True is not valid; write it in q"),
    "name-dash": (
        "robots:\n  - {name: my-robot}\n",
        "2: robots[0].name: 'my-robot' is not valid; write letters, digits and underscores",
    ),
    "namespace-doubled-slash": (
        "robots:\n  - {name: a, namespace: b//c}\n",
        "2: robots[0].namespace: 'b//c' is not valid; write words of letters",
    ),
    "namespace-digit": (
        "robots:\n  - {name: a, namespace: b/1}\n",
        "2: robots[0].namespace: 'b/1' is not valid; write words of letters",
    ),
    "model-slash": ("robots:\n  - {name: a, model: a//b}\n", "2: robots[0].model: 'a//b' is not"),
    "model-date": (
        "robots:\n  - {name: a, model: 2020-01-01}\n",
        "2: robots[0].model: datetime.date(2020, 1, 1) is not valid; write it in quotes",
    ),
    "layout": (f"layout: frames\n{ONE}", "1: layout: 'frames' is not known; did you mean 'frames-"),
    "layout-none": (f"layout:\n{ONE}", "1: layout: the value is missing; write one, or remove the"),
    "affix": (f"affix: suffix\n{ONE}", "1: affix: 'suffix' is not known; did you mean 'postfix'?"),
    "distro": (f"distro: iron\n{ONE}", "1: distro: 'iron' is not known; known are humble, jazzy"),
    "node_sets": (
        f"node_sets: nav3\n{ONE}",
        "1: node set 'nav3' is not known; did you mean 'nav2'?",
    ),
    "robots-node-set": (with_keys("node_sets: nav3"), "2: node set 'nav3' is not known"),
    "separator": (f"separators: {{link: '%'}}\n{ONE}", "1: separator link='%': use one of / _ __"),
    "separator-kind": (f"separators: {{lnk: /}}\n{ONE}", "1: separator kind 'lnk' is not known"),
    "world": (
        f"world: odom\n{ONE}",
        "1: world 'odom' is not a shared frame (earth, map, utm, world); add it to shared_frames",
    ),
    "pose-word": (
        with_keys("pose: {x: one}"),
        "2: robots[0].pose.x: 'one' is not valid; write a number",
    ),
    "pose-nan": (with_keys("pose: {x: .nan}"), "2: 'a': pose x is nan; write a number"),
    "colour": (
        with_keys("colour: gren"),
        "2: 'a': colour 'gren' is not known; did you mean 'green'?",
    ),
    "colour-two": (with_keys("colour: [1, 2]"), "2: robots[0].colour: [1, 2] is not valid; write"),
    "other-affix": (
        "affix: prefix\nrobots:\n  - {name: a, description: rover.urdf, postfix: b}\n",
        "3: 'a' has a postfix, but the fleet's affix is prefix; write prefix: instead, or affix:",
    ),
    "old-and-new-key": (
        f"companions: {{}}\n{ONE}related_files: {{}}\n",
        "4: the key 'related_files' is repeated, first in line 1; remove one of them",
    ),
    "no-description": ("robots:\n  - {name: a}\n", "2: robot 'a' has no description; name its"),
    "arguments-without-xacro": (
        with_keys("arguments: {x: 1}"),
        "2: 'a' has arguments but no xacro file; remove them, or give a xacro",
    ),
    "arguments-list": (f"{ONE}arguments: [a]\n", "3: arguments: ['a'] is not valid; write keys"),
    "related-files-none": (f"{ONE}related_files:\n", "3: related_files: the value is missing"),
    "broken": (
        "robots: [\n",
        "2:1: not valid YAML: did not find expected node content; correct the YAML",
    ),
    "two-documents": (f"{ONE}---\n{ONE}", "3:1: not valid YAML: there is more than one document"),
    "too-deep": (f"robots: {'[' * 600}{']' * 600}\n", "1:108: not valid YAML: it is nested deeper"),
    "nul": ("robots:\n  - {name: a\0}\n", " not valid YAML: unacceptable character #x0000"),
    "params-of-rviz": (
        f"{ONE}related_files: {{params: one_robot.rviz}}\n",
        "@one_robot.rviz:1: not a ROS 2 parameter file: it is an RViz config; list it under rviz",
    ),
    "params-anchor": (
        f"{ONE}related_files: {{params: bad.yaml}}\n",
        "@bad.yaml:1: rcl takes no anchors or aliases (&x); write the value out",
        "amcl: {ros__parameters: &x {a: 1}}\n",
    ),
    "params-tab": (
        f"{ONE}related_files: {{params: bad.yaml}}\n",
        "@bad.yaml:2:1: not valid YAML: a tab; indent with spaces",
        "amcl:\n\tros__parameters: {a: 1}\n",
    ),
    "rviz-of-ros1": (
        f"{ONE}related_files: {{rviz: bad.yaml}}\n",
        "@bad.yaml:1: this is a ROS 1 config (rviz/Grid), which rviz2 cannot load; create it in rv",
        "Visualization Manager: {Displays: [{Class: rviz/Grid}]}\n",
    ),
    "srdf-of-yaml": (
        with_keys("srdf: params.yaml"),
        "@params.yaml: a parameter file; rewrite it with urdf-postfix, or name it in",
    ),
    "moveit-of-rviz": (
        f"{ONE}related_files: {{moveit: one_robot.rviz}}\n",
        "@one_robot.rviz:1: not ",
    ),
    "bridge-of-params": (
        f"{ONE}related_files: {{bridge: params.yaml}}\n",
        "@params.yaml:2: not a list of topics",
    ),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_line_and_nothing_is_written(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, said, *other = BAD[case]
    path = fleet_folder(tmp_path, text, bad__yaml="".join(other))
    code = main(["build", str(path), "-o", str(tmp_path / "out")])
    error = capsys.readouterr().err
    assert code == 2, error
    assert error.count("\n") == 1, error
    file = said[1:].partition(":")[0] if said.startswith("@") else "fleet.yaml"
    rest = said[1 + len(file) :] if said.startswith("@") else f":{said}"
    assert f"{tmp_path / file}{rest}".replace("FOLDER", str(tmp_path)) in error
    assert not (tmp_path / "out").exists()


def test_a_file_of_another_encoding_is_one_line(tmp_path: Path) -> None:
    path = fleet_folder(tmp_path, ONE)
    path.write_bytes(b"robots:\n  - {name: \xe9}\n")
    with pytest.raises(InputError, match=r"fleet\.yaml:2: it is not UTF-8; save it as UTF-8"):
        read_fleet(str(path), "", {})


# ---------------------------------------------------------------- schema and page


def keys(part: dict[str, Any]) -> set[str]:
    return set(part["properties"])


def test_the_schema_is_one_and_says_so() -> None:
    from jsonschema import Draft202012Validator

    Draft202012Validator.check_schema(schema())
    assert keys(schema()["$defs"]["related_files"]) == set(KINDS)
    used = re.findall(r'"type": "(\w+)"', json.dumps(schema()))
    assert set(used) <= set(TYPES)


def test_the_schema_for_editors_lists_the_layouts() -> None:
    """Editors read the file as it is; a command takes the layouts from the rows in naming."""
    text = ROOT.joinpath("multibot_rewrite", "fleet", SCHEMA).read_text()
    wanted = json.dumps(schema()["properties"]["layout"])
    assert json.loads(text) == schema(), f'write "layout": {wanted} into {SCHEMA}'


def test_the_jsonschema_of_ubuntu_22_04_will_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is 3.2.0, which has no Draft202012Validator."""
    old = ModuleType("jsonschema")
    old.__dict__.update(
        Draft7Validator=jsonschema.Draft7Validator, exceptions=jsonschema.exceptions
    )
    monkeypatch.setitem(sys.modules, "jsonschema", old)
    assert read(tmp_path, ONE).robots[0].name == "a"
    with pytest.raises(InputError, match=r"fleet\.yaml:1: unknown key 'robot'; did you mean"):
        read(tmp_path, "robot:\n  - {name: a}\n")


def test_the_schema_says_nothing_that_an_older_draft_reads_differently() -> None:
    """Beside $ref draft 7 ignores everything; the newer drafts have keywords of their own."""
    newer = {"prefixItems", "unevaluatedItems", "unevaluatedProperties", "dependentSchemas"}
    newer |= {"dependentRequired", "minContains", "maxContains", "$dynamicRef", "$anchor"}

    def parts(value: object) -> Iterator[dict[str, Any]]:
        if isinstance(value, dict):
            yield value
        for it in value.values() if isinstance(value, dict) else ():
            yield from parts(it)
        for it in value if isinstance(value, list) else ():
            yield from parts(it)

    for part in parts(schema()):
        assert newer.isdisjoint(part)
        assert "$ref" not in part or part.keys() <= {"$ref", "description", "$comment"}


def test_an_old_jsonschema_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "jsonschema", ModuleType("jsonschema"))
    fleet = fleet_folder(tmp_path, f"{ONE}layuot: both\n")
    assert main(["build", str(fleet), "-o", str(tmp_path / "out")]) == 2
    out, err = capsys.readouterr()
    assert err.startswith(
        "multibot: a fleet file is checked with jsonschema 3.2 or newer; install it"
    )
    assert (out, err.count("\n")) == ("", 1)
    assert not (tmp_path / "out").exists()


def test_what_is_valid_is_quickly_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Importing jsonschema takes longer than planning a fleet."""
    pytest.importorskip("jsonschema_rs")
    monkeypatch.setitem(sys.modules, "jsonschema", None)
    fleets = [*(ROOT / "examples").rglob("fleet*.yaml")]
    assert len(fleets) >= 8
    for fleet in fleets:
        assert read_fleet(str(fleet), "", {}).robots


def test_what_another_validator_cannot_read_is_one_line(tmp_path: Path) -> None:
    """A date is no value of JSON."""
    with pytest.raises(InputError, match="layout: "):
        read(tmp_path, f"{ONE}layout: 2026-01-01\n")


@pytest.mark.parametrize("part", [(), ("$defs", "robot"), ("$defs", "related_files")])
def test_every_key_of_the_schema_is_explained(part: tuple[str, ...]) -> None:
    found = schema()
    for key in part:
        found = found[key]
    assert [key for key in keys(found) if not found["properties"][key].get("description")] == []
    rows = set(re.findall(r"^\| `(\w+)` ", KEYS, re.MULTILINE))
    assert set(keys(found)) <= rows


EXAMPLES = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.slow
@pytest.mark.sample(3)
@pytest.mark.parametrize("at", range(len(EXAMPLES)))
def test_every_example_of_the_page_builds(
    at: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fleet_folder(tmp_path)
    (tmp_path / "site.yaml").write_text("layout: L2\naffix: prefix\n")
    path = tmp_path / "fleet.yaml"
    path.write_text(EXAMPLES[at])
    code = main(["build", str(path), "-o", str(tmp_path / "out"), "--quiet"])
    assert code == 0, capsys.readouterr().err


def test_the_page_has_examples_and_the_line_for_editors() -> None:
    assert len(EXAMPLES) >= 4
    line = re.search(r"yaml-language-server: \$schema=(\S+)", PAGE)
    assert line is not None
    assert line[1] == editors.schema_name(editors.FLEET)
    assert yaml.safe_load(EXAMPLES[0])["robots"]


def fault(given: Any, validator: str, wanted: Any, **schema: Any) -> str:
    """Return what is said of an error of jsonschema."""
    return _in_words(
        SimpleNamespace(
            instance=given, validator=validator, validator_value=wanted, schema=schema,
            message="'name' is a required property",
        )
    )  # fmt: skip


def test_every_fault_has_its_sentence() -> None:
    wrong = "is not valid; "
    assert fault({}, "required", ["x", "name"]) == "the key 'name' is missing; add it"
    assert fault(None, "type", "array") == "the value is missing; write one, or remove the key"
    assert fault("bot", "enum", ["both", "x"]) == "'bot' is not known; did you mean 'both'?"
    assert fault("qqq", "enum", ["a", 1]) == "'qqq' is not known; known are a, 1"
    assert fault([], "minItems", 1) == "the list is empty; write at least one item"
    assert fault([1], "minItems", 3) == f"[1] {wrong}write 3 items"
    assert fault([1, 2], "maxItems", 1) == f"[1, 2] {wrong}write 1 items"
    assert fault("", "minLength", 1) == f"'' {wrong}write some text"
    assert fault(-1, "minimum", 0) == f"-1 {wrong}the minimum is 0"
    assert fault(9, "maximum", 5) == f"9 {wrong}the maximum is 5"
    assert fault("x", "oneOf", []) == f"'x' {wrong}correct it"
    assert fault("x", "pattern", "^a", description="a word") == f"'x' {wrong}write a word"
    for given in (1, True):
        assert fault(given, "type", "string") == f"{given} {wrong}write it in quotes"
    assert fault([1], "type", "string") == f"[1] {wrong}write text"
    assert fault("a", "type", "object", properties={"name": {}}) == f"'a' {wrong}write {{name: a}}"
    assert fault(1, "type", ["array", "boolean"]) == f"1 {wrong}write a list or true or false"
    assert fault("y" * 60, "oneOf", []) == f"'{'y' * 59}... {wrong}correct it"
