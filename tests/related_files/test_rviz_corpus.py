# SPDX-License-Identifier: Apache-2.0
"""Every public RViz config is made one for robots with only names changed, or refused truly."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import CORPUS
from rviz_robots import declared, robots_of

from multibot_rewrite.base.model import InputError
from multibot_rewrite.related_files.rviz.read_config import rviz_data
from multibot_rewrite.related_files.rviz.rewrite import rewrite_rviz
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml

LAYOUTS = ("L1", "L2", "L3", "L4")
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
LEAST, SAMPLE = 300, 6
ROS1_REFUSED = "this is a ROS 1 config, which rviz2 cannot load"
# Names that no file has yet.
ROBOTS = ("zorba1", "zorba2")
ROS1 = re.compile(r"^\s*(?:- )?Class: rviz/", re.MULTILINE)
# Keys whose values may change, beside keys of these maps.
NAME_KEYS = re.compile(r"Topic|Frame|Namespace|Description|Prefix|Color$|Name$|Value$")
NAME_MAPS = {"Frames", "Tree", "Links", "Joints"}
REMOVED = {"Visibility", "Tree", "QMainWindow State"}


@pytest.fixture(scope="module")
def configs() -> list[Path]:
    files = sorted((CORPUS / "rviz").glob("**/*.rviz"))
    if not files:
        pytest.skip(f"no corpus of RViz configs: looked for {CORPUS / 'rviz'}/**/*.rviz")
    assert len(files) >= LEAST
    return files


def read(path: Path) -> YamlText:
    return read_yaml(path.read_bytes(), path.name)


def reason(error: InputError) -> str:
    text = re.sub(r"^\S*?:(\d+:)* ", "", str(error))
    return re.sub(r" \(.*?\)", "", text).partition(";")[0].strip()


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_some_of_the_corpus(configs: list[Path], layout: str) -> None:
    assert survey(configs[::SAMPLE], layout).keys() == {ROS1_REFUSED}


@pytest.mark.deep
@pytest.mark.parametrize("layout", LAYOUTS)
def test_corpus(configs: list[Path], layout: str) -> None:
    assert dict(survey(configs, layout)) == {ROS1_REFUSED: 182}


def survey(configs: list[Path], layout: str) -> Counter[str]:
    """Return the refusals by reason; fails where a result is wrong or a reason is not true."""
    refused: Counter[str] = Counter()
    for path in configs:
        document = read(path)
        try:
            check(document, layout)
        except InputError as error:
            refused[reason(error)] += 1
            assert ROS1.search(document.text), f"{path}: {error}"
        except AssertionError as error:
            raise AssertionError(f"{path}: {error}") from error
    return refused


def check(document: YamlText, layout: str) -> None:
    robots = robots_of(declared(document), layout, ROBOTS)
    made, _ = rewrite_rviz(document, robots)
    source = yaml.load(document.text, LOADER)
    if layout == "L2":
        together, *made = made
        assert together.robot == ""
        check_together(source, yaml.load(together.text, LOADER))
        # What reads names and parameters of its own process is in a window of each robot.
        if without(source, ["process"]) == source:
            assert made == []
            return
    assert [one.robot for one in made] == list(ROBOTS)
    for one in made:
        result = yaml.load(one.text, LOADER)
        gone = ["absolute"] if layout != "L4" else ["absolute", "process"]
        assert not list(differences(without(source, gone), result, one.robot, layout))
        check_bytes(document, one.text, "left out:" in one.text)


def without(config: Any, flags: list[str]) -> Any:
    """Return the config without what serves one process."""
    if isinstance(config, dict):
        return {key: without(value, flags) for key, value in config.items()}
    if not isinstance(config, list):
        return config
    gone = [cls for cls, flag in rviz_data()["flags"].items() if flag in flags]
    kept = [it for it in config if not (isinstance(it, dict) and it.get("Class") in gone)]
    return [without(it, flags) for it in kept] or (None if config and not kept else [])


def differences(
    old: Any, new: Any, robot: str, layout: str, path: tuple[str, ...] = ()
) -> Iterator[str]:
    """Where two values differ in another thing than a name that became the robot's."""
    if isinstance(old, dict) and isinstance(new, dict):
        yield from _keys(old, new, robot, path)
        for (key, before), after in zip(old.items(), new.values(), strict=True):
            yield from differences(before, after, robot, layout, (*path, str(key)))
    elif isinstance(old, list) and isinstance(new, list):
        if len(old) != len(new):
            yield f"{path}: {len(old)} entries became {len(new)}"
        for before, after in zip(old, new, strict=False):
            yield from differences(before, after, robot, layout, path)
    elif old != new and not is_respelled(old, new, robot, path):
        yield f"{path}: {old!r} became {new!r}"


def _keys(
    old: dict[str, Any], new: dict[str, Any], robot: str, path: tuple[str, ...]
) -> Iterator[str]:
    if len(old) != len(new):
        yield f"{path}: {set(old) ^ set(new)}"
        return
    for before, after in zip(old, new, strict=True):
        if before != after and not (
            NAME_MAPS & set(path) and unspelled(str(after), robot) == before
        ):
            yield f"{path}: key {before!r} became {after!r}"


def is_respelled(old: Any, new: Any, robot: str, path: tuple[str, ...]) -> bool:
    if not NAME_KEYS.search(path[-1]) and not (path[-2:-1] and NAME_KEYS.search(path[-2])):
        return False
    if path[-1] == "TF Prefix":
        return new == ""
    for word in ("<robot_namespace>", "<namespace>"):
        old = str(old).removeprefix("/").removeprefix(word)
    return unspelled(str(new), robot).strip("/") == str(old).strip("/")


def unspelled(text: str, robot: str) -> str:
    return re.sub(rf"(?<![^/_]){robot}(?:/|_|$)|[/_]{robot}$", "", text)


def check_bytes(document: YamlText, text: str, left_out: bool) -> None:
    """Every line that did not get a name is as it was."""
    if left_out:
        return
    before, after = document.text.split("\n"), text.split("\n")
    assert len(before) == len(after) or sum("Topic: /" in it for it in after) >= len(after) - len(
        before
    )
    for old, new in zip(before, after, strict=False):
        if len(before) == len(after) and old != new:
            resolved = any(word in old for word in ("<robot_namespace>", "<namespace>"))
            assert resolved or "TF Prefix" in old or any(robot in new for robot in ROBOTS), (
                f"{old!r} became {new!r}"
            )


def leaves(displays: Any) -> Iterator[dict[str, Any]]:
    for one in displays or ():
        if one.get("Displays"):
            yield from leaves(one["Displays"])
        else:
            yield one


def check_together(source: Any, result: Any) -> None:
    """Each display stands once for all robots, or once in the group of each."""
    old, new = source["Visualization Manager"], result["Visualization Manager"]
    wanted = list(leaves(without(old, ["absolute", "process"]).get("Displays")))
    top = new.get("Displays") or []
    groups = [
        one for one in top if one.get("Class") == "rviz_common/Group" and one["Name"] in ROBOTS
    ]
    shared = list(leaves([one for one in top if one not in groups]))
    own = [one for one in wanted if not any(same(one, it, "", "") for it in shared)]
    assert len(shared) + len(own) == len(wanted)
    assert [one["Name"] for one in groups] == (list(ROBOTS) if own else [])
    for group in groups:
        copies = list(leaves(group["Displays"]))
        assert len(copies) == len(own)
        for before, after in zip(own, copies, strict=True):
            assert same(before, after, group["Name"], "L2"), (before, after)
    assert len({topics(group) for group in groups}) == len(groups)
    check_tools(old, new)
    frame = new["Global Options"]["Fixed Frame"] if "Global Options" in new else "map"
    assert frame in ("map", "world") or frame == old["Global Options"]["Fixed Frame"]
    assert not any(robot in str(frame) for robot in ROBOTS)


def topics(group: dict[str, Any]) -> str:
    return str(list(leaves(group["Displays"])))


def same(old: dict[str, Any], new: dict[str, Any], robot: str, layout: str) -> bool:
    old, new = ({key: it for key, it in one.items() if key not in REMOVED} for one in (old, new))
    if old.get("Class") != new.get("Class"):
        return False
    if not robot and "Frames" in old and "TF" in str(old["Class"]):
        old, new = ({key: it for key, it in one.items() if key != "Frames"} for one in (old, new))
    if robot:
        old, new = unpainted(old), unpainted(new)
        new["Name"] = str(new.get("Name")).removeprefix(f"{robot} ")
        old["Name"] = str(old.get("Name"))
        return not list(differences(old, new, robot, layout))
    return bool(old == new)


def unpainted(one: dict[str, Any]) -> dict[str, Any]:
    """Return a display without the colour that may be the robot's."""
    shape = (
        {k: v for k, v in (one.get("Shape") or {}).items() if k != "Color"}
        if isinstance(one.get("Shape"), dict)
        else one.get("Shape")
    )
    return {**{key: it for key, it in one.items() if key != "Color"}, "Shape": shape}


def check_tools(old: Any, new: Any) -> None:
    kept = without(old.get("Tools") or [], ["absolute", "process"]) or []
    made = list(new.get("Tools") or [])
    for tool in kept:
        count = len(ROBOTS) if tool["Class"] in rviz_data()["tools"] else 1
        copies, made = made[:count], made[count:]
        assert [one["Class"] for one in copies] == [tool["Class"]] * count
        if count > 1:
            values = [topic_of(one) for one in copies]
            assert len(set(values)) == len(values)
    assert not made


def topic_of(tool: dict[str, Any]) -> str:
    topic = tool["Topic"]
    return str(topic["Value"] if isinstance(topic, dict) else topic)
