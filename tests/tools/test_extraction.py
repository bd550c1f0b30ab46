# SPDX-License-Identifier: Apache-2.0
"""What a node declares is found in its sources, however it is written there."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite.producers.sources.records import Class, Place
from tools.interfaces.__main__ import main
from tools.interfaces.checkouts import read_folder
from tools.interfaces.nodes import facts_of
from tools.interfaces.scope import indexed
from tools.interfaces.table import COLUMNS, from_table, to_table

HEADER = """
class Robot : public Base<a_msgs::action::Go> {
  using Spin = a_msgs::srv::Spin;
  pluginlib::ClassLoader<core::Plug> loader_;
};
"""


def facts(folder: Path, body: str, more: str = "", header: str = HEADER) -> set[tuple[str, ...]]:
    """Role, name, type, way, parameter and condition of what class Robot declares."""
    checkout = folder / "repo@1.2.3"
    (checkout / "robot/src").mkdir(parents=True)
    (checkout / "robot/package.xml").write_text("<package/>")
    (checkout / "robot/src/robot.hpp").write_text(header + more)
    (checkout / "robot/src/robot.cpp").write_text(f"Robot::Robot(Node node) {{ {body} }}")
    index = indexed(read_folder(checkout))
    return {it[1:-1] for it in facts_of(index, "robot", index.classes["Robot"][0], frozenset())}


# Role, name, type, way, parameter and condition of a fact, and what class Robot does for it.
DECLARED = fixture_text("extraction_declared.txt")


@pytest.mark.sample(1)
@pytest.mark.parametrize(("fact", "body"), [*zip(*[iter(DECLARED.splitlines())] * 2, strict=True)])
def test_a_declaration(tmp_path: Path, fact: str, body: str) -> None:
    assert fact in {"|".join(it).rstrip("|") for it in facts(tmp_path, body)}


def test_what_it_makes_is_given_its_names(tmp_path: Path) -> None:
    more = """class Part { Part(Node node, std::string topic) : topic_(topic) {
      create_publisher<nav_msgs::msg::Path>(topic_ + "_raw", 1); } };"""
    found = facts(tmp_path, 'std::make_unique<Part>(node, "map");', more)
    assert found == {("publishes", "map_raw", "nav_msgs/msg/Path", "", "", "")}


def test_bases_and_their_types(tmp_path: Path) -> None:
    more = """template<typename T> class Base {
      void start() { a_ = std::make_shared<SimpleActionServer<T>>(node, "act"); } };"""
    assert facts(tmp_path, "", more) == {("serves", "act", "a_msgs/action/Go", "", "", "")}


def test_a_base_builds_the_name(tmp_path: Path) -> None:
    more = """template<typename T> class Base { std::string topic_;
      Base(std::string topic) : topic_("/" + topic) {}
      void start() { create_publisher<T>(topic_, 1); } };"""
    made = facts(
        tmp_path,
        "",
        more,
        "class Robot : public Base<a_msgs::msg::Scan> {\n"
        '  Robot(int i) : Base<a_msgs::msg::Scan>("scan") {} };\n',
    )
    assert made == {("publishes", "/scan", "a_msgs/msg/Scan", "", "", "")}


def test_a_filter_that_is_given_no_node_is_none(tmp_path: Path) -> None:
    assert facts(tmp_path, 'bus.subscribe("in");') == set()


def test_a_filter_has_the_type_of_its_member(tmp_path: Path) -> None:
    header = """class Robot { message_filters::Subscriber<a_msgs::msg::Scan> scan_;
      image_transport::SubscriberFilter image_; std::vector<a_msgs::msg::Scan> seen_; };"""
    body = """scan_.subscribe(this, "in"); image_.subscribe(this, "eye");
      seen_.subscribe(this, "none");"""
    assert facts(tmp_path, body, header=header) == {
        ("subscribes", "in", "a_msgs/msg/Scan", "", "", ""),
        ("subscribes", "eye", "sensor_msgs/msg/Image", "", "", ""),
        ("subscribes", "none", "", "", "", ""),
    }


def test_a_value_is_of_its_package(tmp_path: Path) -> None:
    """Another node's default of a parameter with the same name is not taken."""
    other = tmp_path / "repo@1.2.3" / "another"
    other.mkdir(parents=True)
    (other / "package.xml").write_text("<package/>")
    (other / "a.cpp").write_text('void f() { declare_parameter("t", "tilt_scan"); }')
    body = 'declare_parameter("t", "scan"); create_publisher<a::msg::B>(get_parameter("t"), 1);'
    assert facts(tmp_path, body) == {("publishes", "scan", "a/msg/B", "", "t", "")}


def test_a_constant_is_of_its_package(tmp_path: Path) -> None:
    other = tmp_path / "repo@1.2.3" / "another"
    other.mkdir(parents=True)
    (other / "package.xml").write_text("<package/>")
    (other / "a.cpp").write_text('const std::string TOPIC = "theirs";')
    (fact,) = facts(
        tmp_path, "create_publisher<a::msg::B>(TOPIC, 1);", 'const std::string TOPIC = "ours";'
    )
    assert fact[1] == "ours"


def test_a_local_name_stays_in_its_function(tmp_path: Path) -> None:
    more = """void main() { auto name = "mine"; }
      void create_it(int i) { create_publisher<a::msg::B>(name, 1); }"""
    assert facts(tmp_path, "create_it(1);", more) == {
        ("publishes", "<name>", "a/msg/B", "", "", "")
    }


def test_plugins_are_conditions(tmp_path: Path) -> None:
    more = """class Mine { void start() { create_publisher<nav_msgs::msg::Path>("p", 1); } };
      PLUGINLIB_EXPORT_CLASS(a::Mine, core::Plug)"""
    found = facts(tmp_path, "", more)
    assert found == {("publishes", "p", "nav_msgs/msg/Path", "", "", "plugin Mine")}


def test_a_message_is_no_class(tmp_path: Path) -> None:
    more = 'class Path { void f() { create_publisher<nav_msgs::msg::Path>("p", 1); } };'
    assert facts(tmp_path, "auto p = std::make_unique<nav_msgs::msg::Path>();", more) == set()


def test_python(tmp_path: Path) -> None:
    (tmp_path / "repo@1").mkdir()
    (tmp_path / "repo@1/robot.py").write_text(
        "from nav_msgs.msg import Path\n"
        "class Robot(Node):\n"
        "  def start(self, name):\n"
        "    self.declare_parameter('t', 'scan')\n"
        "    if self.good:\n"
        "      self.create_subscription(Path, self.get_parameter('t').value, self.f, 1)\n"
    )
    index = indexed(read_folder(tmp_path / "repo@1"))
    (fact,) = facts_of(index, "robot", index.classes["Robot"][0], frozenset())
    assert fact[1:-1] == ("subscribes", "scan", "nav_msgs/msg/Path", "", "t", "self.good")
    assert fact.place[:4] == ("repo", "1", "robot.py", 6)
    assert from_table(to_table([fact])) == (fact._replace(place=fact.place._replace(package="")),)


def test_python_helpers_of_the_spawner(tmp_path: Path) -> None:
    (tmp_path / "repo@1/robot").mkdir(parents=True)
    (tmp_path / "repo@1/robot/package.xml").write_text("<package/>")
    (tmp_path / "repo@1/robot/a.py").write_text(
        "from a_msgs.srv import Load\n"
        "def load(node, manager):\n"
        "  return service_caller(node, f'{manager}/load', Load, 1)\n"
    )
    index = indexed(read_folder(tmp_path / "repo@1"))
    free = Class("", (), (), {}, Place("repo", "1", "", 0, "robot"))
    (fact,) = facts_of(index, "spawner", free, frozenset())
    assert fact[1:4] == ("calls", "<manager>/load", "a_msgs/srv/Load")


def test_a_folder_that_is_no_checkout(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path)]) == 2
    assert "REPOSITORY@VERSION" in capsys.readouterr().err


def test_the_command_prints_nodes_and_differences(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "twist_mux@4"
    folder.mkdir()
    (folder / "a.cpp").write_text(
        'struct TwistMux { void f() { create_client<a::srv::B>("c"); } };'
    )
    assert main([str(folder)]) == 0
    head, row = capsys.readouterr().out.splitlines()
    assert head.split("\t") == list(COLUMNS)
    assert row.split("\t")[:9] == [
        *("twist_mux", "4", "a.cpp", "1", "twist_mux", "calls", "c", "a/srv/B", "")
    ]
    assert main([str(folder), "--compare", "jazzy"]) == 1
    rows = [row.split("\t")[:5] for row in capsys.readouterr().out.splitlines()]
    assert ["twist_mux", "calls", "c", "a/srv/B", "not in ours"] in rows


def test_new_nodes_of_a_package_are_seen(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "twist_mux@4"
    folder.mkdir()
    part = 'struct {} {{ void f() {{ create_client<a::srv::B>("c"); }} }};'
    (folder / "a.cpp").write_text(
        "\n".join(map(part.format, ("TwistMux", "Added", "Made", "Neither")))
        + "\nRCLCPP_COMPONENTS_REGISTER_NODE(twist_mux::Added)\n"
        + "int main() { auto a = std::make_shared<TwistMux>(); std::make_shared<Made>(); }"
        + "struct Silent {}; RCLCPP_COMPONENTS_REGISTER_NODE(twist_mux::Silent)\n"
    )
    main([str(folder), "--compare", "jazzy"])
    rows = [row.split("\t") for row in capsys.readouterr().out.splitlines()]
    new = {(row[0], row[5]) for row in rows if row[4] == "not in nodes.txt"}
    assert new == {("twist_mux/Added", "a.cpp:2"), ("twist_mux/Made", "a.cpp:3")}
