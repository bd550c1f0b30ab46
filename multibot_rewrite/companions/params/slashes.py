"""Frames that start with a slash, or have white space in them."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.companions.names.by_kind import is_filled, is_plain
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

WHITE_SPACE = declare(
    "MF134",
    "frame-with-white-space",
    WARNING,
    what="A parameter names a frame with white space in it.",
    why="tf takes any text for a frame, so 'odom ' is another one than 'odom', which nothing sends. It "
    "is not rewritten: nodes of all robots that send it send one frame.",
    fix="Remove the white space.",
    bad="""\
amcl:
  ros__parameters:
    odom_frame_id: "odom "
""",
    good="""\
amcl:
  ros__parameters:
    odom_frame_id: odom
""",
    line=3,
    formats=("params",),
)


def slash_findings(job: ParamsJob, section: ParamSection, site: NameSite) -> Iterator[Finding]:
    """The finding about a frame's slash or white space, if any."""
    if site.kind != "frame" or site.param is None:
        return
    block = site.scalar.style in ("|", ">")
    if not block and is_filled(site.value) and site.value.split() != [site.value]:
        message = (
            f"frame {site.value!r} has white space in it: it is another one, and not rewritten"
        )
        hint = f"write {'_'.join(site.value.split())}"
        yield found_at(job.document, site.scalar, WHITE_SPACE, message, hint)
        return
    if site.at >= 0 or not site.value.startswith("/") or not is_plain(site.value):
        return
    message = f"frame {site.value!r} starts with a slash, which tf2 refuses"
    hint = f"write {site.value.lstrip('/')}"
    if not is_stripped(job, section, site):
        yield found_at(job.document, site.scalar, SLASH, message, hint)
        return
    message = f"frame {site.value!r} is written without its slash, which the node takes off"
    yield found_at(job.document, site.scalar, SLASH, message, hint)._replace(level=NOTE)
