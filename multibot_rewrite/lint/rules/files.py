"""MB1: what a file is, how it is encoded, and the shape of its XML."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import accumulate, islice

from lxml import etree

from multibot_rewrite.checks.audit import leftover_xacro, nearest, worlds
from multibot_rewrite.checks.robots import already_rewritten
from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.lint.elements import Elements
from multibot_rewrite.lint.numbers import numbers
from multibot_rewrite.lint.records import NOTE, Problem, Subject, rule
from multibot_rewrite.model import ERROR, WARNING, Edit, Finding
from multibot_rewrite.steps.renames import make_renames

BOM = b"\xef\xbb\xbf"
_DECLARED = lazy_compile(rb"<\?xml\s+version\s*=\s*[\"']([^\"']*)[\"']")
_ENCODED = lazy_compile(rb"<\?xml\s[^>]*?\sencoding\s*=\s*[\"']([^\"']*)[\"']")
_NAMESPACE = lazy_compile(rb"\s+xmlns:([\w.-]+)\s*=\s*(?:\"[^\"]*\"|'[^']*')")
_ROOT = lazy_compile(rb"<robot\b(?:[^>\"']|\"[^\"]*\"|'[^']*')*>")
_LOOKS = ["visual", "link", "robot"]
Look = tuple[tuple[float, ...] | str, str]


def _told(subject: Subject, kind: str) -> Iterator[Problem]:
    """The faults of the document's shape that belong to the rule of that name."""
    for it in subject.faults:
        if it.kind == kind:
            yield Problem(it.element, it.message, it.attribute, it.hint)


def _placed(subject: Subject, findings: Iterable[Finding]) -> Iterator[Problem]:
    """Findings that know a line and a column -> problems at the elements there."""
    source = subject.document.source
    elements = subject.document.elements
    lines = [0, *accumulate(len(line) for line in source.splitlines(keepends=True))]
    for it in findings:
        line = source[lines[it.line - 1] :].decode("utf-8", "replace")
        start = lines[it.line - 1] + len(line[: it.column - 1].encode())
        element = elements[bisect_left(subject.document.starts, start)]
        yield Problem(element, it.message, None, it.hint)


@rule(
    "MB101",
    "not-xml",
    ERROR,
    what="The file is not a robot description that can be read: broken XML, another encoding, "
    "DOCTYPE, empty, or another root element.",
    why="xacro, launch files and every other reader with a whole XML parser stop with an error. "
    "urdfdom's takes some of it, so half of the system may run without the other half.",
    fix="Mend the XML where the finding points; save the file as UTF-8.",
    bad='<robot name="r"><link name="a"></robot>',
    good='<robot name="r"><link name="a"/></robot>',
)
def not_xml(subject: Subject) -> Iterator[Problem]:
    """Found when the file is read: see ``failures``."""
    return iter(())


@rule(
    "MB102",
    "unreadable",
    ERROR,
    what="The file, or one that it includes, is not there or may not be read.",
    why="xacro and robot_state_publisher stop with an error, and the launch with them.",
    fix="Mend the path; where it has $(find PACKAGE), source the workspace with that package.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:include filename="nowhere.xacro"/><link name="a"/></robot>',
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/></robot>',
)
def unreadable(subject: Subject) -> Iterator[Problem]:
    """Found when the file is read: see ``failures``."""
    return iter(())


@rule(
    "MB103",
    "xacro-failed",
    ERROR,
    what="xacro cannot expand the file: an argument, property, macro or package is missing, or an "
    "expression is wrong.",
    why="There is no URDF: the Command substitution of the launch file fails and nothing starts.",
    fix="Give every <xacro:arg> a default, or the lint the arguments to expand with; for the rest "
    "see the finding.",
    bad='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<link name="$(arg side)_arm"/></robot>',
    good='<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:arg name="side" default="left"/><link name="$(arg side)_arm"/></robot>',
)
def xacro_failed(subject: Subject) -> Iterator[Problem]:
    """Found when the file is expanded: see ``failures``."""
    return iter(())


@rule(
    "MB105",
    "leftover-xacro",
    WARNING,
    what="A file that is not named .xacro holds xacro elements or ${...} and $(arg ...).",
    why="Who loads it as the URDF that its name promises gets no macros, and urdfdom refuses the "
    "joint, and with it the robot, where ${...} stands for a number.",
    fix="Name the file .urdf.xacro and load it through xacro, or write the expanded text.",
    bad='<link name="a"/><link name="${prefix}b"/>',
    good='<link name="a"/><link name="b"/>',
)
def leftover(subject: Subject) -> Iterator[Problem]:
    """The first one tells it all."""
    found = list(leftover_xacro(subject.inventory))
    return _placed(subject, found) if found else iter(())


@rule(
    "MB106",
    "already-rewritten",
    WARNING,
    what="The description is spelled for one of the robots already: every name that a rewrite "
    "spells has that robot's affix, or there is text that a rewrite inserted.",
    why="urdf-postfix refuses it: a second rewrite would make base_link/robot1/robot1. Given to "
    "several robots, all of them have the frames and topics of the one.",
    fix="Lint and rewrite the source; take the affix back with urdf-postfix --strip, or let "
    "exclude leave out what is generated.",
    bad='<robot name="r_robot1"><link name="base/robot1"/></robot>',
    good='<robot name="r"><link name="base"/></robot>',
    options={"robots": ("robot1", "robot2")},
)
def already(subject: Subject) -> Iterator[Problem]:
    """The first of the robots it is spelled for."""
    settings = subject.settings
    renames = make_renames(subject.inventory, settings.naming)
    found = already_rewritten(subject.inventory, renames, settings.robots, False)
    for it in islice(found, 1):
        yield Problem(subject.document.root, it.message, None, "lint the source it was made from")


@rule(
    "MB109",
    "sdf-world",
    ERROR,
    what="The file is an SDF world, which holds several models.",
    why="Which of the models is the robot, nobody can tell: its names cannot be checked or spelled "
    "for one robot.",
    fix="Keep the robot in a model.sdf of its own and include it in the world.",
    bad='<?xml version="1.0"?><sdf version="1.9"><world name="w"/></sdf>',
    good='<?xml version="1.0"?><sdf version="1.9"><model name="r"><link name="a"/></model></sdf>',
)
def sdf_world(subject: Subject) -> Iterator[Problem]:
    """Every world of the file."""
    return _placed(subject, worlds(subject.inventory)) if _is_sdf(subject) else iter(())


def _is_sdf(subject: Subject) -> bool:
    return subject.document.root.tag == "sdf"


@rule(
    "MB110",
    "misspelled-element",
    WARNING,
    what="An element is no part of URDF where it stands, and nearly has the name of one that is.",
    why="Every loader skips elements that it does not know: the link has no mass, the joint no "
    "limit, and nothing says so.",
    fix="Write the name that is meant.",
    bad='<link name="a"><inertail/></link>',
    good='<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link>',
)
def misspelled_element(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "misspelled-element")


@rule(
    "MB111",
    "ignored-element",
    NOTE,
    what="An element inside a link or joint that no reader of URDF knows.",
    why="It has no effect: <gravity>, <kinematic> or <pose> work in a <gazebo reference> block, "
    "where sdformat looks for them, and not here.",
    fix="Move it into <gazebo reference>, or delete it.",
    bad='<link name="a"><gravity>1</gravity></link>',
    good='<link name="a"/><gazebo reference="a"><gravity>1</gravity></gazebo>',
)
def ignored_element(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "ignored-element")


@rule(
    "MB112",
    "misplaced-element",
    WARNING,
    what="An element of URDF stands where nobody looks for it.",
    why="Loaders look for children by name in one place alone: an <origin> of a link or an "
    "<inertial> of the robot is left out without a word.",
    fix="Move it to where it belongs; the hint names the places.",
    bad='<link name="a"><mass value="1"/></link>',
    good='<link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
    'iyz="0" izz="1"/></inertial></link>',
)
def misplaced_element(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "misplaced-element")


@rule(
    "MB113",
    "misspelled-attribute",
    WARNING,
    what="An attribute is none of its element's, and nearly has the name of one that is absent.",
    why="Loaders ask for attributes by name and take the default where there is none: "
    "xzy='0 0 1' is an origin of 0 0 0.",
    fix="Write the name that is meant.",
    bad='<link name="a"><visual><origin xzy="0 0 1"/><geometry><sphere radius="1"/></geometry>'
    "</visual></link>",
    good='<link name="a"><visual><origin xyz="0 0 1"/><geometry><sphere radius="1"/></geometry>'
    "</visual></link>",
)
def misspelled_attribute(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "misspelled-attribute")


@rule(
    "MB114",
    "ignored-attribute",
    NOTE,
    what="An attribute that no reader of URDF knows.",
    why="It has no effect: loaders ask for the attributes they know and for no others.",
    fix="Delete it, or move it to where your own program reads it.",
    bad='<link name="a"><visual colour="red"><geometry><sphere radius="1"/></geometry></visual>'
    "</link>",
    good='<link name="a"><visual name="ball"><geometry><sphere radius="1"/></geometry></visual>'
    "</link>",
)
def ignored_attribute(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "ignored-attribute")


@rule(
    "MB115",
    "missing",
    ERROR,
    what="An attribute or child is missing without which its element cannot be read.",
    why="urdfdom refuses the whole file for the name of the robot or of a joint; of a link it drops "
    "every shape from the fault on; ros2_control's parser throws, and the controller manager has "
    "no hardware.",
    fix="Add what is missing.",
    bad='<link name="a"><visual><geometry><cylinder radius="1"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><cylinder radius="1" length="1"/></geometry></visual>'
    "</link>",
)
def missing(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "missing")


@rule(
    "MB116",
    "repeated-element",
    WARNING,
    what="An element comes twice, with different content, where loaders read one.",
    why="urdfdom takes the first and never looks at the others: what the second says does not "
    "happen. Other readers may take the last.",
    fix="Keep the one that is meant.",
    bad='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/><origin xyz="0 0 1"/><origin xyz="0 0 2"/></joint>',
    good='<link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
    '<child link="b"/><origin xyz="0 0 1"/></joint>',
)
def repeated_element(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "repeated-element")


@rule(
    "MB117",
    "unknown-component",
    ERROR,
    what="A child of <ros2_control> is no component: hardware, joint, sensor, gpio, transmission.",
    why='ros2_control\'s component parser throws "invalid tag name" for it, and the controller '
    "manager goes without any hardware.",
    fix="Write one of the components, or move a <param> into <hardware>.",
    bad='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    '<param name="port">1</param></ros2_control>',
    good='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin>'
    '<param name="port">1</param></hardware></ros2_control>',
)
def unknown_component(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "unknown-component")


@rule(
    "MB118",
    "stray-text",
    NOTE,
    what="Text stands where no reader of URDF expects any.",
    why="It has no effect. Mostly it is what an edit left: the end of a comment, a doubled '>', "
    "a remark without its comment marks.",
    fix="Delete it, or make it a comment.",
    bad='<link name="a"/>>',
    good='<link name="a"/><!-- a remark -->',
)
def stray_text(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "stray-text")


@rule(
    "MB120",
    "not-a-number",
    ERROR,
    what="A value that has to be a number is none: empty, with a unit, with a decimal comma.",
    why="urdfdom refuses the file if it is in a joint, and drops the rest of the link's shapes if "
    "it is in a link.",
    fix="Write plain numbers with a decimal point, separated by blanks, in metres, radians and "
    "kilograms.",
    bad='<link name="a"><visual><geometry><sphere radius="0,5"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><sphere radius="5e-1"/></geometry></visual></link>',
)
def not_a_number(subject: Subject) -> Iterator[Problem]:
    """Substitutions that are left over have their own rule."""
    return (it for it in _told(subject, "not-a-number") if "$" not in it.message)


@rule(
    "MB121",
    "wrong-count",
    ERROR,
    what="A value holds more or fewer numbers than it must: a scale of one number, an xyz of two.",
    why="urdfdom refuses the file if it is in a joint, and drops the rest of the link's shapes if "
    "it is in a link.",
    fix="Write all the numbers: three for xyz, rpy, size and scale, one for the rest.",
    bad='<link name="a"><visual><geometry><mesh filename="file:///a.stl" scale="0.001"/></geometry>'
    "</visual></link>",
    good='<link name="a"><visual><geometry><mesh filename="file:///a.stl" scale="1 1 1"/>'
    "</geometry></visual></link>",
)
def wrong_count(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "wrong-count")


@rule(
    "MB122",
    "not-finite",
    ERROR,
    what="A number is nan, inf, or too large for a double.",
    why="urdfdom's number reader knows neither nan nor inf: it refuses a joint's file, and drops "
    "the rest of a link's shapes. Readers that take it compute with nan from then on.",
    fix="Write a large finite number, or leave a limit out by type='continuous'.",
    bad='<link name="a"><visual><geometry><sphere radius="inf"/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><sphere radius="1e9"/></geometry></visual></link>',
)
def not_finite(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "not-finite")


@rule(
    "MB123",
    "blank-behind-number",
    ERROR,
    what="A lone number has a blank behind it, or a tab or line end follows a number in a value.",
    why="urdfdom splits at single blanks alone and wants a number to be all of its part: it reads "
    "'1 ' and a tab between numbers as no number, and refuses it.",
    fix="Delete the blank; write blanks between numbers.",
    bad='<link name="a"><visual><geometry><sphere radius="1 "/></geometry></visual></link>',
    good='<link name="a"><visual><geometry><box size="1  1 1 "/></geometry></visual></link>',
)
def blank_behind_number(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "blank-behind-number")


@rule(
    "MB124",
    "bad-choice",
    ERROR,
    what="A value is not one of those that the loader knows: the type of a ros2_control, or the "
    "version of the URDF.",
    why="Hardware of an unknown type is loaded by nobody, and ros2_control's resource manager does "
    "not say so; urdfdom refuses a file of another version than 1.0.",
    fix="Write one of the values in the message, in lower case.",
    bad='<ros2_control name="c" type="System"><hardware><plugin>p/P</plugin></hardware>'
    "</ros2_control>",
    good='<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin></hardware>'
    "</ros2_control>",
)
def bad_choice(subject: Subject) -> Iterator[Problem]:
    """Read by ``schema.read_faults``."""
    return _told(subject, "bad-choice")


@rule(
    "MB130",
    "bad-colour",
    WARNING,
    what="A colour is not four numbers from 0 to 1.",
    why="urdfdom cannot read it: of three numbers it makes black, and with one above 1 it says "
    "'malformed color' and the shape goes without its colour.",
    fix="Write red, green, blue and alpha from 0 to 1.",
    bad='<material name="m"><color rgba="255 0 0 1"/></material><link name="a"/>',
    good='<material name="m"><color rgba="1 0 0 1"/></material><link name="a"/>',
)
def bad_colour(subject: Subject) -> Iterator[Problem]:
    """Substitutions that are left over have their own rule."""
    return (it for it in _told(subject, "bad-colour") if "$" not in it.message)


@rule(
    "MB131",
    "undefined-material",
    WARNING,
    what="A visual names a material that neither the robot nor an earlier visual defines, or a "
    "material of the robot has neither colour nor texture.",
    why="urdfdom warns \"material 'm' undefined\" and leaves the visual without a material: "
    "viewers and Gazebo draw it in their default colour.",
    fix="Define it once as a child of <robot>, with a <color> or <texture>.",
    bad='<link name="a"><visual><geometry><sphere radius="1"/></geometry><material name="m"/>'
    "</visual></link>",
    good='<link name="a"><visual><geometry><sphere radius="1"/></geometry><material name="m"/>'
    '</visual></link><material name="m"><color rgba="1 0 0 1"/></material>',
)
def undefined_material(subject: Subject) -> Iterator[Problem]:
    """In the order of urdfdom: the robot's own materials first, then those of visuals."""
    tops = _materials(subject.elements)
    bare = [it for it in tops if not _defines(it)]
    misspelled = _misspelled(subject) if bare else set()
    for material in bare:
        if material not in misspelled:
            name = material.get("name", "")
            yield Problem(material, f"material {name!r} has neither colour nor texture", "name")
    defined = {it.get("name") for it in tops}
    for look in _looks(subject.elements):
        name = look.get("name", "")
        if name in defined or not name:
            continue
        if len(look) and _defines(look):
            defined.add(name)
            continue
        near = nearest(name, [it for it in defined if it])
        hint = f"did you mean {near!r}?" if near else ""
        yield Problem(look, f"material {name!r} is not defined", "name", hint)


def _materials(elements: Elements) -> list[etree._Element]:
    return elements.tops("material") if elements.root.tag == "robot" else []


@lru_cache(maxsize=1)
def _looks(elements: Elements) -> list[etree._Element]:
    """The named materials of visuals."""
    named = (it for it in elements.every("material") if it.get("name") is not None)
    return [it for it in named if [above.tag for above in it.iterancestors()] == _LOOKS]


def _misspelled(subject: Subject) -> set[etree._Element | None]:
    """Elements of which another rule says that they, or a child, are wrongly written."""
    elements = [it.element for it in subject.faults]
    return {*elements, *(it.getparent() for it in elements)}


def _defines(material: etree._Element) -> bool:
    return any(it.get("rgba") or it.get("filename") for it in material.iterchildren("*"))


@rule(
    "MB132",
    "material-differs",
    WARNING,
    what="A visual defines a material that is there already under that name, and differently.",
    why="urdfdom keeps the first definition of a name for the whole robot: the visual is drawn in "
    "the other colour, not in its own.",
    fix="Give the material a name of its own.",
    bad='<material name="m"><color rgba="1 0 0 1"/></material><link name="a"><visual><geometry>'
    '<sphere radius="1"/></geometry><material name="m"><color rgba="0 1 0 1"/></material></visual>'
    "</link>",
    good='<material name="m"><color rgba="1 0 0 1"/></material><link name="a"><visual><geometry>'
    '<sphere radius="1"/></geometry><material name="m"><color rgba="1.0 0 0 1"/></material>'
    "</visual></link>",
)
def material_differs(subject: Subject) -> Iterator[Problem]:
    """Each visual whose own definition does not count."""
    looks = [it for it in _looks(subject.elements) if len(it) and it.get("name") and _defines(it)]
    tops = _materials(subject.elements) if looks else []
    first = {it.get("name", ""): _look(it) for it in reversed(tops)}
    for material in looks:
        name, look = material.get("name", ""), _look(material)
        if first.setdefault(name, look) != look:
            hint = "the first definition of the name counts"
            message = f"material {name!r} has another colour or texture than its first definition"
            yield Problem(material, message, "name", hint)


def _look(material: etree._Element) -> Look:
    """The colour and the texture of a material."""
    parts = {it.tag: it for it in reversed(material)}
    color, texture = parts.get("color"), parts.get("texture")
    rgba = "" if color is None else color.get("rgba", "")
    colour = numbers(rgba)
    return rgba if colour is None else colour, "" if texture is None else texture.get(
        "filename", ""
    )


@rule(
    "MB140",
    "xml-declaration",
    WARNING,
    what="The XML declaration names a version other than 1.0, or an encoding other than UTF-8.",
    why="urdfdom and Gazebo read UTF-8 whatever it says; expat (xacro, Python launch files) "
    "refuses encodings of several bytes such as gb2312, and reads letters as the others do not.",
    fix='Write <?xml version="1.0" encoding="UTF-8"?>.',
    bad='<?xml version="1.0" encoding="ISO-8859-1"?><robot name="r"><link name="a"/></robot>',
    good='<?xml version="1.0" encoding="utf-8"?><robot name="r"><link name="a"/></robot>',
)
def xml_declaration(subject: Subject) -> Iterator[Problem]:
    """What is read here has nothing but ASCII where the encoding is another: both can be mended."""
    source = subject.document.source
    if subject.origins or b"<?xml" not in source[:8]:
        return
    for pattern, right, allowed in (
        (_DECLARED, b"1.0", (b"1.0",)),
        (_ENCODED, b"UTF-8", (b"utf-8", b"utf8", b"us-ascii", b"ascii")),
    ):
        found = pattern.match(source, source.index(b"<?xml"))
        if found and found[1].lower() not in allowed:
            said = found[1].decode("utf-8", "replace")
            edit = Edit(found.start(1), found.end(1), right, None)
            message = f"the XML declaration says {said!r}"
            yield Problem(subject.document.root, message, None, f"write {right.decode()}", (edit,))


@rule(
    "MB141",
    "byte-order-mark",
    NOTE,
    what="The file starts with a byte order mark.",
    why="UTF-8 needs none. XML readers skip it at the start of a file, and refuse it as text before "
    "the root where a script or template puts the description behind other text.",
    fix="Save the file as UTF-8 without it.",
    bad='\ufeff<robot name="r"><link name="a"/></robot>',
    good='<robot name="r"><link name="a"/></robot>',
)
def byte_order_mark(subject: Subject) -> Iterator[Problem]:
    """Three bytes that can go."""
    if subject.document.source.startswith(BOM):
        edit = Edit(0, len(BOM), b"", None)
        root = subject.document.root
        yield Problem(root, "the file starts with a byte order mark", None, "", (edit,))


@rule(
    "MB142",
    "unused-namespace",
    NOTE,
    what="The root element declares a namespace prefix that the file does not use.",
    why="It has no effect. A xacro prefix in a plain URDF makes readers look for macros that are "
    "not there.",
    fix="Delete the declaration.",
    bad='<robot name="r" xmlns:drake="http://drake.mit.edu"><link name="a"/></robot>',
    good='<robot name="r" xmlns:drake="http://drake.mit.edu"><drake:joint name="j"/></robot>',
)
def unused_namespace(subject: Subject) -> Iterator[Problem]:
    """Prefixes of the root that are written nowhere else in the file."""
    root, source = subject.document.root, subject.document.source
    if not root.nsmap or subject.origins:
        return
    start = subject.document.starts[0]
    tag = _ROOT.match(source, start)
    for found in _NAMESPACE.finditer(source, start, tag.end() if tag else start):
        prefix = found[1] + b":"
        # What is left of xacro in a plain URDF has a rule of its own, which the prefix belongs to.
        left = b"/xacro" in found[0] and (b"${" in source or b"$(" in source)
        if prefix not in source and not left:
            edit = Edit(found.start(), found.end(), b"", None)
            message = f"nothing in the file uses the prefix {found[1].decode()!r}"
            yield Problem(root, message, f"xmlns:{found[1].decode()}", "", (edit,))
