"""MoveIt's YAML files: kinematics, joint limits, controllers, planners, sensors, servo."""
