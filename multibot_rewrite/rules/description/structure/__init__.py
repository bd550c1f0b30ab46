"""MB5: the kinematic tree and its joints."""

from multibot_rewrite.rules.description.structure import joints, limits, mimic, safety, starts, tree

THEMES = (tree, limits, joints, mimic, safety, starts)
