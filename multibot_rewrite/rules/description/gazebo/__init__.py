"""MB15 to MB17: values below ``<gazebo>``, parameters of plugins and of ros2_control hardware."""

from multibot_rewrite.rules.description.gazebo import elements, libraries, parameters

THEMES = (elements, parameters, libraries)
