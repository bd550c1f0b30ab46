"""Frames that start with a slash."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.companions.names.by_kind import is_plain
from multibot_rewrite.companions.params.name_sites import NameSite
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.params.values import ParamsJob, is_stripped
from multibot_rewrite.companions.yaml_text import found_at
from multibot_rewrite.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.findings.rule import declare

SLASH = declare(
    "MF128",
    "frame-with-slash",
    WARNING,
    what="A parameter names a frame with a slash at its start. It is a note where the node takes the "
    "slash off in this release; then it is written without it.",
    why="tf2 sends the frame without the slash and refuses to look up one that has it (Invalid "
    'argument "/odom" passed to lookupTransform): nobody finds the transform. Some nodes took the '
    "slash off up to Kilted and no longer do.",
    fix="Remove the slash.",
    bad="""\
diff_drive_controller:
  ros__parameters:
    odom_frame_id: /odom
""",
    good="""\
diff_drive_controller:
  ros__parameters:
    odom_frame_id: odom
""",
    line=3,
    formats=("params",),
)


def slash_findings(job: ParamsJob, section: ParamSection, site: NameSite) -> Iterator[Finding]:
    """The finding about a frame's slash, if any."""
    if site.kind != "frame" or site.at >= 0 or not site.value.startswith("/"):
        return
    if site.param is None or not is_plain(site.value):
        return
    message = f"frame {site.value!r} starts with a slash, which tf2 refuses"
    hint = f"write {site.value.lstrip('/')}"
    if not is_stripped(job, section, site):
        yield found_at(job.document, site.scalar, SLASH, message, hint)
        return
    message = f"frame {site.value!r} is written without its slash, which the node takes off"
    yield found_at(job.document, site.scalar, SLASH, message, hint)._replace(level=NOTE)
