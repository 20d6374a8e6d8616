#!/bin/bash
# The myCobot 280 with its controllers in the pick-and-place world, and the page in the browser (or
# RViz, where it is installed). `arm launch` says when everything is ready; Ctrl-C ends all of it.
#
#   bash mycobot_280_gazebo.sh [name:=value ...]    as for mycobot.gazebo.launch.py

cleanup() {
    trap - SIGINT SIGTERM
    echo "Cleaning up..."
    kill -INT "$launched" 2>/dev/null
    wait "$launched"
    exit 0
}
trap cleanup SIGINT SIGTERM

# In a session of its own: Ctrl-C is for this script, which then ends the launch in order.
setsid arm launch mycobot_gazebo mycobot.gazebo.launch.py \
    load_controllers:=true \
    world_file:=pick_and_place_demo.world \
    use_rviz:=true \
    use_robot_state_pub:=true \
    use_sim_time:=true \
    x:=0.0 y:=0.0 z:=0.05 roll:=0.0 pitch:=0.0 yaw:=0.0 \
    "$@" &
launched=$!
wait "$launched"
