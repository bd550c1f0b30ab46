# SPDX-License-Identifier: Apache-2.0
"""Actions that start nodes -> records of these nodes.

Source: launch_ros jazzy, actions/node.py, actions/load_composable_nodes.py (humble to rolling keep what
is given to them under the same names).
"""

import os
import pathlib
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

import yaml

from multibot_rewrite.planning.start import Process, Switch
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros
from multibot_rewrite.producers.launch.failures import (
    failure,
    is_unset,
    missing_module,
    missing_package,
)
from multibot_rewrite.producers.launch.kept_paths import (
    GONE,
    LIMIT,
    NOT_KNOWN,
    is_made,
    kept_file,
    known_words,
    lasting,
    read_text,
    real_paths,
    source_of,
)
from multibot_rewrite.producers.launch.places import place_of
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.producers.launch.records import (
    IdleAction,
    LaunchedNode,
    LaunchInclude,
    LaunchNote,
    ParameterText,
    UnreadArgument,
)
from multibot_rewrite.producers.launch.spawners import (
    controller_files,
    params_text,
    ros2_run,
    ros_arguments,
)
from multibot_rewrite.producers.launch.unknown_modules import STOOD_FOR, UnknownError
from multibot_rewrite.system.records import Place

SIMULATOR, CLASSIC = "gzserver", "gazebo_ros"
# launch_ros says so of a text that is no YAML or value (jazzy, utilities/evaluate_parameters.py:82).
_FAILS = "try wrapping it"
# The commands of Gazebo, and the package that ROS starts it with.
_GAZEBO = {"gz": "ros_gz_sim", "ign": "ros_gz_sim", "gazebo": CLASSIC, "gzserver": CLASSIC}
SIMULATORS = ("ros_gz_sim", "ros_ign_gazebo", CLASSIC)

_FLAG = re.compile(r"--?([a-zA-Z]\w*)=(.*)|--?([a-zA-Z]\w*)", re.DOTALL)
_OF_PLUGIN = re.compile(r"<parameters>\s*([^<\s]+)\s*</parameters>")


# The launch configuration of what an argument keeps off.
OFF = "multibot_off"


class Visit(NamedTuple):
    """A visit of a launch description: its context, what was found, and what starts it.

    ``files`` are those that descriptions name. ``waiting`` has what an event or a timer starts,
    with its visit and locals, ``unread`` arguments without effect, ``before`` the environment
    before the launch, ``numbers`` each action that starts a process, with its place and what turns
    it off. ``idle`` is what conditions keep out, ``off`` what is kept of it; with ``every``
    conditions do not count. ``later`` says what starts it if not the launch itself: after
    ``events`` and ``delay`` seconds, at an ``event`` of a ``target``. ``switches`` turn it off,
    ``off_by`` turns it on."""

    context: Any
    nodes: list[LaunchedNode]
    notes: list[LaunchNote]
    files: dict[str, ParameterText]
    waiting: list[tuple[Any, Any, Mapping[str, Any]]]
    place: Place
    unread: list[UnreadArgument]
    includes: list[LaunchInclude]
    before: Mapping[str, str]
    numbers: dict[int, tuple[Any, int, tuple[Switch, ...]]]
    idle: list[IdleAction]
    off: list[LaunchedNode]
    every: bool = False
    later: str = ""
    events: int = 0
    delay: float = 0.0
    event: str = ""
    target: Any = None
    switches: tuple[Switch, ...] = ()
    off_by: str = ""

    @property
    def waits(self) -> Process:
        """What a process waits for; its switches are also those of what it waits for."""
        _, after, above = self.numbers.get(id(self.target), (None, -1, ()))
        switches = tuple(dict.fromkeys((*above, *self.switches)))
        return Process(delay=self.delay, event=self.event, after=after, switches=switches)

    def start(self, action: Any, it: LaunchedNode) -> None:
        """Keep what an action starts; what is off has no number by which others may wait for it."""
        number = -1 if self.off_by else len(self.nodes)
        self.numbers[id(action)] = (action, number, it.process.switches)
        self.nodes.append(it)

    def note(self, message: str, parameters: bool = False, file: str = "") -> None:
        """Keep what is not known here: nodes, or only ``parameters`` of one, as those of a ``file``."""
        self.notes.append(LaunchNote(self.place, message, parameters, file))

    def failed(
        self, error: BaseException, message: str = "", parameters: bool = False, fails: bool = False
    ) -> None:
        """Note an error, whose text ``message`` may replace."""
        missing = missing_package(error) or missing_module(error)
        known = (message or failure(error), parameters, "", fails, missing, is_unset(error))
        self.notes.append(LaunchNote(self.place, *known))


def is_wanted(action: Any, context: Any) -> bool:
    """Return whether the condition of an action holds."""
    condition = getattr(action, "condition", None)
    return condition is None or bool(condition.evaluate(context))


def text(value: Any, context: Any) -> str:
    """Return the value of substitutions, empty for none; raises UnknownError for missing packages."""
    if value is None:
        return ""
    utilities = of_launch("utilities")
    parts = utilities.normalize_to_list_of_substitutions(value)
    made = str(utilities.perform_substitutions(context, parts))
    if STOOD_FOR in made:
        raise UnknownError("unknown")
    return made


def _text(value: Any, here: Visit) -> str:
    """Return the value of substitutions; GONE for what is made from a missing package."""
    try:
        return text(value, here.context)
    except UnknownError:
        return GONE


def _known(value: Any, here: Visit, what: str = "") -> str:
    """Return the value of substitutions; empty for a missing package, which is noted as ``what``."""
    made = _text(value, here)
    if made != GONE:
        return made
    if what:
        _note_unknown(what, here)
    return ""


def _note_unknown(what: str, here: Visit) -> None:
    here.note(f"{what} {NOT_KNOWN}", parameters=True)


def node(action: Any, here: Visit) -> LaunchedNode:
    """Return the node of launch_ros's Node, or of an action that extends it."""
    package, executable = (
        text(_node_attribute(action, it), here.context) for it in ("package", "node_executable")
    )
    who = f"of {package} {executable}"
    given = ros_arguments([*_command_line(action, who, here)])
    rules = [*_remap_rules(_node_attribute(action, "remappings"), here), *given.rules]
    own = _node_attribute(action, "parameters") or ()
    files = (*given.files, *controller_files(f"{package}/{executable}", given.own))
    return LaunchedNode(
        package,
        executable,
        _known(_node_attribute(action, "node_name"), here, f"the name {who}") or given.name,
        given.namespace or _namespace(_node_attribute(action, "node_namespace"), who, here),
        tuple(rules),
        (
            *_description_in(package, given.own),
            *_all_parameters(own, here),
            *_parameter_texts(given.values, files, here),
        ),
        "",
        _kept_words(package, executable, given.own),
        here.later,
        place_of(action, here.place.file, (package, executable)),
        _environment(action, here),
        how_it_runs(action, here),
    )


def _environment(action: Any, here: Visit) -> tuple[tuple[str, str], ...]:
    """Return the variables that are set for a process, also by the launch before it."""
    given = getattr(action, "additional_env", None) or ()
    pairs = given.items() if isinstance(given, Mapping) else given
    own = {text(name, here.context): _text(it, here) for name, it in pairs}
    told = {name: _added(value, here.before.get(name, "")) for name, value in own.items()}
    for name in (it for it, value in own.items() if value == GONE):
        _note_unknown(f"a part of the environment variable {name}", here)
    return tuple({**changed_environment(here), **_variables_after(told)}.items())


def changed_environment(here: Visit) -> dict[str, str]:
    """Return the variables that the launch has set so far; ``:`` stands for their value before."""
    now = here.context.environment.items()
    changed = {name: value for name, value in now if here.before.get(name) != value}
    found = {name: _added(value, here.before.get(name, "")) for name, value in changed.items()}
    # Another machine may have some of it.
    lists = {it for it in found if it.endswith("PATH") and not here.before.get(it)}
    every = _variables_after(found).items()
    return {name: f":{value.strip(':')}" if name in lists else value for name, value in every}


def _variables_after(found: Mapping[str, str]) -> dict[str, str]:
    """Return variables that still have a value after the launch, or are meant to be empty."""
    return {name: value for name, value in found.items() if value.strip(":") or not value}


def _added(value: str, before: str) -> str:
    """Return a value of the environment, without what it was before."""
    if before and value.startswith(f"{before}{os.pathsep}"):
        return f":{_lasting_folders(value.removeprefix(before).strip(':'))}"
    if before and value.endswith(f"{os.pathsep}{before}"):
        return f"{_lasting_folders(value.removesuffix(before).strip(':'))}:"
    return _lasting_folders(value)


def _lasting_folders(text_: str) -> str:
    """Return a list of folders as they are after the launch, each once; another text unchanged."""
    real = real_paths(text_)
    if real == text_ and GONE not in real:
        return text_
    parts = dict.fromkeys(it for it in real.split(os.pathsep) if GONE not in it)
    return os.pathsep.join(parts) or os.pathsep


def how_it_runs(action: Any, here: Visit) -> Process:
    """Return how the process of an action runs. What only a run shows is assumed as usual."""
    told = getattr(action, "process_description", None) or action

    def own(name: str) -> Any:
        given = getattr(action, f"_ExecuteLocal__{name}", None)
        return getattr(action, name, None) if given is None else given

    prefix, cwd = (_known_text(getattr(told, it, None), here) for it in ("prefix", "cwd"))
    return here.waits._replace(
        prefix=prefix,
        respawn=_is_true(own("respawn"), here),
        respawn_delay=seconds(own("respawn_delay"), here),
        cwd=cwd,
        shell=_is_true(own("shell"), here),
    )


def _known_text(value: Any, here: Visit) -> str:
    """Return a text of an action; empty where only a run shows it."""
    with suppress(Exception):
        return str(value) if isinstance(value, bool | int | float) else _known(value, here)
    return ""


def _is_true(value: Any, here: Visit) -> bool:
    return _known_text(value, here).strip().lower() in ("true", "1")


def seconds(value: Any, here: Visit) -> float:
    """Return a time in seconds; 0 for none, and where only a run shows it."""
    try:
        return float(_known_text(value, here) or 0)
    except ValueError:
        return 0.0


def _description_in(package: str, words: tuple[str, ...]) -> Iterator[ParameterText]:
    """Yield the description in robot_state_publisher's first argument: used without a parameter."""
    if package == "robot_state_publisher" and words and os.path.isfile(words[0]):
        yield _text_of_values({"robot_description": read_text(words[0])})


def component(it: Any, container: str, here: Visit) -> LaunchedNode:
    """Return a component that is loaded into a container."""
    own = getattr(it, "parameters", None) or ()
    package, plugin = text(it.package, here.context), text(it.node_plugin, here.context)
    who = f"of {package} {plugin}"
    return LaunchedNode(
        package,
        plugin,
        _known(it.node_name, here, f"the name {who}"),
        _namespace(it.node_namespace, who, here),
        tuple(_remap_rules(it.remappings or (), here)),
        tuple(_all_parameters(own, here)),
        f"/{container.lstrip('/')}",
        (),
        here.later,
        place_of(it, here.place.file, (package, plugin)),
        process=Process(switches=here.switches),
    )


def process(action: Any, here: Visit) -> Iterator[LaunchedNode]:
    """Yield the node of a ``ros2 run`` line, a simulator, or else the command."""
    line = [*_known_arguments(getattr(action, "cmd", ()), "of a command", here)]
    words = [word for it in line for word in it.split()]
    run = ros2_run(words)
    if package := _GAZEBO.get(os.path.basename(words[0]) if words else ""):
        run = (package, SIMULATOR, (*words[1:],))
    more = here.later, here.place, _environment(action, here), how_it_runs(action, here)
    if run is None:
        program, *own = line or [""]
        if program:
            yield LaunchedNode("", program, "", "/", (), (), "", tuple(own), *more)
        return
    given = ros_arguments(run[2])
    values = tuple(_parameter_texts(given.values, given.files, here))
    namespace = given.namespace or "/"
    names = (run[0], run[1], given.name, namespace)
    kept = _kept_words(run[0], run[1], given.own)
    yield LaunchedNode(*names, given.rules, values, "", kept, *more)


def _kept_words(package: str, executable: str, words: Iterable[str]) -> tuple[str, ...]:
    """Return the words of a program; a spawner's ``--flag=value`` (gflags) as ``-flag``, ``value``."""
    kept: list[str] = []
    for word in words:
        flag = _FLAG.fullmatch(word) if f"{package}/{executable}" in programs().spawners else None
        kept.append(f"-{flag[1] or flag[3]}" if flag else word)
        if flag and flag[1]:
            kept.append(flag[2])
    return (*kept,)


def _node_attribute(action: Any, name: str) -> Any:
    """Return what launch_ros's Node was made with."""
    return getattr(action, f"_Node__{name}", None)


def _command_line(action: Any, who: str, here: Visit) -> Iterator[str]:
    own, ros = (
        [*_known_arguments(_node_attribute(action, it) or (), who, here)]
        for it in ("arguments", "ros_arguments")
    )
    yield from (*own, "--ros-args", *ros) if ros else own


def _known_arguments(given: Iterable[Any], who: str, here: Visit) -> Iterator[str]:
    """Yield the known arguments of a program; the flag before an unknown one is left out, too."""
    words, lost = known_words(lasting(_text(it, here) for it in given))
    for flag in lost:
        _note_unknown(f"an argument {who} {flag}".rstrip(), here)
    yield from words


def namespace_of(value: Any, context: Any) -> str:
    """Return a full namespace, below the namespaces that groups push."""
    utilities = of_launch_ros("utilities")
    above = context.launch_configurations.get("ros_namespace")
    own = text(value, context) if value is not None else None
    full = utilities.make_namespace_absolute(utilities.prefix_namespace(above, own))
    return full or "/"


def _namespace(value: Any, who: str, here: Visit) -> str:
    """Return the full namespace; the one around, with a note, if it is not known."""
    try:
        return namespace_of(value, here.context)
    except UnknownError:
        _note_unknown(f"the namespace {who}", here)
        return namespace_of(None, here.context)


def _remap_rules(rules: Iterable[Any], here: Visit) -> Iterator[tuple[str, str]]:
    yield from here.context.launch_configurations.get("ros_remaps", ())
    for pair in rules:
        old, new = (_text(it, here) for it in pair)
        if GONE in (old, new):
            _note_unknown(f"a remap rule of {new if old == GONE else old}", here)
        else:
            yield old, new


def _all_parameters(own: Iterable[Any], here: Visit) -> Iterator[ParameterText]:
    for it in here.context.launch_configurations.get("global_params", ()):
        if isinstance(it, tuple):
            yield from _parameter_texts([(str(it[0]), str(it[1]))], (), here)
        else:
            yield from _text_of_file(str(it), here)
    for given in own:
        yield from parameters(given, here)


def parameters(given: Any, here: Visit) -> Iterator[ParameterText]:
    """Yield a parameter file, or values, that an action gives its node."""
    # Values one by one: one that cannot be told does not hide the others.
    for it in given.items() if isinstance(given, dict) else ():
        yield from _evaluated_texts(dict([it]), here)
    if not isinstance(given, dict):
        yield from _evaluated_texts(given, here)


def _evaluated_texts(given: Any, here: Visit) -> Iterator[ParameterText]:
    """Yield a parameter file or values of an action, or note why they are not known."""
    try:
        (found,) = of_launch_ros("utilities").evaluate_parameters(here.context, [given])
        if not isinstance(found, dict | pathlib.PurePath):
            found = dict([found.evaluate(here.context)])
    except Exception as error:
        # A value may be the output of a program that is not started; other ones fail in a launch, too.
        if _FAILS in str(error) or is_unset(error):
            here.failed(error, parameters=True)
        elif isinstance(error, FileNotFoundError) and not missing_package(error):
            # Its folder may be a link to sources, which is gone when this is read.
            path = os.path.realpath(str(error.filename))
            here.note(_lost_message(path), parameters=True, file=path)
        elif not isinstance(given, dict):
            message = f"a parameter file is not known: {failure(error)}"
            here.failed(error, message, parameters=True)
        if isinstance(given, dict):
            names = (text(name, here.context) for name in given)
            yield from (_text_of_values({})._replace(untold=name) for name in names)
        return
    if isinstance(found, pathlib.PurePath):
        yield from _text_of_file(str(found), here)
    else:
        yield from _texts_of_values(found, here)


def _texts_of_values(found: dict[str, Any], here: Visit) -> Iterator[ParameterText]:
    """Yield values as a parameter file has them, and texts of files that the launch makes for them."""
    made = [path for path in found.values() if isinstance(path, str) and is_made(path)]
    for path in filter(os.path.isfile, made):
        yield from _text_of_file(path, here)
    # The launch file has written down what stands for a package that is not here, or what is gone.
    texts = {name: repr(value) for name, value in found.items()}
    gone = [
        name
        for name, it in texts.items()
        # A description may name what the launch makes: it is rewritten.
        if STOOD_FOR in it or (GONE in real_paths(it) and "<" not in it)
    ]
    yield from (_text_of_values({})._replace(untold=name) for name in gone)
    rest = {name: value for name, value in found.items() if name not in gone}
    if rest or not found:
        yield _text_of_values(rest)
    # Keep the parameter files that plugins in descriptions name: they may be gone when these are
    # read.
    for text_ in (it for it in rest.values() if isinstance(it, str)):
        for path in _OF_PLUGIN.findall(text_):
            here.files.update((path, it) for it in _text_of_file(path, here))


def _text_of_values(values: Any) -> ParameterText:
    """Return parameters as the text of a file for any node."""
    body = {"/**": {"ros__parameters": {name: _plain_value(it) for name, it in values.items()}}}
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return ParameterText("", yaml.dump(body, None, dumper, sort_keys=False))


def _plain_value(value: Any) -> Any:
    """Return a value with plain types, and paths that outlast the launch."""
    if isinstance(value, dict):
        return {str(name): _plain_value(it) for name, it in value.items()}
    if isinstance(value, str):
        # The folder with links to sources is gone when this is read.
        return kept_file(value) or value
    if isinstance(value, bytes) or not hasattr(value, "__iter__"):
        return value
    return [_plain_value(it) for it in value]


def _parameter_texts(
    values: Iterable[tuple[str, str]], files: Iterable[str], here: Visit
) -> Iterator[ParameterText]:
    for path in files:
        yield from _text_of_file(path, here)
    if written := params_text(values):
        yield ParameterText("", written)


def _text_of_file(path: str, here: Visit) -> Iterator[ParameterText]:
    """Yield a parameter file's text, or note why it is not known."""
    if not os.path.isfile(path) or os.path.getsize(path) > LIMIT:
        lost = missing_package(FileNotFoundError(path))
        said = f"of the package {lost!r}, which is not installed here, is not known"
        told = f"a parameter file {said}" if lost else _lost_message(path)
        here.note(told, parameters=True, file="" if lost else path)
        return
    source = source_of(path, here.context)
    with open(path, encoding="utf-8", errors="replace") as file:
        text_ = file.read()
    if STOOD_FOR in text_:
        here.note("a parameter file comes from a package that is not installed", parameters=True)
        return
    # A file that the launch makes is gone when this is read.
    yield ParameterText("" if is_made(path) else os.path.realpath(path), text_, kept_file(source))


def _lost_message(path: str) -> str:
    return f"the parameter file {path!r} is not there"
