"""A client that keeps requests to plan open without a pause; one JSON line when it begins and ends.

python benchmarks/planning_client.py SECONDS
"""

import contextlib
import json
import sys
import time

import rclpy
from moveit_msgs.srv import GetMotionPlan
from rclpy.node import Node
from rclpy.utilities import try_shutdown

from arm_planning.ros.goal_messages import joint_goal, plan_message

JOINTS = ("link1_to_link2", "link2_to_link3", "link3_to_link4")
TARGETS = ((0.4, 0.3, -0.3), (-0.4, -0.3, 0.3))
OPEN = 2
"""Requests that are open at a time: move_group always has the next one."""
TIMEOUT_S = 60.0
PLAN_S = 5.0


def say(**answer: object) -> None:
    print(json.dumps(answer), flush=True)


def result(node: Node, future):
    rclpy.spin_until_future_complete(node, future, timeout_sec=TIMEOUT_S)
    if not future.done():
        raise SystemExit("move_group does not answer")
    return future.result()


def main() -> None:
    seconds = float(sys.argv[1])
    rclpy.init()
    node = Node("planning_client")
    client = node.create_client(GetMotionPlan, "/plan_kinematic_path")
    client.wait_for_service(TIMEOUT_S)

    def ask(number: int):
        goal = joint_goal(dict(zip(JOINTS, TARGETS[number % 2], strict=True)))
        message = plan_message("arm", goal, allowed_planning_time=PLAN_S, num_planning_attempts=1)
        return client.call_async(GetMotionPlan.Request(motion_plan_request=message))

    result(node, ask(0))
    say(begins=True)
    answers, codes, end = 0, set(), time.monotonic() + seconds
    waiting = [ask(number) for number in range(OPEN)]
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
        for index, future in enumerate(waiting):
            if future.done():
                answers += 1
                codes.add(future.result().motion_plan_response.error_code.val)
                waiting[index] = ask(answers)
    say(answers=answers, codes=sorted(codes))
    with contextlib.suppress(RuntimeError):
        try_shutdown()


if __name__ == "__main__":
    main()
