# SPDX-License-Identifier: Apache-2.0
"""Plans of a rewrite that are wrong, and the check of the proof that has to refuse each.

A fault puts something in the place of one function of the package; the text, the plan and the
pieces that follow from it agree with each other.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

from proof_faults import ROVER, SOURCES

from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.rewriters.insert import Insertion
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT
from multibot_rewrite.description.steps import plan as planning
from multibot_rewrite.description.steps.plan import LAST, Plan
from multibot_rewrite.description.steps.renames import RenameMap, make_renames

Wrong = Callable[[Any], Any]


class Fault(NamedTuple):
    """``function`` of ``module`` does what ``wrong`` makes of what it gives.

    Where ``instead``, ``wrong`` is called in its place.
    """

    about: str
    refused_by: str
    module: Any
    function: str
    wrong: Wrong
    source: str = "rover"
    layout: str = "both"
    instead: bool = False

    def planted(self) -> Callable[..., Any]:
        """Return the function with the fault in it."""
        right = getattr(self.module, self.function)
        return self.wrong if self.instead else lambda *given: self.wrong(right(*given))


# ---------------------------------------------------------------- plans


def behind(text: bytes, source: bytes = ROVER) -> int:
    """Return the offset right behind a text of the source."""
    assert text in source, f"the source holds no {text!r}"
    return source.index(text) + len(text)


def edits(change: Callable[[list[Edit]], list[Edit]]) -> Wrong:
    """Return a plan with other edits."""
    return lambda plan: plan._replace(edits=sorted(change(plan.edits), key=lambda it: it.start))


def at(text: bytes, change: Callable[[Edit], list[Edit]], source: str = "rover") -> Wrong:
    """Return a plan with other edits right behind a text of the source."""
    place = behind(text, SOURCES[source])
    return edits(
        lambda all_: [new for it in all_ for new in (change(it) if it.start == place else [it])]
    )


def more(text: bytes, before: bytes, after: bytes | None, source: str = "rover") -> Wrong:
    """Return a plan with one more edit right behind a text of the source."""
    place = behind(text, SOURCES[source])
    return edits(lambda all_: [*all_, Edit(place, place, before, after)])


def literal(edit: Edit) -> list[Edit]:
    """Return the robot's name as it is, in the place of a slot."""
    return [edit._replace(before=edit.before + b"robot1" + (edit.after or b""), after=None)]


def in_marker(plan: Plan) -> Plan:
    """Return a plan without the model's name, with one slot more in inserted text."""
    kept = [it for it in plan.edits if it.start != behind(b'<robot name="rover')]
    first = next(number for number, it in enumerate(kept) if b"multibot" in it.before)
    words, bracket, rest = (kept[first].after or b"").partition(b"(")
    end = kept[first].end
    kept[first : first + 1] = [
        kept[first]._replace(after=words + bracket),
        Edit(end, end, b"", rest),
    ]
    return plan._replace(edits=kept)


USE = b'<parent link="base'
NOTE = b'<note link="base'
RULE = b"</joint>\r"

EDITS = {
    "same_names": {
        "an edit too few": at(USE, lambda it: []),
        "an edit twice": at(USE, lambda it: [it, it]),
        "an edit one byte before": at(USE, lambda it: [shifted(it, -1)]),
        "an edit that takes a letter": at(USE, lambda it: [it._replace(start=it.start - 1)]),
        "an edit with its halves swapped": at(USE, lambda it: [Edit(it.start, it.end, b"", b"/")]),
        "an edit of another kind": at(USE, lambda it: [it._replace(before=b"_")]),
        "an edit without the robot's name": at(USE, lambda it: [it._replace(after=None)]),
        "an edit with another robot's name": at(
            USE, lambda it: [it._replace(before=b"/robot2", after=None)]
        ),
        "an edit that overlaps another": more(USE[:-1], b"a", None),
        "the slot of the model's name in a marker": in_marker,
        "no edits at all": edits(lambda all_: []),
        "the first edits": edits(lambda all_: all_[:9]),
    },
    "unreadable": {
        "an edit one byte further on": at(USE, lambda it: [shifted(it, 1)]),
        "an edit that takes a quote": at(USE, lambda it: [it._replace(end=it.end + 1)]),
        "all edits in another order": lambda plan: plan._replace(edits=plan.edits[::-1]),
    },
    "a_slot_each": {
        "an edit with the robot's name as it is": at(USE, literal),
        "an edit of a value that is no name": more(NOTE, b"/", b""),
        "an edit in a comment, with a slot": more(b"<!-- made", b" for ", b""),
    },
    "strips_to_source": {
        "an edit of a value that is no name, the robot's name as it is": more(
            NOTE, b"/robot1", None
        ),
        "an edit of a line end": edits(
            lambda all_: [*all_, Edit(behind(RULE) - 1, behind(RULE), b"", None)]
        ),
        "an edit of a comment": more(b"<!-- made", b" well", None),
    },
}


# Plans that only add: their texts are stripped value by value.
ADDED = (
    ("a blank added", more(b'<link name="base"', b" ", None, "model")),
    ("a word added to a value that is no name", more(b'type="fixed', b"_r", None, "model")),
)


def shifted(edit: Edit, by: int) -> Edit:
    return edit._replace(start=edit.start + by, end=edit.end + by)


# ---------------------------------------------------------------- rename maps


def unnamed(chosen: Callable[[str], bool]) -> Wrong:
    """Return a rename map without some names, by the value that they are."""

    def wrong(renames: RenameMap) -> RenameMap:
        values = [() if it and chosen(it[0].text) else it for it in renames.values]
        return renames._replace(values=values)

    return wrong


def once(text: str, nth: int) -> Wrong:
    """Return a rename map that misses the nth value with a name."""

    def wrong(renames: RenameMap) -> RenameMap:
        places = [at for at, it in enumerate(renames.values) if it and it[0].text == text]
        values = [() if at == places[nth] else it for at, it in enumerate(renames.values)]
        return renames._replace(values=values)

    return wrong


def respelled(text: str, before: str, after: str, at_: int | None = None) -> Wrong:
    """Return a rename map with another affix for a name, wherever it is."""

    def wrong(renames: RenameMap) -> RenameMap:
        values = []
        for value in renames.values:
            new = [
                it._replace(
                    affix=it.affix._replace(
                        before=before, after=after, at=it.affix.at if at_ is None else at_
                    )
                )
                if it.text == text
                else it
                for it in value
            ]
            values.append(tuple(new))
        return renames._replace(values=values)

    return wrong


RENAMES = {
    "same_names": {
        "a map without one use": once("wheel", 1),
        "a map without the last use": once("base", -1),
        "a map without one declaration": once("wheel", 0),
        "a map without a name": unnamed(lambda text: text == "wheel"),
        "a map without a joint": unnamed(lambda text: text == "axle"),
        "a map without the model": unnamed(lambda text: text == "rover"),
        "a map without a name that is escaped": unnamed(lambda text: "&" in text),
        "a map of nothing": unnamed(lambda _: True),
        "a name under another kind": respelled("wheel", "_", ""),
        "a name with the affix in front": respelled("wheel", "", "/", 0),
        "a name with the affix inside": respelled("wheel", "/", "", 2),
        "a name without a separator": respelled("axle", "", ""),
        "a namespace of another robot": respelled("/demo", "x", "/"),
    },
}


def named_otherwise(**words: Any) -> Callable[..., Any]:
    """Return a function that makes the rename map of another naming."""
    return lambda inventory, naming: make_renames(inventory, make_naming(**words))


NAMINGS = (
    ("the naming of another layout", named_otherwise(layout="postfix")),
    ("the naming of bare frames", named_otherwise(layout="tf-per-robot")),
    ("the other affix", named_otherwise(layout="both", affix="prefix")),
    ("other topics", named_otherwise(layout="both", topics="postfix")),
    ("another separator of links", named_otherwise(layout="both", separators={"link": "_"})),
    ("another separator of joints", named_otherwise(layout="both", separators={"joint": "/"})),
    ("a frame that is not shared", named_otherwise(layout="both", shared_frames=["base"])),
)


def written(old: bytes, new: bytes) -> Wrong:
    """Edits that write something else than was to be inserted."""
    return lambda found: [
        it._replace(
            before=it.before.replace(old, new), after=it.after and it.after.replace(old, new)
        )
        for it in found
    ]


WRITTEN = (
    ("an insertion that is written otherwise", "rover", written(b"odom/", b"odox/")),
    ("a rule that is written otherwise", "rover", written(b">/tf:=tf<", b">/tf:=tf_static<")),
    (
        "a filled element that is written otherwise",
        "empty",
        written(b"</namespace ", b"/x</namespace "),
    ),
)


# ---------------------------------------------------------------- insertions and collisions


def inserted(change: Callable[[Insertion], list[Insertion]], word: str) -> Wrong:
    """Other insertions, where the right one holds a word."""
    return lambda items: [new for it in items for new in (change(it) if word in it.xml else [it])]


def spelled(it: Insertion, old: str, new: str) -> list[Insertion]:
    assert old in it.xml
    return [it._replace(xml=it.xml.replace(old, new))]


ODOM, TF, SPACE = "odometry_frame", "/tf:=tf", "namespace"
INSERTIONS = {
    "nothing_to_add": {
        "an insertion forgotten": inserted(lambda it: [], ODOM),
        "a rule forgotten": inserted(lambda it: [], TF),
        "a namespace forgotten": inserted(lambda it: [], SPACE),
        "a rule for another topic": inserted(lambda it: spelled(it, "/tf:", "/tg:"), TF),
        "an insertion in another element": inserted(
            lambda it: spelled(it, "odometry_frame", "odom_frame"), ODOM
        ),
        "an insertion at another plugin": inserted(
            lambda it: [it._replace(parent=it.parent.getnext())], ODOM
        ),
    },
    "robots_own": {
        "an insertion without the robot's name": inserted(
            lambda it: spelled(it, f"/{ROBOT_SLOT}", ""), ODOM
        ),
        "an insertion without a separator": inserted(
            lambda it: spelled(it, f"/{ROBOT_SLOT}", ROBOT_SLOT), ODOM
        ),
        "an insertion for another robot": inserted(
            lambda it: spelled(it, ROBOT_SLOT, "robot2"), ODOM
        ),
        "an absolute rule": inserted(lambda it: spelled(it, ":=tf", ":=/tf"), TF),
        "a namespace of all robots": inserted(lambda it: spelled(it, ROBOT_SLOT, "fleet"), SPACE),
    },
    "a_slot_each": {
        "an insertion with the robot's name as it is": inserted(
            lambda it: spelled(it, ROBOT_SLOT, "robot1"), ODOM
        ),
        "an insertion with one more slot": inserted(
            lambda it: spelled(it, "<odometry_frame>", f"<!-- {ROBOT_SLOT} --><odometry_frame>"),
            ODOM,
        ),
    },
    "added_once": {
        "an insertion twice": inserted(lambda it: [it, it], ODOM),
        "an insertion of what is there": inserted(
            lambda it: [it, *spelled(it, "odometry_frame", "robot_base_frame")], ODOM
        ),
        "a rule twice": inserted(lambda it: [it, *spelled(it, "=tf", "=tf_static")], TF),
    },
}


def named(new: str) -> Wrong:
    """Collisions with a text in the place of the separator and slot, whatever stands for the robot."""
    return lambda found: [(it, re.sub(f"/[{ROBOT_SLOT}{LAST}]", new, text)) for it, text in found]


COLLISIONS = {
    "same_names": {
        "a collision forgotten": lambda found: found[1:],
        "all collisions forgotten": lambda found: [],
        "a collision with another number": lambda found: [
            (it, text.replace("_2", "_1")) for it, text in found
        ],
        "a collision without the robot": named(""),
        "collisions swapped": lambda found: [
            (found[0][0], found[1][1]),
            (found[1][0], found[0][1]),
        ],
    },
    "a_slot_each": {
        "a collision with the robot's name as it is": named("/robot1"),
    },
}

PLANS = [
    *(
        Fault(about, by, pipeline, "make_plan", wrong)
        for by, faults in EDITS.items()
        for about, wrong in faults.items()
    ),
    *(
        Fault(about, "strips_to_source", pipeline, "make_plan", wrong, "model")
        for about, wrong in ADDED
    ),
    *(
        Fault(about, by, planning, "make_renames", wrong)
        for by, faults in RENAMES.items()
        for about, wrong in faults.items()
    ),
    *(
        Fault(about, "same_names", planning, "make_renames", wrong, instead=True)
        for about, wrong in NAMINGS
    ),
    *(
        Fault(about, by, planning, "insertions", wrong)
        for by, faults in INSERTIONS.items()
        for about, wrong in faults.items()
    ),
    *(
        Fault(about, "as_decided", planning, "insertion_edits", wrong, source)
        for about, source, wrong in WRITTEN
    ),
    *(
        Fault(about, by, planning, "respell_collisions", wrong, "touch", "postfix")
        for by, faults in COLLISIONS.items()
        for about, wrong in faults.items()
    ),
]
