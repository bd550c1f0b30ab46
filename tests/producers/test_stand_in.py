# SPDX-License-Identifier: Apache-2.0
"""The parts of the stand-in for launch, each by what launch jazzy does with the same words."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest
from paths import FIXTURES

from multibot_rewrite import InputError
from multibot_rewrite.producers.launch import includes, places, visit
from multibot_rewrite.producers.launch.entities import Entity, root_of
from multibot_rewrite.producers.launch.read_files import descriptions_in
from multibot_rewrite.producers.launch.records import ParameterText
from multibot_rewrite.producers.launch.stand_in import (
    frontend,
    packages,
    parameters,
    processes,
    ros,
    standing_in,
    values,
)
from multibot_rewrite.producers.launch.stand_in.frontend import parse_substitution
from multibot_rewrite.producers.launch.stand_in.values import LaunchConfiguration, LaunchContext
from multibot_rewrite.system.records import Place


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> LaunchContext:
    monkeypatch.setenv("HERE", "home")
    made = LaunchContext()
    made.launch_configurations.update({"n": "5", "yes": "true", "word": "w"})
    made.extend_locals({"current_launch_file_path": "/launch/bringup.launch.py"})
    return made


N, YES, WORD = LaunchConfiguration("n"), LaunchConfiguration("yes"), LaunchConfiguration("word")


@pytest.mark.parametrize(
    ("made", "text"),
    [
        (values.TextSubstitution(text=5), "5"),
        (N, "5"),
        (LaunchConfiguration(["wo", "rd"]), "w"),
        (LaunchConfiguration("no", default=["a", N]), "a5"),
        (values.EnvironmentVariable("HERE"), "home"),
        (values.EnvironmentVariable("NOT_HERE", default_value=""), ""),
        (packages.PathJoinSubstitution(["/a", N, "b"]), "/a/5/b"),
        (packages.PathJoinSubstitution(["/a", ["b", N, ".yaml"]]), "/a/b5.yaml"),
        (packages.PathJoinSubstitution([Path("/a")]) / "b" / ["c", N], "/a/b/c5"),
        (packages.PathSubstitution("/a") / packages.PathJoinSubstitution(["b", "c"]), "/a/b/c"),
        # Those of a list are parts (path_join_substitution.py).
        (packages.PathSubstitution(["/a", N]) / Path("b"), "/a/5/b"),
        (packages.ThisLaunchFileDir() / ".." / "config", "/launch/../config"),
        (packages.StringJoinSubstitution([["a", N], "b"]), "a5b"),
        (packages.StringJoinSubstitution([["a", N], "b"], "."), "a5.b"),
        (packages.StringJoinSubstitution(["a", "b", "c"], delimiter=WORD), "awbwc"),
        (values.ForEachVar("x", default_value=["d", N]), "d5"),
        (values.PythonExpression([N, " + 1"]), "6"),
        (values.PythonExpression("pi > 3 and math.pi > 3"), "True"),
        (values.PythonExpression("os.sep", ["os"]), "/"),
        (packages.ThisLaunchFile(), "/launch/bringup.launch.py"),
        (packages.ThisLaunchFileDir(), "/launch"),
        (values.EqualsSubstitution(N, "5.0"), "true"),
        (values.EqualsSubstitution(N, 6), "false"),
        (values.EqualsSubstitution(YES, "1"), "true"),
        (values.EqualsSubstitution(YES, False), "false"),
        (values.EqualsSubstitution(WORD, ["w"]), "false"),
        (values.EqualsSubstitution(WORD, "w"), "true"),
        (values.EqualsSubstitution(None, ""), "true"),
        (values.NotEqualsSubstitution(N, "5"), "false"),
        (values.AndSubstitution(YES, "yes"), "true"),
        (values.AndSubstitution(YES, "0"), "false"),
        (values.OrSubstitution("no", "off"), "false"),
        (values.OrSubstitution("no", YES), "true"),
        (values.NotSubstitution(YES), "false"),
        (values.NotSubstitution("0"), "true"),
        (values.AllSubstitution(), "true"),
        (values.AllSubstitution(YES, "0"), "false"),
        (values.AnySubstitution("0", YES), "true"),
        (values.AnySubstitution(), "false"),
        (values.IfElseSubstitution(YES, "a", "b"), "a"),
        (values.IfElseSubstitution("0", "a", ["b", N]), "b5"),
        (values.IfElseSubstitution("0", "a"), ""),
        (values.LocalSubstitution("current_launch_file_path[:3]"), "/la"),
        (values.AnonName("x"), "x_anonymous"),
    ],
)
def test_what_a_substitution_is(made: Any, text: str, context: LaunchContext) -> None:
    assert made.perform(context) == text
    assert context.perform_substitution(made) == text


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (LaunchConfiguration("no"), "launch configuration 'no' does not exist"),
        (values.EnvironmentVariable("NOT_HERE"), "environment variable 'NOT_HERE' does not exist"),
        (values.NotSubstitution(N), "Cannot convert value '5'"),
        (packages.FileContent("/no/such"), "File not found: /no/such"),
    ],
)
def test_a_substitution_without_a_value(made: Any, message: str, context: LaunchContext) -> None:
    with pytest.raises(values.SubstitutionFailure, match=message):
        made.perform(context)


def test_the_content_of_a_file(context: LaunchContext, tmp_path: Path) -> None:
    (tmp_path / "a").write_text("text\n")
    assert packages.FileContent(str(tmp_path / "a")).perform(context) == "text\n"


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        (values.Condition(), True),
        (values.Condition(predicate=lambda it: it.launch_configurations["n"] == "5"), True),
        (values.Condition(predicate=lambda it: False), False),
        (values.IfCondition(YES), True),
        (values.IfCondition(" True "), True),
        (values.IfCondition("0"), False),
        (values.UnlessCondition(YES), False),
        (values.UnlessCondition("false"), True),
        (values.LaunchConfigurationEquals("n", ["5"]), True),
        (values.LaunchConfigurationEquals("n", "6"), False),
        (values.LaunchConfigurationEquals("no", None), True),
        (values.LaunchConfigurationNotEquals("n", "5"), False),
        (values.LaunchConfigurationNotEquals("no", "5"), True),
    ],
)
def test_a_condition(condition: Any, holds: bool, context: LaunchContext) -> None:
    assert condition.evaluate(context) is holds


def test_a_text_that_is_no_condition(context: LaunchContext) -> None:
    with pytest.raises(values.InvalidConditionExpressionError, match="'5' is no condition"):
        values.evaluate_condition_expression(context, N)
    for text, truth in (("yes", True), ("off", False), ("1", True), ("0", False)):
        assert values.typed_truth(text) is truth
    for text in ("", "5", "maybe"):
        with pytest.raises(ValueError, match="Cannot convert value"):
            values.typed_truth(text)


def test_words_that_an_action_does_not_take() -> None:
    for words, options in (((), {"b": 1, "a": 1}), (("x", "y"), {})):
        with pytest.raises(TypeError, match=r"got an unexpected keyword argument 'a'|got too many"):
            values.TextSubstitution(*words, **options)
    with pytest.raises(TypeError, match="Failed to normalize given item of type"):
        values.normalize_to_list_of_substitutions([5])
    assert len(values.normalize_to_list_of_substitutions(["a", N])) == 2


def test_what_a_group_keeps_comes_back(context: LaunchContext) -> None:
    context._push_launch_configurations()
    context._push_environment()
    context._push_locals()
    context.launch_configurations["n"] = "6"
    context.environment["HERE"] = "away"
    context.extend_locals({"own": 1})
    context.extend_globals({"all": 2})
    assert (context.locals.own, context.locals.all) == (1, 2)
    context._pop_locals()
    context._pop_environment()
    context._pop_launch_configurations()
    assert (N.perform(context), context.environment["HERE"]) == ("5", "home")
    assert "own" not in context.get_locals_as_dict()
    context.environment.clear()
    context._reset_environment()
    assert context.environment == dict(os.environ)


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ("5", "5"),
        (5, 5),
        (N, 5),
        (WORD, "w"),
        ([N, "5"], 55),
        ([1, 2.5], [1.0, 2.5]),
        (["a", "b"], ["a", "b"]),
        (["a", [WORD]], ["a", "w"]),
        (parameters.ParameterValue(N, value_type=str), "5"),
        (parameters.ParameterValue(N, value_type=int), 5),
        (parameters.ParameterValue(N, value_type=float), 5.0),
        (parameters.ParameterValue(YES, value_type=bool), True),
        (parameters.ParameterValue(N), 5),
        (parameters.ParameterValue([N, "x"]), "5x"),
        (parameters.ParameterValue([1, [N]]), [1, "5"]),
        (parameters.ParameterValue(True), True),
        (LaunchConfiguration("no", default=""), ""),
        (LaunchConfiguration("no", default="[1, 2]"), [1, 2]),
    ],
)
def test_a_value_of_a_parameter_has_a_type(given: Any, kept: Any, context: LaunchContext) -> None:
    """launch_ros jazzy, utilities/evaluate_parameters.py."""
    (found,) = parameters.evaluate_parameters(context, [{"a": {"b": given}}])
    assert found == {"a.b": kept}
    assert type(found["a.b"]) is type(kept)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ([1, "a"], 'Got inconsistent input for "p"'),
        ([], 'Got inconsistent input for "p"'),
        (object(), "Unexpected type for parameter value"),
        (LaunchConfiguration("no", default="{a: 1}"), "Allowed value types are bytes, bool"),
        (LaunchConfiguration("no", default="[1, a]"), 'Got inconsistent input for "p"'),
        (LaunchConfiguration("no", default="a: ["), "Unable to parse the value of parameter p"),
    ],
)
def test_a_value_that_is_none(given: Any, message: str, context: LaunchContext) -> None:
    with pytest.raises(TypeError, match=message):
        parameters.evaluate_parameters(context, [{"p": given}])


def test_a_parameter_alone_and_a_file_of_parameters(context: LaunchContext, tmp_path: Path) -> None:
    one = parameters.Parameter(["p", N], N, value_type=int)
    assert parameters.evaluate_parameters(context, [one]) == (one,)
    assert one.evaluate(context) == ("p5", 5)
    file = tmp_path / "p.yaml"
    file.write_text("/**: {ros__parameters: {a: $(var n)}}\n")
    assert parameters.evaluate_parameters(context, [str(file), file]) == (file, file)
    (made,) = parameters.evaluate_parameters(
        context, [parameters.ParameterFile(file, allow_substs=True)]
    )
    assert made != file
    assert made.read_text() == "/**: {ros__parameters: {a: 5}}\n"
    made.unlink()


def test_names_of_parameters_are_joined(context: LaunchContext) -> None:
    (found,) = parameters.evaluate_parameters(context, [{"a": {(N, "x"): {"c": 1}, "d": 2}}])
    assert found == {"a.5x.c": 1, "a.d": 2}


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two prefixes with a package of one name, and a folder that is none."""
    for prefix in ("first", "second"):
        index = tmp_path / prefix / "share/ament_index/resource_index"
        (index / "packages").mkdir(parents=True)
        (index / "packages" / "acme").write_text(prefix)
    (tmp_path / "second/share/ament_index/resource_index/packages/late").touch()
    (tmp_path / "first/lib/acme").mkdir(parents=True)
    (tmp_path / "first/lib/acme/run").touch()
    (tmp_path / "none").mkdir()
    paths = [str(tmp_path / it) for it in ("none", "first", "second")]
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join(["", *paths]))
    return tmp_path


def test_a_package_is_in_the_first_prefix_that_has_it(
    installed: Path, context: LaunchContext
) -> None:
    """ament_index_python packages.py and resources.py."""
    first, second = str(installed / "first"), str(installed / "second")
    assert packages.get_package_prefix("acme") == first
    assert packages.get_package_prefix("late") == second
    assert packages.get_package_share_directory("acme") == f"{first}/share/acme"
    assert packages.get_package_share_path("acme") == Path(first, "share", "acme")
    assert packages.get_packages_with_prefixes() == {"acme": first, "late": second}
    assert packages.has_resource("packages", "acme") == first
    assert packages.has_resource("packages", "acne") is False
    assert packages.get_resource("packages", "acme") == ("first", first)
    with pytest.raises(LookupError, match="no resource 'acne' of type 'packages'"):
        packages.get_resource("packages", "acne")
    with pytest.raises(packages.PackageNotFoundError, match="package 'acne' not found"):
        packages.get_package_prefix("acne")
    assert packages.FindPackagePrefix("acme").perform(context) == first
    assert packages.FindPackageShare(["ac", "me"]).perform(context) == f"{first}/share/acme"
    found = packages.ExecutableInPackage(executable="run", package="acme").perform(context)
    assert found == f"{first}/lib/acme/run"
    with pytest.raises(values.SubstitutionFailure, match="executable not found: "):
        packages.ExecutableInPackage("walk", "acme").perform(context)


def test_a_parameter_that_is_set_for_all_nodes(context: LaunchContext) -> None:
    context.launch_configurations["global_params"] = ["p.yaml", ("rate", 5)]
    assert packages.ParameterSubstitution("rate").perform(context) == "5"
    assert packages.ParameterSubstitution("no", default=["a", N]).perform(context) == "a5"
    with pytest.raises(values.SubstitutionFailure, match="parameter 'no' not found"):
        packages.ParameterSubstitution("no").perform(context)


XML = """\
<launch>
  <node pkg="a" exec="b"/>
  <node_container pkg="c" exec="d">
    <composable_node pkg="e" plugin="e::F"/>
  </node_container>
  <node pkg="a" exec="b"/>
</launch>
"""
YAML = """\
launch:
- node: {pkg: a, exec: b}
- group:
  - node_container:
      pkg: c
      exec: d
      composable_node:
      - {pkg: e, plugin: "e::F"}
- node: {pkg: a, exec: b}
"""


@pytest.mark.parametrize(
    ("text", "lines"),
    [(XML, (2, 3, 4)), (YAML, (2, 4, 8)), ("<launch", (1,) * 3), ("- [", (1,) * 3)],
)
def test_the_line_of_a_node_in_xml_and_yaml(
    text: str, lines: tuple[int, int, int], tmp_path: Path
) -> None:
    """The first that starts the program counts."""
    file = str(tmp_path / "a.launch")
    Path(file).write_text(text)
    started = (("a", "b"), ("c", "d"), ("e", "e::F"))
    assert tuple(places.place_of(None, file, it) for it in started) == tuple(
        Place(os.path.realpath(file), it) for it in lines
    )
    assert places.place_of(None, file).line == 1
    assert places.place_of(None, file, ("no", "b")).line == 1
    assert places.place_of(None, str(tmp_path / "gone"), ("a", "b")).line == 1


def test_the_descriptions_that_were_read(tmp_path: Path) -> None:
    (tmp_path / "a.urdf").write_text("<robot/>")
    (tmp_path / "link.urdf").symlink_to(tmp_path / "a.urdf")
    path = os.path.realpath(tmp_path / "a.urdf")
    given = [str(tmp_path / it) for it in ("a.urdf", "link.urdf", "gone.urdf", "")]
    assert list(descriptions_in(given)) == [(path, ParameterText(path, "<robot/>", path))]


# launch jazzy frontend/grammar.lark: text, arguments with and without quotes, one inside another.
WRITTEN = {
    "": "",
    "a b": "a b",
    "$(var n)": "5",
    "a$(var n)$(var word)b": "a5wb",
    "$(env HERE)": "home",
    "$(env NOT_HERE)x": None,
    "$(env NOT_HERE 'x y')": "x y",
    '$(env NOT_HERE "x y")': "x y",
    "$(env NOT_HERE '')": "",
    "$(eval '1 + $(var n)')": "6",
    '$(eval "1 + $(var n)")': "6",
    "$(eval '\\'$(var word)\\' == \\'w\\'')": "True",
    "$(env NOT_HERE $(var n))": "5",
    "$(dirname)/x.yaml": "/launch/x.yaml",
    "$(not $(var yes))": "false",
    "$(if $(var yes) a b)": "a",
    # launch rolling, path_join_substitution.py and string_join_substitution.py.
    "$(path-join $(env HERE) 'cfg 2' config_$(var n).yml)": "home/cfg 2/config_5.yml",
    "$(string-join . https://$(var word) ros org)": "https://w.ros.org",
    "$(for-var x $(var n))": "5",
}


def test_texts_of_launch_files_in_xml_and_yaml(context: LaunchContext) -> None:
    for text, wanted in WRITTEN.items():
        parts = parse_substitution(text)
        if wanted is None:
            with pytest.raises(Exception, match="NOT_HERE"):
                [it.perform(context) for it in parts]
            continue
        assert "".join(it.perform(context) for it in parts) == wanted, text
    for text in ("$(var n", "$(nope x)", "$(arg x)", "$(env HERE 'x)", "$(var 'n)"):
        with pytest.raises(ValueError, match=r"closed|needs launch|Unknown|substitution"):
            parse_substitution(text)


# launch and launch_ros jazzy: what ``parse`` of each action reads of its element, and the argument that
# it becomes where that has another name. ``!`` has to be there; ``<tag>`` are elements below.
PROCESS = (
    "cwd output respawn respawn_max_retries respawn_delay sigkill_timeout sigterm_timeout shell"
    " emulate_tty launch-prefix=prefix on_exit <env>=additional_env"
)
PARTS = "<remap>=remappings <param>=parameters"
NODE = (
    f"{PROCESS} {PARTS} !exec=executable pkg=package name node-name=name namespace exec_name"
    " args=arguments ros_args=ros_arguments"
)
INSIDE = "<composable_node>=composable_node_descriptions"
KEEP = "<keep>=launch_configurations"
ELEMENTS = {
    "append_env": "AppendEnvironmentVariable: !name !value prepend separator",
    "arg": "DeclareLaunchArgument: !name default=default_value description <choice>=choices",
    "executable": f"ExecuteProcess: {PROCESS} !cmd name",
    "group": f"GroupAction: scoped forwarding {KEEP} <*>=actions",
    "include": "IncludeLaunchDescription: !file=launch_description_source <arg>=launch_arguments",
    "let": "SetLaunchConfiguration: !name !value",
    "load_composable_node": f"ros LoadComposableNodes: !target=target_container {INSIDE}",
    # launch rolling, actions/log.py and for_loop.py.
    "log": "Log: !message=msg level",
    **{f"log_{it}": "LogInfo: !message=msg" for it in ("debug", "error", "info", "warning")},
    "for": "loops loop_of: !len=length !name <*>=actions",
    "for_each": "loops each_of: !values <*>=actions",
    "node": f"ros Node: {NODE}",
    "node_container": f"ros ComposableNodeContainer: {NODE} {INSIDE}",
    "push-ros-namespace": "ros PushROSNamespace: !namespace",
    "push_ros_namespace": "ros PushROSNamespace: !namespace",
    "reset": f"ResetLaunchConfigurations: {KEEP}",
    "reset_env": "ResetEnvironment:",
    "ros_timer": "ros ROSTimer: !period <*>=actions",
    "set_env": "SetEnvironmentVariable: !name !value",
    "set_parameter": "ros SetParameter: !name !value",
    "set_parameters_from_file": "ros SetParametersFromFile: !filename",
    "set_remap": "ros SetRemap: !from=src !to=dst",
    "set_ros_log_dir": "ros SetROSLogDir: !new_log_dir",
    "set_use_sim_time": "ros SetUseSimTime: !value",
    "shutdown": "Shutdown: reason",
    "timer": "TimerAction: !period cancel_on_shutdown <*>=actions",
    "unset_env": "UnsetEnvironmentVariable: !name",
}
COMPONENT = f"{PARTS} !pkg=package !plugin !name namespace <extra_arg>=extra_arguments"


def read_of(form: frontend.Form) -> set[str]:
    """Return what a form reads, as in ELEMENTS."""
    values = {f"{'!' * (it in form.needs)}{it}={key}" for it, (key, _) in form.values.items()}
    below = {f"<{it}>={key}" for it, (key, _) in form.below.items()}
    return values | below | ({f"<*>={form.actions}"} if form.actions else set())


def meant(words: str) -> set[str]:
    return {it if "=" in it else f"{it}={it.strip('!')}" for it in words.split()}


def test_every_element_of_launch_files_in_xml_and_its_attributes() -> None:
    assert frontend.forms().keys() == {*ELEMENTS, "composable_node"}
    for tag, text in ELEMENTS.items():
        name, _, words = text.partition(":")
        form, (own, _, class_) = frontend.forms()[tag], name.rpartition(" ")
        module = {"ros": "launch_ros.actions", "loops": processes.__name__}.get(
            own, "launch.actions"
        )
        assert form.module == module, tag
        assert (form.name, read_of(form)) == (class_, meant(words)), tag
    component = frontend.forms()["composable_node"]
    assert (component.module, component.name) == ("launch_ros.descriptions", "ComposableNode")
    assert read_of(component) == meant(COMPONENT)


def test_attributes_that_are_true_or_a_command_line() -> None:
    readers = {
        (word, read)
        for form in frontend.forms().values()
        for word, (_, read) in form.values.items()
    }
    truths = {word for word, read in readers if read is frontend._truth}
    assert truths == {
        "shell", "emulate_tty", "prepend", "scoped", "forwarding"
    }  # fmt: skip
    lines = {word for word, read in readers if read is frontend._command_words}
    assert lines == {"args", "ros_args", "cmd"}
    texts = ("true", "1", "on", "yes", "TRUE", True, "false", "0", "", False)
    assert [frontend._truth(it) for it in texts] == [*[True] * 6, *[False] * 4]


def test_elements_of_ros_1_are_refused_and_those_of_others_are_told() -> None:
    for tag in ("env", "machine", "param", "remap", "rosparam", "test"):
        with pytest.raises(RuntimeError, match=f"Unrecognized entity of the type: {tag}"):
            frontend._action_of(Entity(tag, 1, {}, []))
    with standing_in():
        other = frontend._action_of(Entity("so_they_say", 1, {}, []))
    with pytest.raises(NotImplementedError, match=r"^<so_they_say> is not read: it needs launch"):
        other.execute(LaunchContext())


def test_every_substitution_of_launch_files_in_xml() -> None:
    """The words that launch and launch_ros jazzy expose, each with the class that it stands for."""
    words = {
        "all": "All", "and": "And", "any": "Any", "dirname": "ThisLaunchFileDir",
        "env": "EnvironmentVariable", "equals": "Equals", "exec-in-pkg": "ExecutableInPackage",
        "file-content": "FileContent", "filename": "ThisLaunchFile", "anon": "AnonName",
        "find-exec": "FindExecutable", "find-pkg-prefix": "FindPackagePrefix",
        "find-pkg-share": "FindPackageShare", "if": "IfElse", "launch_log_dir": "LaunchLogDir",
        "log_dir": "LaunchLogDir", "not": "Not", "not-equals": "NotEquals", "or": "Or",
        "param": "Parameter", "var": "LaunchConfiguration",
        # launch rolling, substitutions/for_loop_var.py.
        "for-var": "ForEachVar", "index": "ForLoopIndex",
    }  # fmt: skip
    of_several = {"command", "eval", "path-join", "string-join"}
    known = {**vars(packages), **vars(values)}
    classes = {it: known.get(f"{name}Substitution") or known[name] for it, name in words.items()}
    made = {it: kind for it, kind in frontend.known().items() if it not in of_several}
    assert (made, frontend.known().keys() - made.keys()) == (classes, of_several)
    for word in ("arg", "find", "optenv"):
        with pytest.raises(ValueError, match=word):
            parse_substitution(f"$({word} a)")


def test_every_action_of_launch_is_visited() -> None:
    """By the table made of the real one; what is not in it is of other releases, what is not named
    here is visited as the class that it is one of."""
    there = json.loads((FIXTURES / "launch_signatures.json").read_text())["names"]
    names = {*there["launch.actions"], *there["launch_ros.actions"]}
    named = {*visit._handlers()}
    assert names - named == {"LifecycleNode", "OpaqueCoroutine", "ROSTimer", "RosTimer"}
    others = {"LaunchDescription", "ForEach", "ForLoop", "ReplaceEnvironmentVariables"}
    others |= {"Log", "LogInterface", "LoadedComponent"}
    assert named - names == others
    starts = {
        "IncludeLaunchDescription", "ComposableNodeContainer", "LoadComposableNodes", "Node",
        "ExecuteLocal", "ExecuteProcess", "RegisterEventHandler", "TimerAction", "LoadedComponent",
    }  # fmt: skip
    passed = {
        "SetUseSimTime", "Log", "LogInfo", "LogInterface", "EmitEvent", "Shutdown", "SetROSLogDir",
        "LifecycleTransition",
        "UnregisterEventHandler",
    }  # fmt: skip
    assert {it for it, how in visit._handlers().items() if how is visit._add_nothing} == passed
    executed = {it for it, how in visit._handlers().items() if how is visit._execute}
    assert executed == named - starts - passed


def test_arguments_of_the_launch_files_of_gazebo() -> None:
    """ros_gz_sim launch/gz_sim.launch.py and gz_spawn_model.launch.py; src/create.cpp has the words."""
    same = ("world", "file", "string", "topic", "allow_renaming", "x", "y", "z", "R", "P", "Y")
    words = {it: f"-{it}" for it in same}
    assert {**words, "entity_name": "-name", "model_string": "-string"} == includes._SPAWN_WORDS
    gz = ("gz_args", "ign_args", "gz_version", "ign_version", "debugger", "on_exit_shutdown")
    assert (gz, ("gz_args", "ign_args", "world")) == (includes._GZ_WORDS, includes._WORLDS)
    files = ("gz_sim", "ign_gazebo", "gz_server", "gazebo", "gzserver", "gzclient")
    assert tuple(f"{it}.launch.py" for it in files) == includes._SIMULATES
    given = {"gz_args": "-r 'a b.sdf'", "world": "w.sdf", "other": "x"}
    assert [*includes._simulator_words(given)] == ["-r", "a b.sdf", "w.sdf"]
    given = {"entity_name": "r1", "x": "1", "y": "", "other": "z"}
    assert [*includes._spawner_words(given)] == ["-name", "r1", "-x", "1"]


def test_types_of_parameters_in_xml() -> None:
    """launch frontend/type_utils.py."""
    simple = ("int", "float", "bool", "str")
    assert {"yaml", *simple, *(f"list_of_{it}" for it in simple)} == frontend._KINDS
    assert {it.__name__ for it in frontend._TYPES.values()} == {*simple} == {*frontend._TYPES}


def test_transitions_have_the_numbers_of_lifecycle_msgs() -> None:
    """lifecycle_msgs/msg/Transition.msg."""
    known = ("CONFIGURE", "CLEANUP", "ACTIVATE", "DEACTIVATE")
    found = [getattr(ros.Transition, f"TRANSITION_{it}") for it in known]
    assert found == [1, 2, 3, 4]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("a b", [["a"], ["b"]]), ("a$(var x)b c", [["a", "x", "b"], ["c"]]), ("", []),
        ("a $(var x)", [["a"], ["x"]]), ("$(var x) b", [["x"], ["b"]]),
        ("$(var x)$(var y)", [["x", "y"]]), ("$(var x) $(var y)", [["x"], ["y"]]),
        ("'a b' c", [["a b"], ["c"]]), ("a $(var x) ", [["a"], ["x"]]),
    ],
)  # fmt: skip
def test_only_the_blanks_of_a_command_line_separate(line: str, words: list[list[str]]) -> None:
    """launch execute_process.py, _parse_cmdline."""
    context = LaunchContext()
    context.launch_configurations.update({"x": "x", "y": "y"})
    found = frontend._command_words(line)
    assert [[it.perform(context) for it in word] for word in found] == words


def visited(actions: list[Any], context: LaunchContext) -> list[str]:
    """Return what the nodes of these actions are called, each with its namespace."""
    seen = []
    for it in actions:
        below = it.visit(context)
        if isinstance(it, ros.Node):
            known = vars(it)
            seen.append(
                "/".join(values.text_of(context, known[key]) for key in ("namespace", "name"))
            )
        seen += visited(below if isinstance(below, list) else [], context)
    return seen


ROBOTS = "{name: a, number: 1};{name: b};"


def test_what_is_repeated(context: LaunchContext) -> None:
    """launch rolling, actions/for_loop.py: a set of values in YAML each, or a number below a length."""

    def each(name: str, number: int = 7) -> list[Any]:
        return [ros.Node(executable="x", name=f"n{number + 1}", namespace=name)]

    made = [processes.ForEach(ROBOTS, function=each), processes.ForEach("", function=each)]
    made += [processes.ForEach("{}", function=lambda: None)]
    made += [processes.ForLoop(["1", "0"], function=lambda i: each("c", i) if i < 2 else None)]
    assert visited(made, context) == ["a/n2", "b/n8", "c/n1", "c/n2"]
    with pytest.raises(ValueError, match="many"):
        processes.ForLoop("many", function=each).visit(context)
    with pytest.raises(TypeError, match="other"):
        processes.ForEach("{other: 1}", function=each).visit(context)


XML = """\
<launch>
  <for_each values="{name: a, number: 1};{name: b}">
    <node pkg="p" exec="x" name="n$(for-var number 9)" namespace="$(for-var name)"/>
    <for len="2" name="i">
      <node pkg="p" exec="x" name="$(for-var name)$(index i)" namespace="s"/>
    </for>
  </for_each>
  <log_warning message="$(for-var name none)"/>
</launch>
"""


def test_what_is_repeated_in_xml(context: LaunchContext, tmp_path: Path) -> None:
    (tmp_path / "loops.launch.xml").write_text(XML)
    with standing_in():
        description = frontend.description_in(str(tmp_path / "loops.launch.xml"))
        found = visited(description.visit(context), context)
        assert found == ["a/n1", "s/a0", "s/a1", "b/n9", "s/b0", "s/b1"]
        # What is at hand in a loop is not known after it.
        with pytest.raises(RuntimeError, match="'name' does not exist"):
            values.ForEachVar("name").perform(context)


def test_elements_that_have_no_end_are_told_in_our_words() -> None:
    with pytest.raises(SyntaxError, match="nested deeper than in any launch file"):
        root_of(b"<launch>" * 1_000 + b"</launch>" * 1_000, "a.launch.xml")


def test_yaml_that_has_a_fault_is_told_with_its_file() -> None:
    with pytest.raises(InputError, match=r"^b\.launch\.yaml:2:1: not valid YAML: "):
        root_of(b"launch:\n]", "b.launch.yaml")
