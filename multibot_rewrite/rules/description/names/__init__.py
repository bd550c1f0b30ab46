"""MB3: how names are written."""

from multibot_rewrite.rules.description.names import links_and_joints, ros_names, targets

THEMES = (links_and_joints, ros_names, targets)
