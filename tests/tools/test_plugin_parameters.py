# SPDX-License-Identifier: Apache-2.0
"""Parameters of plugins and elements of SDF as their sources have them; sources are written here."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.description.rewriters.plugin_definitions import Definitions
from tools.interfaces import plugin_files, sdf_elements
from tools.interfaces.__main__ import main
from tools.interfaces.hardware_parameters import read_hardware
from tools.interfaces.plugin_parameters import Parameter, parameters_of

HEAD = "void Drive::Configure(const std::shared_ptr<const sdf::Element> &_sdf) {\n"


def read(line: str, before: str = "") -> list[Parameter]:
    """Return what a function of a plugin reads."""
    return list(parameters_of([("Drive.cc", f"{before}{HEAD}{line}\n}}\n")]))


@pytest.mark.parametrize(
    ("line", "name", "type_", "default"),
    [
        ('r = _sdf->Get<double>("radius", 0.2).first;', "radius", "number", "0.2"),
        ('r = _sdf->Get<double>("radius", this->r).first;', "radius", "number", ""),
        ('if (_sdf->HasElement("on")) { on = _sdf->Get<bool>("on"); }', "on", "boolean", ""),
        ('n = _sdf->GetElement("number")->Get<int>();', "number", "integer", ""),
        ('auto e = _sdf->FindElement("joint"); j = e->Get<std::string>();', "joint", "text", ""),
        ('for (auto e = _sdf->GetElement("d"); e; ) { v[0] = e->Get<double>(); }', "d", "number", ""),
        ('o = _sdf->Get<math::Vector3d>("offset");', "offset", "vector", ""),
        ('o = _sdf->Get<ignition::math::Vector3d>("offset");', "offset", "vector", ""),
        ('ros->getParameter<double>(r, "radius", 0.15);', "radius", "number", "0.15"),
        ('ros->getParameterBoolean(on, "on", true);', "on", "boolean", "true"),
        ('ns = GetRobotNamespace(_parent, _sdf, "Laser");', "robotNamespace", "text", ""),
        ('readLimit(_sdf, "limit", limit);', "limit", "any", ""),
        ('fill<double>(_sdf, "limit", limit);', "limit", "number", ""),
        ('double r = 0; _sdf->GetElement("rate")->GetValue()->Get(r);', "rate", "number", ""),
        ('_sdf->GetElement("rate")->GetValue()->Get(other);', "rate", "any", ""),
        ('ns = _sdf->GetElement("ns")->GetValue()->GetAsString();', "ns", "text", ""),
        ('for (auto name : names) _sdf->HasElement(name);', "*", "any", ""),
        ('joint(names[i], _sdf);', "*", "any", ""),
        ("t = _sdf->Get<double>(temperature);", "temperature", "number", ""),
    ],
)  # fmt: skip
def test_a_parameter_of_a_plugin(line: str, name: str, type_: str, default: str) -> None:
    (found,) = read(line, 'const std::string temperature = "temperature";\n')
    assert (found.name, found.type, found.default) == (name, type_, default)
    assert (found.path, found.line) == ("Drive.cc", 3)


LOOP = 'for (auto e = _sdf->GetElement("w"); e; e = e->GetNextElement("w")) { %s }'


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ('auto j = _sdf->GetElement("a"); x = j->Get<int>("b");', ["a", "a/b"]),
        ('x = _sdf->GetElement("a")->GetElement("b")->Get<int>("c");', ["a", "a/b", "a/b/c"]),
        (LOOP % 'x = e->Get<int>("b");', ["w", "w/b"]),
        (LOOP.replace(" e", " elem") % 'readLimit(elem, "b", x);', ["w", "w/*", "w/b"]),
        (LOOP % 'x = e->Get<int>("b"); noise.Load(e);', ["w", "w/*", "w/b"]),
        (LOOP % 'x = e->Get<int>("b"); c = e->GetFirstElement();', ["w", "w/*", "w/b"]),
        (LOOP % 'x = e->Get<int>("b"); this->Own(e);', ["w", "w/b"]),
        ('auto x = _sdf->Get<int>("a"); use(x);', ["a"]),
        (LOOP % "noise.Load(e);", ["w"]),
    ],
)
def test_what_is_read_of_a_block_is_below_it(line: str, names: list[str]) -> None:
    own = "void Drive::Own(Element e) {}\n"
    assert [it.name for it in read(line, own)] == names


def test_a_name_that_a_function_is_given_is_seen_where_it_is_called() -> None:
    own = "double fill(E _sdf, S name) { return _sdf->Get<double>(name); }\n"
    assert [it.name for it in read('fill(_sdf, "a");', own)] == ["a"]


def test_what_is_in_a_parameter_without_a_known_name_is_nowhere() -> None:
    line = 'auto e = _sdf->GetElement(name); x = e->Get<int>("a");'
    assert [it.name for it in read(f"for (auto name : names) {{ {line} }}")] == ["*", "a"]


HELPERS = """\
template <typename T>
class Model_ {
  void Load(sdf::ElementPtr _sdf, const std::string& prefix = "") {
    Read(_sdf, prefix + "Noise");
  }
};
typedef Model_<double> Model;
typedef Model_<math::Vector3d> Model3;
"""
TIMER = """\
class Timer {
  virtual void Load(W world, sdf::ElementPtr _sdf, const std::string& _prefix = "update") {
    double rate = 0.0;
    _sdf->GetElement(_prefix + "Rate")->GetValue()->Get(rate);
  }
};
"""


def made_of(folders: list[Path]) -> str:
    """Return what is printed where nothing is known yet."""
    return plugin_files.new_values(folders, Definitions({}, ""))


def test_helpers_read_by_a_prefix(tmp_path: Path) -> None:
    folder = tmp_path / "acme+gps@main"
    headers = folder / "include/acme"
    headers.mkdir(parents=True)
    (headers / "model.h").write_text(HELPERS)
    (headers / "timer.h").write_text(TIMER)
    (headers / "gps.h").write_text(
        "#include <acme/model.h>\n#include <acme/timer.h>\nModel3 speed;\nModel height;\nTimer timer;\n"
    )
    (folder / "CMakeLists.txt").write_text("add_library(gps gps.cpp)\n")
    (folder / "gps.cpp").write_text(
        "#include <acme/gps.h>\nvoid Gps::Load(M m, sdf::ElementPtr _sdf) {\n"
        '  speed.Load(_sdf, "speed"); height.Load(node, _sdf); timer.Load(world, _sdf);\n}\n'
    )
    rows = made_of([folder]).rstrip().splitlines()[-3:]
    assert rows == [
        "noise value number read=include/acme/model.h:4",
        "speedNoise value vector read=include/acme/model.h:4",
        "updateRate value number read=include/acme/timer.h:4",
    ]


def test_a_library_for_each_word_of_a_list(tmp_path: Path) -> None:
    folder = tmp_path / "acme+classic@main"
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(
        "set (plugins\n  Wing\n)\nset (plugins ${plugins}\n  Tail\n)\n"
        "foreach (src ${plugins})\n  add_library(${src} SHARED ${src}.cc)\nendforeach ()\n"
    )
    for name in ("Wing", "Tail"):
        (folder / f"{name}.cc").write_text("void Load(M m) {}\n")
    heads = [it for it in made_of([folder]).splitlines() if it.startswith("[")]
    assert heads == ["[values Tail]", "[values Wing]"]


def test_variables_are_those_of_their_function() -> None:
    before = 'void f(E _sdf) { auto e = _sdf->GetElement("a"); }\n'
    assert [it.name for it in read('e->Get<int>("b");', before)] == ["a", "b"]


def test_what_plugins_share_is_a_section_that_they_name(tmp_path: Path) -> None:
    folder = checkout(tmp_path, "ros2", 'gazebo_ros::Node::Get(_sdf); _sdf->Get<int>("x");')
    home = folder / "gazebo_ros/src"
    home.mkdir(parents=True)
    (home / "node.cpp").write_text(
        'N Node::Get(E sdf) { sdf = sdf->GetElement("ros"); sdf->HasElement("namespace"); }\n'
    )
    (home / "qos.cpp").write_text("")
    made = made_of([folder])
    assert "[block ros]\nread: acme/gz ros2 gazebo_ros/src\nros value any read=node.cpp:1\n" in made
    assert "src/systems/drive\nwith: ros\nx value integer read=Drive.cc:2\n" in made


def test_a_library_of_a_catkin_package_is_of_ros_1(tmp_path: Path) -> None:
    folder = tmp_path / "acme+gazebo@noetic"
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text("catkin_package()\nadd_library(drive drive.cpp)\n")
    (folder / "drive.cpp").write_text(
        'void Drive::Load ( physics::ModelPtr m, sdf::ElementPtr _sdf ) { _sdf->Get<int>("x"); }'
    )
    assert (
        made_of([folder])
        .rstrip()
        .endswith(
            "[values drive]\nread: acme/gazebo noetic .\nros: 1\nx value integer read=drive.cpp:1"
        )
    )


@pytest.mark.parametrize(
    "line",
    [
        'gzmsg << name("radius");',
        'Advertise("topic");',
        'auto x = map.find("y");',
        'Get<double>("a b");',
    ],
)
def test_what_is_no_parameter(line: str) -> None:
    assert read(line) == []


@pytest.mark.parametrize(
    ("line", "required"),
    [
        ('if (!_sdf->HasElement("joint")) { gzerr << "no joint"; return; }', True),
        ('if (_sdf->HasElement("joint")) { j(); } else { gzerr << "no"; return; }', True),
        ('if (!_sdf->HasElement("joint")) { return; }', False),
        ('if (!_sdf->HasElement("joint")) { gzwarn << "none"; }', False),
        ('if (steers) { if (!_sdf->HasElement("joint")) { gzerr << "no"; return; } }', False),
    ],
)
def test_what_is_required(line: str, required: bool) -> None:
    assert [it.required for it in read(line)] == [required]


def test_the_words_of_a_parameter() -> None:
    line = 'auto way = _sdf->Get<std::string>("way"); if (way == "cw") {} else if (way == "ccw") {}'
    assert read(line)[0].words == ("cw", "ccw")


def test_two_types_are_none() -> None:
    assert read('a = _sdf->Get<double>("x"); b = _sdf->Get<bool>("x");')[0].type == "any"


def checkout(home: Path, tag: str, code: str) -> Path:
    folder = home / f"acme+gz@{tag}"
    system = folder / "src/systems/drive"
    system.mkdir(parents=True)
    (system / "CMakeLists.txt").write_text("gz_add_system(drive\n  SOURCES\n    Drive.cc\n)\n")
    alias = 'GZ_ADD_PLUGIN(Drive, System)\nGZ_ADD_PLUGIN_ALIAS(Drive, "gz::sim::systems::Drive")\n'
    (system / "Drive.cc").write_text(f"{HEAD}{code}\n}}\n{alias}")
    return folder


def test_a_row_has_the_newest_tag_and_the_releases_that_read_it(tmp_path: Path) -> None:
    old = checkout(
        tmp_path, "ignition-gazebo6_6.1.0", 'a(_sdf->Get<int>("old"), _sdf->Get<int>("both"));'
    )
    new = checkout(
        tmp_path, "gz-sim8_8.1.0", 'a(_sdf->Get<int>("both"),\n  _sdf->Get<int>("new"));'
    )
    *_, head, read_in, both, later, older = made_of([old, new]).rstrip().splitlines()
    assert head == "[values gz-sim-drive-system gz::sim::systems::Drive]"
    assert read_in == "read: acme/gz gz-sim8_8.1.0 src/systems/drive"
    assert both == "both value integer read=Drive.cc:2"
    assert later == "new value integer read=Drive.cc:3 releases=jazzy"
    assert older == "old value integer read=Drive.cc:2@ignition-gazebo6_6.1.0 releases=humble"


def test_what_the_definitions_has_is_not_printed(tmp_path: Path) -> None:
    folder = checkout(tmp_path, "gz-sim8_8.1.0", '_sdf->Get<int>("x");\n_sdf->Get<double>("y");')
    known = made_of([folder]).replace("y value number", "y value integer")
    (row,) = plugin_files.new_values([folder], Definitions({"a.vocab": known}, "")).splitlines()[4:]
    assert row == "y value number read=Drive.cc:3"


def test_what_some_tags_need_is_not_required(tmp_path: Path) -> None:
    asked = 'if (!_sdf->HasElement("x")) { gzerr << "no"; return; }'
    needs = checkout(tmp_path / "a", "gz-sim8_8.1.0", asked)
    reads = checkout(tmp_path / "b", "gz-sim9_9.1.0", '_sdf->Get<int>("x");')
    again = checkout(tmp_path / "c", "gz-sim9_9.2.0", asked)
    assert made_of([needs, reads]).rstrip().endswith("x value integer read=Drive.cc:2")
    assert made_of([needs, again]).rstrip().endswith("x value any read=Drive.cc:2 required=yes")


def test_hardware_and_what_it_needs(tmp_path: Path) -> None:
    package = tmp_path / "arm"
    package.mkdir()
    (package / "package.xml").write_text("<package/>")
    (package / "plugins.xml").write_text(
        '<library path="arm"><class name="arm/Arm" type="arm::Arm" '
        'base_class_type="hardware_interface::SystemInterface"/></library>'
    )
    (package / "arm.cpp").write_text(
        "CallbackReturn Arm::on_init(const HardwareInfo & info) {\n"
        '  ip_ = info_.hardware_parameters.at("robot_ip");\n'
        '  port_ = std::stoi(info_.hardware_parameters["port"]);\n'
        '  if (info_.hardware_parameters.count("fake")) '
        '{ fake_ = info_.hardware_parameters.at("fake") == "true"; }\n}\n'
    )
    ((name, where, parameters),) = read_hardware(tmp_path)
    assert (name, where) == ("arm/Arm", "arm")
    found = {it.name: (it.type, it.line, it.required) for it in parameters}
    assert found == {
        "robot_ip": ("any", 2, True),
        "port": ("integer", 3, False),
        "fake": ("boolean", 4, False),
    }


SDF_FILES = {
    "model": '<element name="model" required="*"><attribute name="name" type="string" required="1"/>\n'
    '<include filename="link.sdf" required="*"/></element>',
    "link": '<element name="link" required="*">\n<element name="mass" type="double" default="1.0" '
    'min="0" required="0"><description/></element></element>',
    "joint": '<element name="joint" required="*"/>',
}


def sdformat(home: Path) -> Path:
    folder = home / "sdformat@14.0.0"
    for version in ("1.4", "1.5"):
        (folder / "sdf" / version).mkdir(parents=True)
        for name, text in SDF_FILES.items():
            old = text.replace(' min="0"', "") if version == "1.4" else text
            (folder / "sdf" / version / f"{name}.sdf").write_text(old)
    (folder / "src").mkdir()
    for path, *_ in sdf_elements.WORDS.values():
        (folder / path).write_text('if (type == "imu") {}\n')
    (folder / sdf_elements.CONVERTER).write_text(
        'else if (strcmp(childElem->Name(), "mu1") == 0) { sdf->mu1 = std::stod(x); }\n'
    )
    return folder


def test_elements_of_sdf_by_version(tmp_path: Path) -> None:
    text = sdf_elements.to_schema(sdformat(tmp_path))
    assert "@name string 1 required\nlink - 2 >link\n" in text
    assert "mass double 2 1.4-1.4 =1.0\nmass double 2 1.5-1.5 0.. =1.0\n" in text
    assert "[words sensor/@type] src/Sensor.cc\nimu 1\n" in text
    assert text.endswith("[urdf] src/parser_urdf.cc\nmu1 double 1\n")


@pytest.mark.parametrize("option", ["--sdf", "--plugins"])
def test_what_is_no_checkout_is_an_error(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([option, str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith(f"interfaces: {tmp_path}: not a")


def test_the_command_prints_both(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--sdf", str(sdformat(tmp_path))]) == 0
    assert main(["--plugins", str(checkout(tmp_path, "gz-sim8_8.1.0", ""))]) == 0
    assert "[values gz-sim-drive-system" in capsys.readouterr().out
