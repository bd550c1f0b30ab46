# SPDX-License-Identifier: Apache-2.0
"""Names that are undeclared, ambiguous or declared twice, and arguments of a xacro that do harm."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING, XACRO, declare, locate
from multibot_rewrite.base.model import Claim, SiteRow
from multibot_rewrite.base.naming import CLOSED_KINDS, FRAME_KINDS, is_keyword
from multibot_rewrite.base.nearest import Guesses, did_you_mean_one_of
from multibot_rewrite.description.checks.problem import Problem, about
from multibot_rewrite.description.rewriters.forms import Declared, NamePart
from multibot_rewrite.description.rewriters.renaming import kind_of, must_be_declared, names_in
from multibot_rewrite.description.steps.collect import Inventory

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap

SRDF_ROBOT = "element srdf.robot"
# How the section and the path of a site of an SRDF begin -> its code, else by kind.
_SRDF_THEMES = (("@name", "MB802"), ("disable_", "MB807"), ("enable_", "MB807"))
_SRDF = {"link": "MB803", "joint": "MB804", "group": "MB805"}
_LINK, JOINT = "MB202", "MB211"


class Loose(NamedTuple):
    """A name in a claimed value that nothing declares."""

    claim: Claim
    part: NamePart


def doubtful(inventory: Inventory) -> list[Claim]:
    """Return the uses of names that are not declared literally as a link or joint."""
    declared = inventory.declared
    return [
        claim
        for claim in inventory.claims
        if claim.site.role == "uses"
        and claim.value not in declared.get(claim.site.whole_value_kind, ())
    ]


def loose_ends(
    claims: Iterable[Claim], declared: Declared, shared: Collection[str]
) -> Iterator[Loose]:
    """Yield uses of a link, joint, model or group that nothing declares."""
    for claim in claims:
        site = claim.site
        if not must_be_declared(site):
            continue
        if any(claim.value in declared.get(kind, ()) for kind in site.kinds):
            continue
        for part in names_in(claim, declared):
            is_known = part.text in shared or is_keyword(part.text)
            if not is_known and not kind_of(part, site.role, declared):
                yield Loose(claim, part)


def undeclared_names(loose: Iterable[Loose], declared: Declared) -> Iterator[Problem]:
    """Yield a problem for each undeclared name, with the code for its place."""
    guesses = Guesses()
    for claim, part in loose:
        site = claim.site
        known = (known for kind in part.kinds for known in declared.get(kind, ()))
        message = f"{where(claim)} names the {' or '.join(part.kinds)} {part.text!r}, "
        found = (kind for kind in sorted(CLOSED_KINDS) if part.text in declared.get(kind, ()))
        other = next(found, "")
        message += f"which is a {other}" if other else "which is not declared"
        code, hint = _undeclared_code(site, part), guesses.hint(part.text, known)
        # A description is rejected for such a name in a joint, and in most of ros2_control.
        of_system = site.section == "element ros2_control" and not site.path.startswith("hardware/")
        is_fatal = of_system or site.section == "element joint"
        mild = code in (_LINK, JOINT) and not is_fatal
        yield about(claim, code, message, hint)._replace(level=WARNING if mild else "")


def _undeclared_code(site: SiteRow, part: NamePart) -> str:
    if site.form in ("scoped", "member"):
        return "MB219"  # Only SDF has scopes.
    other = JOINT if part.kinds[0] == "joint" else _LINK
    if site.section != SRDF_ROBOT:
        return other
    themes = (code for path, code in _SRDF_THEMES if site.path.startswith(path))
    return next(themes, _SRDF.get(part.kinds[0], other))


def where(claim: Claim) -> str:
    """Return a claim's place, ``<tag>`` or ``tag@attribute``; a parameter's with its name."""
    tag = str(claim.element.tag)
    if claim.attribute:
        return f"{tag}@{claim.attribute}"
    name = claim.element.get("name") if tag == "param" else None
    return f'<{tag} name="{name}">' if name else f"<{tag}>"


def repeated(inventory: Inventory) -> Iterator[tuple[Claim, Claim]]:
    """Yield (repeated, first) declarations of a name in a model; <gazebo> may repeat a joint (PR2)."""
    seen: dict[tuple[int, _Element | None, str], Claim] = {}
    for claim in inventory.claims:
        if claim.site.role != "declares" or claim.site.kinds[0] not in CLOSED_KINDS:
            continue
        key = id(claim.site), _scope(claim.element), claim.value.strip()
        first = seen.setdefault(key, claim)
        if first is not claim:
            yield claim, first


def duplicates(inventory: Inventory) -> Iterator[Problem]:
    """Yield repeated declarations as problems."""
    source = inventory.document.source
    for claim, first in repeated(inventory):
        code = "MB806" if claim.site.section == SRDF_ROBOT else "MB201"
        line, _ = locate(source, first.start)
        message = f"{claim.site.kinds[0]} {claim.value!r} is declared twice, first at line {line}"
        yield about(claim, code, message, "rename one")


def _scope(element: _Element) -> _Element | None:
    """Return the model that a declaration is in: names of nested SDF models are their own."""
    parent = element.getparent()
    if parent is not None and parent.tag == "robot":
        return parent
    return next(element.iterancestors("model", "robot"), None)


def ambiguous(inventory: Inventory) -> Iterator[Problem]:
    """Yield each ``<gazebo reference>`` to a link and a joint of one name: the link is taken."""
    links, joints = inventory.declared["link"], inventory.declared["joint"]
    # Few robots have such a pair, so few look at every claim.
    both = links.keys() & joints.keys()
    for claim in inventory.claims if both else ():
        if claim.site.kinds == ("link", "joint") and claim.value in both:
            message = f"{claim.value!r} is both a link and a joint"
            hint = "rename one: SDF refuses such a pair, a rewrite takes it for the link"
            yield about(claim, "MB203", message, hint)


SEPARATORS = "/_-."
UNREAD = "MB144"
# More names are not listed where none is like the one that is given.
_LISTED = 10

ARGUMENT_MISSES_REFERENCE = declare(
    "MB143",
    "argument-misses-reference",
    WARNING,
    formats=("rewrite", XACRO),
    options={"xacro_args": {"prefix": "{robot}_"}},
)


def missed_by_arguments(
    inventory: Inventory, renames: "RenameMap", plain: Mapping[tuple[str, str], str], robot: str
) -> Iterator[Problem]:
    """Yield frames of which arguments rename only the frame or only its link.

    ``plain`` maps (kind, text) without the arguments to the text that ``robot`` has with them."""
    links = inventory.declared["link"]
    pairs = zip(inventory.claims, inventory.names, strict=True) if robot else ()
    for claim, names in pairs:
        for name in names:
            text = name.text.removeprefix("/")
            if name.kind not in FRAME_KINDS or text in links:
                continue
            if plain.get(("link", text)) in links:
                yield _missed_reference(claim, text, plain["link", text])
            # A frame with the argument, named after a link without it.
            bare = text.replace(robot, "").strip(SEPARATORS)
            if (name.kind, name.text) in renames.naming.own and bare in links:
                link = renames.spelled(robot, "link", bare)
                if link != text:
                    yield _missed_reference(claim, text, link)


def _missed_reference(claim: Claim, frame: str, link: str) -> Problem:
    message = f"frame {frame!r} is the link {link!r}: the xacro's argument reaches only one of them"
    hint = "write the argument at both, or do not give it"
    return about(claim, ARGUMENT_MISSES_REFERENCE.code, message, hint)


def unread_arguments(
    root: _Element, unread: Iterable[str], known: Sequence[str]
) -> Iterator[Problem]:
    """Yield given arguments that no file of a xacro knows; ``known`` are those that it knows."""
    for name in unread:
        message = f"argument {name!r} is given, and no file of this xacro declares or reads it"
        more = ", ..." if len(known) > _LISTED else ""
        listed = f"its arguments are {', '.join(known[:_LISTED])}{more}" if known else "it has none"
        yield Problem(root, message, None, did_you_mean_one_of(name, known) or listed, (), UNREAD)
