"""Gazebo's own namespaces: which are in use in the release, and which have no effect."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.model_namespaces import ignored_namespaces, used_namespaces
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.subject import Subject

_MODEL = """\
<gazebo>
  <model name="base"{}>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <topic>cmd_vel</topic>
    </plugin>
  </model>
</gazebo>
"""


@rule(
    "MB419",
    "ignored-model-namespace",
    WARNING,
    what="A model has a namespace that the release's Gazebo does not read.",
    why="sdformat reads <model namespace> and <include><namespace> from version 17 on. Fortress, "
    "Harmonic, Ionic and Jetty, which Humble to Lyrical have, print a warning and go on without it: "
    "the topics of all copies are the same.",
    fix="Set the topics of the plugins, or let urdf-postfix put each robot's name into them; for a "
    "Gazebo built from main say --distro rolling.",
    bad=_MODEL.format(' namespace="robot"'),
    good=_MODEL.format(""),
    line=2,
)
def ignored_model_namespace(subject: Subject) -> Iterator[Problem]:
    """Each of them."""
    return ignored_namespaces(subject.inventory, subject.tree)


@rule(
    "MB429",
    "model-namespace-in-use",
    WARNING,
    what="Plugins put the namespace of their model in front of their relative topics, in some builds "
    "of Gazebo.",
    why="For DiffDrive it is gz-sim's pull request 3878, which no release has. urdf-postfix gives each "
    "robot's name to the namespace and leaves relative topics, which would have it twice; a Gazebo "
    "without the change takes them as they are, and all robots have the same.",
    fix="Write absolute topics, which all builds take as they are; for the Gazebo of packages name "
    "another release than rolling with --distro.",
    bad=_MODEL.format(' namespace="robot"'),
    good=_MODEL.format(""),
    line=2,
    options={"distro": "rolling"},
)
def model_namespace_in_use(subject: Subject) -> Iterator[Problem]:
    """Each of them."""
    return used_namespaces(subject.inventory, subject.tree)
