"""The page of nodes and stacks, printed by ``python -m multibot_rewrite.knowledge.stacks``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.controller_ways import CONTROLLER_WAYS, ControllerWay
from multibot_rewrite.knowledge.node_library import NodeLibrary, Stack
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts

HEAD = """\
# Nodes and stacks

The topics, services and actions of known nodes, and the stacks of nodes that are started together.
Generated from `nodes/*.yaml` and `stacks.yaml` of `multibot_rewrite/knowledge/` by
`python -m multibot_rewrite.knowledge.stacks > docs/stacks.md`.

Select a stack, or a single node, with `--stack`. Every robot runs robot_state_publisher besides;
the stack `no_robot_state_publisher` leaves it out, for robots whose tf comes from something else.
Names are those in the nodes' code: `scan` is resolved in the namespace, `/tf` is absolute, `~/odom`
is below the node's name. A name in `<>` is made at run time, so no remap rule can be written before
it is known: a stack sets it under `names`. *Only if* is the condition under which the node has the
name. *Remapped to* is the name after the remap rules of the usual launch files. *In* names the
only releases that have it: `kilted+` is Kilted and later, `<=jazzy` Jazzy and earlier,
`jazzy 1.3.9+` is Jazzy from that version of the package on.

Add your own nodes and stacks in a file of the same shape, for example:

```yaml
nodes:
  gripper_driver:
    package: acme_gripper
    with: [diagnostics]
    publishes:
      joint_states: sensor_msgs/msg/JointState
      /gripper/image: {type: sensor_msgs/msg/Image, transport: true, when: it has a camera}
    serves:
      ~/close: std_srvs/srv/Trigger
stacks:
  cell:
    about: An arm with our gripper
    include: [robot_state, moveit]
    nodes:
      - gripper_driver
      - {node: static_transform_publisher, as: table_to_base}
      - {node: twist_mux, names: {<topics.*.topic>: [nav_vel, pad_vel]}, remaps: {cmd_vel_out: cmd_vel}}
```

A driver that sends tf says so: `frames` are its parameters that hold frames, with their defaults,
`sends` the transforms, parent to child, by these parameters. Then the start pose of a robot is that of
its odometry frame, and no second parent of its base; `rehearse` and `check` know who sends what.

```yaml
nodes:
  base_driver:
    package: acme_base
    with: [tf_broadcaster]
    publishes:
      odom: nav_msgs/msg/Odometry
    frames: {odom_frame: odom, base_frame: base_link}
    sends: {odom_frame: base_frame}
```
"""
REACH = """\

## Names that no remap rule reaches

| node | what | why |
|---|---|---|
"""
HELPER = "a helper node uses it: only a rule for the whole process reaches it"

PLACES = """
## Where a rule stands

rcl applies a rule only where the node has it. `multibot remap`, `build` and the launch helpers write
each rule where its node takes it in the release (`--distro`), `rehearse` gives it in the same way, and
MR105 names rules that do not arrive.

| node | takes rules from | written as |
|---|---|---|
| in a process of its own | its process | `--ros-args -r`, `remappings=` of Node |
| in another one's process, as costmaps are | that process | `local_costmap:/tf:=tf` |
| in a container (`container` of a stack) | its LoadNode request | `remappings=` of ComposableNode |
| helper node, as of a tf listener | its process | rules of the process or container |
| of a plugin in the description | the plugin's tag | `<ros><remapping>` |
| controller of ros2_control | see below | `SPAWNERS`, `robot.spawner()`, `commands.md` |

Nav2's code sets the name of a costmap (`local_costmap`) and puts it below the namespace of its server;
no rule changes that. So in layout postfix these servers are in their robot's namespace and keep their
names (`/robot1/controller_server`, `/robot1/local_costmap/local_costmap`); their topics are renamed as
all others. If the code of your own node sets its name, give it `apart: true`, and its maker, too.

A costmap of a component has the rules of the component from Nav2 1.5 on, those of the container before.
On Humble gz_ros2_control starts ROS with the rules of the first robot's plugin, and all its nodes in
that Gazebo have them; later only nodes without rules of their own.
`multibot rehearse --without-rules-at spawner` shows what happens where one place is forgotten.

| releases | a controller's rules are given to | rules that it gets besides | source |
|---|---|---|---|
"""


def page(library: NodeLibrary) -> str:
    """The whole page as Markdown."""
    parts = [HEAD, PLACES, *(_controllers(it) for it in CONTROLLER_WAYS), "\n## Stacks\n"]
    parts += [_stack(name, stack) for name, stack in library.stacks.items()]
    nodes = sorted(library.nodes.values(), key=lambda it: it.name.lower())
    parts.append(REACH)
    parts += [row for node in nodes for row in _reach(node)]
    parts.append("\n## Nodes\n")
    parts += [_node(node, library) for node in nodes]
    parts.append("\n## Parts\n\nGroups of names that many nodes have.\n")
    parts += [f"\n### {name}\n{_table(found)}" for name, found in library.parts.items()]
    return "".join(parts)


def _controllers(way: ControllerWay) -> str:
    given = "its spawner, `--controller-ros-args`" if way.spawner else "its manager's process"
    handed = "all of its process" if way.process_wide else "none"
    handed = "those of its manager, with a warning" if way.forwarded else handed
    return f"| {way.releases} | {given} | {handed} | {way.source} |\n"


def _stack(name: str, stack: Stack) -> str:
    lines = [f"\n### {name}\n\n{stack.about}.\n\n"]
    within = f", in the container `{stack.container}`" if stack.container else ""
    lines += [f"- all nodes of {other}{within}\n" for other in stack.include]
    lines += [f"- {_member(node)}\n" for node in stack.nodes]
    return "".join(lines)


def _member(node: NodeFacts) -> str:
    notes = [f"`{e.name}` remapped to `{e.remapped}`" for e in node.endpoints if e.remapped]
    notes += [f"only if: {node.when}"] * bool(node.when) + ["for all robots"] * node.shared
    notes += _in(node.releases)
    return f"`{node.name}`" + (f": {', '.join(dict.fromkeys(notes))}" if notes else "")


def _reach(node: NodeFacts) -> Iterator[str]:
    """The rows of names that no rule reaches."""
    for text in node.fixed:
        yield _row([f"`{node.name}`", "", _plain(text)])
    for frame in node.frames:
        why = "; ".join((f"a frame: parameter `{frame.parameter}`", *_in(frame.releases)))
        yield _row([f"`{node.name}`", f"`{frame.default}`", why])
    for endpoint in node.endpoints:
        if endpoint.fixed or endpoint.helper:
            why = _plain(endpoint.fixed or HELPER)
            yield _row([f"`{node.name}`", f"{endpoint.kind} `{endpoint.name}`", why])


def _node(node: NodeFacts, library: NodeLibrary) -> str:
    facts = [f"package {node.package}"] * bool(node.package)
    facts += [f"in the process of {node.host}"] * bool(node.host)
    facts += ["keeps its name, in its robot's namespace, in every layout"] * node.apart
    facts += (
        ["one for all robots"] * node.shared + _in(node.releases) + [node.note] * bool(node.note)
    )
    facts += [f"source: {it}" for it in node.source]
    # A part is listed by name; its own table has the rest.
    parts = {name: found for name, found in library.parts.items() if {*found} <= {*node.endpoints}}
    facts += [f"with {', '.join(parts)}"] * bool(parts)
    folded = {endpoint for found in parts.values() for endpoint in found}
    own = [endpoint for endpoint in node.endpoints if endpoint not in folded]
    return f"\n### {node.name}\n\n{_plain('; '.join(facts))}\n{_table(own) if own else ''}"


def _table(endpoints: Iterable[Endpoint]) -> str:
    rows = [_row(_cells(endpoint)) for endpoint in endpoints]
    return (
        f"\n| | name | type | set by | only if | note |\n|---|---|---|---|---|---|\n{''.join(rows)}"
    )


def _cells(endpoint: Endpoint) -> list[str]:
    types = " or ".join(filter(None, (endpoint.type, *endpoint.also)))
    notes = [endpoint.note] * bool(endpoint.note) + ["image_transport"] * endpoint.transport
    notes += [f"remapped to {endpoint.remapped}"] * bool(endpoint.remapped)
    notes = [*_in(endpoint.releases), *notes, *(f"source: {it}" for it in endpoint.source)]
    parameter = f"`{endpoint.parameter}`" if endpoint.parameter else ""
    name = f"{endpoint.role} {endpoint.kind}", f"`{endpoint.name}`"
    return [*name, types, parameter, _plain(endpoint.when), _plain("; ".join(notes))]


def _in(releases: str) -> list[str]:
    """The only releases that have it, as a list of one; empty for all."""
    return [f"in {releases}"] * bool(releases)


def _row(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _plain(text: str) -> str:
    """Text outside of code: Markdown takes ``<x>`` for HTML."""
    return text.replace("<", "\\<")
