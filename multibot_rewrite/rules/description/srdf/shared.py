# SPDX-License-Identifier: Apache-2.0
"""What rules about an SRDF share: what srdfdom reads, and the robot of the examples."""

from __future__ import annotations

from functools import partial

from multibot_rewrite.base.findings.rule import SRDF, rule

SHOWN = 5
# The robot of the examples.
URDF = """<robot name="r"><link name="a"><collision/></link><link name="b"><collision/></link>
<link name="c"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint></robot>"""
BESIDE = {"r.urdf": URDF}
# A complete SRDF for it.
ARM = '<group name="arm"><joint name="j"/></group>\n'
STATE = ARM + '<group_state name="home" group="arm">{}</group_state>\n'
VIRTUAL = '<virtual_joint name="v" type="{}" parent_frame="world" child_link="{}"/>'
APART = '<disable_collisions link1="a" link2="b" reason="Adjacent"/>\n'
# A rule about an SRDF: its examples have the URDF above beside them.
srdf_rule = partial(rule, formats=(SRDF,), beside=BESIDE)
