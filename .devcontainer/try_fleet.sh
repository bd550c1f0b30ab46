#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The README's fleet in Gazebo: started without a window, checked against its plan, and driven.
set -euo pipefail
rover=$PWD/examples/launch_tutorial/rover.urdf
cd "$(mktemp -d)"
multibot init "$rover" -n 2 -o rovers.yaml
multibot build rovers.yaml -o rovers/
# The lidar is rendered, so the simulator needs a screen.
xvfb-run -a ros2 launch rovers/fleet.launch.py headless:=true rviz:=false >launch.log 2>&1 &
launch=$!
trap 'kill -INT "$launch"; wait "$launch" || true; tail -n 50 launch.log' EXIT
timeout 120 ros2 topic echo --once /robot2/odom nav_msgs/msg/Odometry --field pose.pose.position
multibot check rovers/plan.yaml
timeout 10 ros2 topic pub -r 10 /robot1/cmd_vel geometry_msgs/msg/Twist '{linear: {x: 0.5}}' >/dev/null || [ $? = 124 ]
at() {
  timeout 60 ros2 topic echo --once "/$1/odom" nav_msgs/msg/Odometry --field pose.pose.position.x | head -n 1
}
echo "robot1 is at $(at robot1), robot2 at $(at robot2)"
python3 -c 'import sys; one, two = map(float, sys.argv[1:]); sys.exit(not (one > 1 and abs(two) < 0.1))' \
  "$(at robot1)" "$(at robot2)"
