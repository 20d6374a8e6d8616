"""A partner of a lock-stepped myCobot that lets move_group plan while it answers control periods.

It asks for plans around a box from where the arm stands, goes on answering, and lets move_group
execute the last plan later. It prints a line for each period: its number, and the positions without
any rounding; and before the motion one for each plan: its error code, and all of its positions. The
last line has the error code of the motion.

    python lock_step_planner.py LAST_PERIOD
"""

import sys
from collections import deque
from typing import Any

import rclpy
from action_msgs.msg import GoalStatusArray
from geometry_msgs.msg import Pose
from moveit_msgs.action import ExecuteTrajectory
from moveit_msgs.msg import CollisionObject, Constraints, JointConstraint, MotionPlanRequest
from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.srv import ApplyPlanningScene, GetMotionPlan
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from sensor_msgs.msg import JointState
from shape_msgs.msg import SolidPrimitive
from std_msgs.msg import Header

PERIOD_S = 0.01
ASKED = range(20, 60, 5)
"""Control periods in which a plan is asked for."""
USED = 80
"""The one in which the last plan is executed."""
GOAL = {"link1_to_link2": 1.2, "link2_to_link3": -1.2, "link3_to_link4": 0.4}
BOX_M, PLACE_M = [0.05, 0.05, 0.3], (-0.046, 0.175, 0.36)
TIMEOUT_S = 60.0


class Partner(Node):
    """Keeps the joint states that wait for an answer, and answers them."""

    def __init__(self) -> None:
        super().__init__("partner")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self)
        self._states: deque[JointState] = deque()
        self._done = self.create_publisher(Header, "~/tick_done", 10)
        self.create_subscription(JointState, "/joint_states", self._keep, 10)
        # The first answer says only that it is there.
        self._hello = self.create_timer(0.05, lambda: self._done.publish(Header()))
        self.change = self.create_client(ApplyPlanningScene, "/apply_planning_scene")
        self.planner = self.create_client(GetMotionPlan, "/plan_kinematic_path")
        self.mover = ActionClient(self, ExecuteTrajectory, "/execute_trajectory")
        self.follows = False
        status = "/arm_controller/follow_joint_trajectory/_action/status"
        self.create_subscription(GoalStatusArray, status, self._note_goal, 10)

    def _keep(self, state: JointState) -> None:
        self._states.append(state)

    def _note_goal(self, goals: GoalStatusArray) -> None:
        self.follows = self.follows or bool(goals.status_list)

    def next_state(self) -> tuple[int, JointState]:
        """Wait for a joint state; return its control period, too."""
        while not self._states:
            self._executor.spin_once()
        self._hello.cancel()
        state = self._states.popleft()
        stamp = state.header.stamp
        return round((stamp.sec + stamp.nanosec * 1e-9) / PERIOD_S), state

    def answer(self, state: JointState) -> None:
        """Let the simulation go on."""
        self._done.publish(state.header)

    def wait_until_it_follows(self) -> None:
        """Wait until the controller has a goal."""
        while not self.follows:
            self._executor.spin_once()

    def result_of(self, future: Any) -> Any:
        """Wait for an answer."""
        self._executor.spin_until_future_complete(future, TIMEOUT_S)
        assert future.done(), "no answer from move_group or the controller"
        return future.result()


def box_in_the_way() -> ApplyPlanningScene.Request:
    thing = CollisionObject(id="box", operation=CollisionObject.ADD)
    thing.header.frame_id = "base_link"
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = PLACE_M
    thing.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=BOX_M)]
    thing.primitive_poses = [pose]
    scene = SceneMessage(is_diff=True)
    scene.robot_state.is_diff = True
    scene.world.collision_objects = [thing]
    return ApplyPlanningScene.Request(scene=scene)


def request_from(state: JointState) -> GetMotionPlan.Request:
    request = MotionPlanRequest(group_name="arm", allowed_planning_time=30.0)
    request.start_state.is_diff = True
    request.start_state.joint_state = state
    request.goal_constraints = [
        Constraints(
            joint_constraints=[
                JointConstraint(
                    joint_name=joint,
                    position=GOAL.get(joint, 0.0),
                    tolerance_above=1e-4,
                    tolerance_below=1e-4,
                    weight=1.0,
                )
                for joint in state.name
                if joint.startswith("link")
            ]
        )
    ]
    return GetMotionPlan.Request(motion_plan_request=request)


def run(partner: Partner, last: int) -> None:
    """Answer until the last period."""
    asked, end = [], Future()
    while True:
        period, state = partner.next_state()
        print(period, *(position.hex() for position in state.position), flush=True)
        if period == 1:
            assert partner.change.wait_for_service(TIMEOUT_S)
            assert partner.planner.wait_for_service(TIMEOUT_S)
            assert partner.mover.wait_for_server(TIMEOUT_S)
            assert partner.result_of(partner.change.call_async(box_in_the_way())).success
        if period in ASKED:
            asked.append(partner.planner.call_async(request_from(state)))
        if period == USED:
            plans = [partner.result_of(each).motion_plan_response for each in asked]
            for plan in plans:
                points = plan.trajectory.joint_trajectory.points
                numbers = [number.hex() for point in points for number in point.positions]
                print("plan", plan.error_code.val, *numbers, flush=True)
            goal = ExecuteTrajectory.Goal(trajectory=plans[-1].trajectory)
            moving = partner.result_of(partner.mover.send_goal_async(goal))
            assert moving.accepted
            end = moving.get_result_async()
            partner.wait_until_it_follows()
        if period >= last:
            print("end", partner.result_of(end).result.error_code.val, flush=True)
            return
        partner.answer(state)


def main() -> None:
    """Answer until the last period."""
    rclpy.init()
    partner = Partner()
    run(partner, int(sys.argv[1]))
    partner.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
