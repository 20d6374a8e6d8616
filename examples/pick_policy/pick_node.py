r"""The trained policy picks over ROS: the cylinder stands somewhere else each time.

    arm launch mycobot load_controllers:=false                     # in another terminal
    arm run controller_manager spawner joint_state_broadcaster pick_policy_controller \
        --param-file controllers.yaml
    python pick_node.py --picks 100

It reads /joint_states, asks the simulation where the cylinder is, and commands
/pick_policy_controller/commands every 0.04 s of simulation time, as in the training.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from pick_policy import CARRIED_OUT, JOINTS, Array, Policy, load
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.utilities import try_shutdown
from sensor_msgs.msg import JointState
from simulation_interfaces.msg import Result
from simulation_interfaces.srv import GetEntityState, SetEntityState
from std_msgs.msg import Float64MultiArray

OBJECT, AWAY = "red_cylinder", (2.0, -2.0)
PICK_S, BACK_S = 12.0, 2.4
"""How long a pick may take, and the way back to a start."""
DECISION_S = 0.04
NEAREST_M, FARTHEST_M, MOST_ASIDE, STANDING_M = 0.2, 0.255, 1.0, 0.175
START_RAD, MOST_CLOSED, MOST_OPEN = 0.4, -0.3, 0.15
LOWEST_LIFT_M, HIGHEST_LIFT_M = 0.04, 0.08
"""As in the training. This node works without Gymnasium, which that needs."""
NEEDED_SHARE = 0.8


class Cylinder:
    """The cylinder in the simulation.

    Attributes:
        place: where it was last seen, x, y and z; None while that is not known.
    """

    def __init__(self, node: Node) -> None:
        self._logger = node.get_logger()
        self._asked = node.create_client(GetEntityState, "/get_entity_state")
        self._put = node.create_client(SetEntityState, "/set_entity_state")
        self._is_waiting = False
        self.place: Array | None = None

    def wait(self) -> None:
        """Wait for the simulation."""
        for client in (self._asked, self._put):
            while not client.wait_for_service(timeout_sec=5.0):
                self._logger.warning(f"waiting for {client.srv_name}: is the simulation running?")

    def look(self) -> None:
        """Ask where it is, unless an answer is on its way."""
        if self._is_waiting:
            return
        self._is_waiting = True
        self._asked.call_async(GetEntityState.Request(entity=OBJECT)).add_done_callback(self._see)

    def stand_at(self, x: float, y: float) -> None:
        """Stand it upright somewhere."""
        self.place = None
        request = SetEntityState.Request(entity=OBJECT, set_pose=True)
        position = request.state.pose.position
        position.x, position.y, position.z = x, y, STANDING_M
        request.state.pose.orientation.w = 1.0
        self._put.call_async(request).add_done_callback(lambda done: self._check(done.result()))

    def _see(self, done: Any) -> None:
        self._is_waiting = False
        answer = done.result()
        if self._check(answer):
            at = answer.state.pose.position
            self.place = np.array([at.x, at.y, at.z])

    def _check(self, answer: Any) -> bool:
        if answer.result.result != Result.RESULT_OK:
            self._logger.error(f"{OBJECT}: {answer.result.error_message}")
        return answer.result.result == Result.RESULT_OK


class Picker(Node):
    """Picks again and again: back to a random start, the cylinder to a random place, the policy.

    Attributes:
        lifted: whether each pick lifted the cylinder, in order.
    """

    def __init__(self, policy: Policy, picks: int, seed: int) -> None:
        super().__init__("pick_policy")
        self._policy, self._count = policy, picks
        self._random = np.random.default_rng(seed)
        self._cylinder = Cylinder(self)
        self._cylinder.wait()
        self.lifted: list[bool] = []
        self._ahead = np.empty((0, len(JOINTS)))
        self._command = self._start = np.zeros(len(JOINTS))
        self._lift = self._next_s = 0.0
        self._step = 0
        self._is_picking = False
        self._commands = self.create_publisher(
            Float64MultiArray, "/pick_policy_controller/commands", 10
        )
        self.create_subscription(JointState, "/joint_states", self._decide, 10)

    @property
    def is_done(self) -> bool:
        """Whether there are no more picks."""
        return len(self.lifted) >= self._count

    def _decide(self, message: JointState) -> None:
        now_s = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        if self.is_done or now_s < self._next_s - 1e-6:
            return
        by_name = dict(zip(message.name, message.position, strict=True))
        missing = [name for name in JOINTS if name not in by_name]
        if missing:
            self.get_logger().warning(
                f"/joint_states has no position of {', '.join(missing)}: is it another robot's?",
                throttle_duration_sec=5.0,
            )
            return
        self._next_s = now_s + DECISION_S
        position = np.array([by_name[name] for name in JOINTS])
        if self._is_picking:
            self._pick(position)
        else:
            self._go_back(position)

    def _go_back(self, position: Array) -> None:
        """Go to a random start while the cylinder is away, then put it to its next place."""
        if self._step == 0:
            self._cylinder.stand_at(*AWAY)
            self._start = self._random.uniform(-START_RAD, START_RAD, len(JOINTS))
            self._start[-1] = self._random.uniform(MOST_CLOSED, MOST_OPEN)
            steps = round(BACK_S / DECISION_S)
            way = np.linspace(0.0, 1.0, steps + 1)[1:, None]
            self._ahead = position + np.minimum(1.0, way * 1.25) * (self._start - position)
        self._send(self._ahead[self._step])
        self._step += 1
        if self._step == len(self._ahead):
            distance = self._random.uniform(NEAREST_M, FARTHEST_M)
            aside = self._random.uniform(-MOST_ASIDE, MOST_ASIDE)
            self._lift = self._random.uniform(LOWEST_LIFT_M, HIGHEST_LIFT_M)
            self._cylinder.stand_at(distance * np.cos(aside), distance * np.sin(aside))
            self._is_picking, self._step = True, 0

    def _pick(self, position: Array) -> None:
        self._cylinder.look()
        place = self._cylinder.place
        if place is None or np.hypot(*place[:2]) > 1.0:
            return
        if self._step % CARRIED_OUT == 0:
            joints = np.append(position[:-1], self._command[-1])
            self._ahead = self._policy.commands(joints, place[:2], self._lift)
        self._send(self._ahead[self._step % CARRIED_OUT])
        self._step += 1
        is_up = place[2] >= STANDING_M + self._lift
        if is_up or self._step * DECISION_S >= PICK_S:
            self.lifted.append(bool(is_up))
            what = "lifted" if is_up else "failed"
            self.get_logger().info(
                f"pick {len(self.lifted)} {what} after {self._step * DECISION_S:.1f} s, "
                f"{place[2] - STANDING_M:.3f} of {self._lift:.3f} m up"
            )
            self._is_picking, self._step = False, 0

    def _send(self, command: Array) -> None:
        self._command = command
        self._commands.publish(Float64MultiArray(data=command.tolist()))


def main() -> int:
    """Pick; return 1 if too few picks lifted the cylinder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picks", type=int, default=100, help="number of picks (100)")
    parser.add_argument("--seed", type=int, default=1, help="seed of starts and places (1)")
    parser.add_argument(
        "--policy", type=Path, default=Path(__file__).with_name("policy.npz"), help="the weights"
    )
    options = parser.parse_args()
    rclpy.init()
    picker = Picker(load(options.policy), options.picks, options.seed)
    executor = SingleThreadedExecutor()
    executor.add_node(picker)
    try:
        while not picker.is_done:
            executor.spin_once(timeout_sec=1.0)
    except (KeyboardInterrupt, ExternalShutdownException):
        return 130
    finally:
        picker.destroy_node()
        try_shutdown()
    print(f"{sum(picker.lifted)} of {len(picker.lifted)} picks lifted the cylinder")
    return 0 if sum(picker.lifted) >= NEEDED_SHARE * options.picks else 1


if __name__ == "__main__":
    sys.exit(main())
