# SPDX-License-Identifier: Apache-2.0
"""Parameters as YAML files, C++ and Python have them; files are written here, not taken from others."""

from __future__ import annotations

import pytest
from paths import fixture_text

from multibot_rewrite.producers.sources.cpp import read_cpp
from multibot_rewrite.producers.sources.records import Place
from multibot_rewrite.rules.files.parameter_files import file_parameters
from tools.interfaces.declared_parameters import cpp_parameters, python_parameters, shared_constants

PLACE = Place("acme/nav", "1.0.0", "nav/src/nav.cpp")


def in_cpp(line: str, header: str = "", before: str = "") -> list[tuple[str, str, str, str]]:
    """Path, type, default and how, of the parameters of a method."""
    text = f"{before}\nvoid Nav::start() {{ {line} }}"
    shared = shared_constants(read_cpp(header, PLACE).values)
    found = cpp_parameters(read_cpp(text, PLACE), "nav", shared)
    return [(it.path, it.type, it.default, it.how) for it in found]


@pytest.mark.parametrize(
    ("line", "path", "type_", "default"),
    [
        ('declare_parameter("odom_frame", "odom");', "odom_frame", "string", "odom"),
        ('this->declare_parameter("odom_frame", std::string("odom"));', "odom_frame", "string", "odom"),
        ('declare_parameter("f", std::string{"odom"});', "f", "string", "odom"),
        ('node->declare_parameter("f", rclcpp::ParameterValue("odom"));', "f", "string", "odom"),
        ('node->declare_parameter("f", rclcpp::ParameterValue(true));', "f", "bool", "true"),
        ('declare_parameter<std::string>("f", "");', "f", "string", '""'),
        ('declare_parameter("rate", 10.0);', "rate", "double", "10.0"),
        ('declare_parameter("rate", 10);', "rate", "int", "10"),
        ('declare_parameter("f", rclcpp::PARAMETER_STRING_ARRAY);', "f", "string_array", ""),
        ('declare_parameter("f", rclcpp::ParameterType::PARAMETER_STRING);', "f", "string", ""),
        ('nav2_util::declare_parameter_if_not_declared(node, name + ".topic", '
         'rclcpp::ParameterValue("scan"));', "<id>.topic", "string", "scan"),
        ('node->declare_or_get_parameter(name_ + "." + "frame", std::string("odom"));',
         "<id>.frame", "string", "odom"),
        ('declareParameter("m", rclcpp::ParameterValue("map"));', "<id>.m", "string", "map"),
        ('declareParameter(source + "." + "topic", rclcpp::ParameterValue(source));',
         "<id>.<id>.topic", "", ""),
        ('add_parameter("b", rclcpp::ParameterValue(std::string("b")), "note");', "b", "string", "b"),
        ('auto_declare<std::vector<std::string>>("joints", {});', "joints", "string_array", ""),
        ('getParam(x_, "layer_name", std::string("a"));', "<id>.layer_name", "string", "a"),
        ('f::Base<a::B>::getParam(std::string("window"), w_);', "<id>.window", "", ""),
        ('node->get_parameter_or("frame", frame_, std::string("a"));', "frame", "string", "a"),
    ],
)  # fmt: skip
def test_a_declared_parameter(line: str, path: str, type_: str, default: str) -> None:
    assert in_cpp(line) == [(path, type_, default, "declared")]


def test_a_variable_with_one_value_is_a_default() -> None:
    assert in_cpp('frame_ = "odom"; declare_parameter("f", frame_);')[0][2] == "odom"
    assert in_cpp('frame_ = "a"; frame_ = "b"; declare_parameter("f", frame_);')[0][2] == ""


@pytest.mark.parametrize(
    ("line", "type_"),
    [
        ('double t = 30.0; declare_parameter("t", t);', "double"),
        ('bool t = true; if (!has_parameter("t")) declare_parameter("t", t);', "bool"),
        ('declare_parameter("t", t_); t_ = get_parameter("t").as_int();', "int"),
        # It may be an int for a double.
        ('double t = 30; declare_parameter("t", t);', ""),
        ('auto t = 1.0; t = false; declare_parameter("t", t);', ""),
    ],
)
def test_the_type_of_a_default_that_is_a_variable(line: str, type_: str) -> None:
    assert [it[1] for it in in_cpp(line) if it[3] == "declared"] == [type_]


def test_a_part_of_a_name_may_be_a_variable() -> None:
    text = 'std::string above = "zone"; declare_parameter(above + ".frame", "a");'
    assert in_cpp(text)[0][0] == "zone.frame"


def test_constants_of_a_package_are_shared() -> None:
    header = 'constexpr char PARAM_PORT[] = "port"; const char* name = "other";'
    assert in_cpp("declare_parameter(PARAM_PORT, 8765);", header)[0][:3] == ("port", "int", "8765")
    assert in_cpp("declare_parameter(name, 8765);", header) == []


def test_what_is_only_asked_for_is_read() -> None:
    assert in_cpp('node->get_parameter(ns + ".image_topic", topic_);') == [
        ("<id>.image_topic", "", "", "read")
    ]


@pytest.mark.parametrize(
    "line",
    [
        'create_publisher<A>("odom", 10);',
        "declare_parameter(name, 1.0);",
        'RCLCPP_INFO(logger, "declare_parameter");',
        '// declare_parameter("a", "b");',
    ],
)
def test_what_is_no_parameter(line: str) -> None:
    assert in_cpp(line) == []


def test_an_owner_is_the_class_and_a_line_its_place() -> None:
    text = '\n\nclass Nav { void start() { declare_parameter("f", "odom"); } };'
    (found,) = cpp_parameters(read_cpp(text, PLACE), "nav", {})
    assert (found.package, found.owner, found.place.line) == ("nav", "Nav", 3)


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("self.declare_parameter('port', 9090)", ("port", "int", "9090")),
        ("node.declare_parameter(name='topics_glob', value='')", ("topics_glob", "string", '""')),
        ("self.declare_parameter('f', value=['a', 'b'])", ("f", "array", "[a, b]")),
        ("self.declare_parameter(prefix + '.frame', 'odom')", ("<id>.frame", "string", "odom")),
        ("self.declare_parameter(f'{name}.frame', 'odom')", ("<id>.frame", "string", "odom")),
        ("self.declare_parameters('', [('a_frame', 'odom')])", ("a_frame", "string", "odom")),
        ("self.declare_ros_parameter('rate', 10, note)", ("rate", "int", "10")),
        ("self.declare_parameter('f', compute())", ("f", "", "")),
    ],
)
def test_a_parameter_in_python(line: str, found: tuple[str, str, str]) -> None:
    text = f"class Bridge(Node):\n    def __init__(self):\n        {line}\n"
    (fact,) = python_parameters(text, PLACE._replace(path="a/bridge.py"), "bridge")
    assert (fact.path, fact.type, fact.default) == found
    assert (fact.owner, fact.place.line) == ("Bridge", 3)


def test_parameters_of_a_table_in_python() -> None:
    text = (
        "ROWS = (('port', int, 9090), ('url', str, '/'))\n"
        "for name, _, default in ROWS:\n    self.declare_parameter(name, default)\n"
    )
    found = {it.path: (it.type, it.default) for it in python_parameters(text, PLACE, "bridge")}
    assert found == {"port": ("int", "9090"), "url": ("string", "/")}


def test_python_2_has_no_parameters() -> None:
    assert list(python_parameters("print 'a'", PLACE, "old")) == []


LIBRARY = fixture_text("parameter_sources_library.yaml")


def test_the_parameters_of_a_library() -> None:
    found = {it.path: it for it in file_parameters(LIBRARY)}
    assert list(found) == ["odom_frame_id", "wheels", "gains.<wheels>.p", "limit", "empty"]
    assert found["odom_frame_id"][2:] == ("string", "odom", "", "read_only", 3)
    assert found["wheels"].default == "[]"
    assert found["wheels"].bounds == "size_lt([5]) unique()"
    assert found["gains.<wheels>.p"].bounds == "gt_eq([0.0])"
    assert found["limit"].default == ""
    assert found["empty"].default == '""'
    assert {it.owner for it in found.values()} == {"drive"}


@pytest.mark.parametrize(
    "text",
    [
        "amcl:\n  ros__parameters:\n    alpha1: 0.2\n",
        "controller_manager:\n  ros__parameters:\n    arm: {type: a/B}\n",
        "- node: {pkg: a, exec: b}\n",
        "{{ jinja }}: [",
        "",
    ],
)
def test_other_yaml_has_no_parameters(text: str) -> None:
    assert file_parameters(text) == ()
