"""What a user writes with pymoveit2; prints the name of each step and its result, a line each."""

import sys
import time

from pymoveit2 import MoveIt2State, connect

# rclpy notes a goal only after it has sent it, and throws away what is answered before that: on a
# busy machine the thread of pymoveit2's executor could come between.
sys.setswitchinterval(1.0)

BOX = {"size": (0.05, 0.05, 0.05), "position": [0.3, 0.3, 0.3], "quat_xyzw": [0.0, 0.0, 0.0, 1.0]}

with connect(timeout_sec=60.0) as session:
    arm = session.arm
    arm.allowed_planning_time = 10.0

    print("groups", sorted(session.description.group_names))
    print("named", session.move_to_configuration(session.joint_positions("ready")))
    print("joints", session.move_to_configuration([0.3, -0.3, -0.5, 0.2, 0.1, 0.0]))
    pose = arm.compute_fk(fk_link_names=["link6_flange"])[0].pose
    place, turn = pose.position, pose.orientation
    here = ([place.x, place.y, place.z], [turn.x, turn.y, turn.z, turn.w])
    print("inverse", arm.compute_ik(*here, ik_link_name="link6_flange") is not None)
    print("pose", session.move_to_pose(*here))
    lower = [place.x, place.y, place.z - 0.02]
    print("cartesian", session.move_to_pose(lower, here[1], cartesian=True))
    print("unreachable", session.move_to_pose([3.0, 0.0, 0.0], here[1]), arm.last_failure())

    arm.add_collision_box(id="box", **BOX)
    while not (arm.update_planning_scene() and arm.planning_scene.world.collision_objects):
        pass  # Each update waits for its answer.
    print("scene", [thing.id for thing in arm.planning_scene.world.collision_objects])

    arm.move_to_configuration([1.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    while arm.query_state() is MoveIt2State.REQUESTING:
        time.sleep(0.001)
    print("canceled", arm.cancel_execution(), arm.wait_until_executed())
