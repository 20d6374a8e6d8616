"""A launch in a ROS domain of its own, as Python objects."""

import math
import shutil
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

from control_msgs.action import FollowJointTrajectory, GripperCommand
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from arm_sim.bench.expectations import JointAssertions
from arm_sim.bench.history import StateHistory
from arm_sim.bench.processes import LoggedProcess
from arm_sim.bench.ros_connection import WAIT_S, Messages, MessageT, RosConnection
from arm_sim.bench.ros_faults import RosFaults
from arm_sim.errors import BenchError, GoalError
from arm_sim.trajectory import trajectory_request

if TYPE_CHECKING:
    from arm_sim.trajectory import AnyTrajectory

READY_TIMEOUT_S = 120.0
GOAL_TIMEOUT_S = 60.0
STATUS_SUCCEEDED = 4
"""Of action_msgs/msg/GoalStatus."""
SIMULATION = "/arm_gazebo"
FINISH_TIMEOUT_S = 5.0
LOG, PLOT = "launch.log", "joints.png"


class RosBench(JointAssertions):
    """A running launch, a node beside it, and the history of its joints. The test's thread.

    Attributes:
        domain_id: its ROS domain.
        environment: the environment of its processes.
        history: the states of /joint_states.
        faults: faults for the duration of a `with` block.
    """

    def __init__(self, launch: LoggedProcess, domain_id: int, recording: Path) -> None:
        """Take a launch that has just been started, and wait until everything is ready.

        The launch ends with `close`, or if this fails; it records the run to `recording`.

        Raises:
            BenchError: the launch fails; with its output.
        """
        self.domain_id = domain_id
        self.environment = launch.environment
        self._recording = recording
        self.history = StateHistory([])
        self._first_names = threading.Event()
        self._programs: list[LoggedProcess] = []
        self._launch = launch
        try:
            self._connection = RosConnection(domain_id)
        except BaseException:
            self._launch.end()
            raise
        self.faults = RosFaults(self._connection, self._launch, lambda: self.time_s)
        try:
            self._listen()
            self._launch.wait_for_line(r"^ready ", READY_TIMEOUT_S)
        except BaseException:
            self.close()
            raise

    def close(self) -> list[str]:
        """End everything that was started; return what did not end properly."""
        problems: list[str] = []
        with ExitStack() as stack:
            # Even if one part does not close, the others must.
            for process in [self._launch, *self._programs]:
                stack.callback(lambda ended=process: problems.append(ended.end()))
            stack.callback(self._connection.close)
        if self.faults.has_killed:
            # What a killed process leaves behind is not the launch's fault.
            return []
        return [problem for problem in problems if problem]

    # What happens

    @property
    def log(self) -> str:
        """The output of the launch so far."""
        return self._launch.log

    def wait_for_log(self, pattern: str, timeout_s: float = WAIT_S) -> str:
        """Return the first line of the launch's output in which a regular expression is found."""
        return self._launch.wait_for_line(pattern, timeout_s)

    @property
    def time_s(self) -> float:
        """Simulation time of the latest joint states; 0 before the first."""
        times_s = self.history.times_s
        return float(times_s[-1]) if len(times_s) else 0.0

    @property
    def processes(self) -> dict[str, list[int]]:
        """The process ids of the launch by the names of their programs."""
        return self._launch.descendants()

    @property
    def node(self) -> Any:
        """The rclpy node of the test; an executor spins it in another thread."""
        return self._connection.node

    def collect(
        self, topic: str, message_type: type[MessageT], qos: Any = 10
    ) -> Messages[MessageT]:
        """Collect a topic's messages from now on; see `Messages`."""
        return self._connection.collect(topic, message_type, qos)

    # What the test does

    def publish(self, topic: str, message: Any, qos: Any = 10) -> None:
        """Publish a message once the subscribers have been discovered."""
        self._connection.publish(topic, message, qos)

    def call(
        self, name: str, service_type: Any, request: Any = None, timeout_s: float = WAIT_S
    ) -> Any:
        """Call a service; return its answer. See `RosConnection.call`."""
        return self._connection.call(name, service_type, request, timeout_s)

    def command(self, controller: str, values: Sequence[float]) -> None:
        """Send a command to a forwarding controller's topic ~/commands."""
        self.publish(f"{controller}/commands", Float64MultiArray(data=[float(v) for v in values]))

    def follow(
        self, controller: str, trajectory: "AnyTrajectory", *, timeout_s: float = GOAL_TIMEOUT_S
    ) -> Any:
        """Send a trajectory to a controller's action and wait for its end; return the result.

        Args:
            controller: name of the controller.
            trajectory: the waypoints, see `ControllerHandle.follow`; it names its joints.
            timeout_s: wall time to wait at most.

        Raises:
            GoalError: it was rejected, aborted or cancelled.
            BenchError: it does not end in time.
        """
        from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

        request = trajectory_request(trajectory, self.history.names)
        points: list[JointTrajectoryPoint] = []
        for point in request.points:
            times_ns = round(point.time_from_start_s * 1e9)
            written = JointTrajectoryPoint(
                positions=[float(value) for value in point.positions],
                velocities=[float(value) for value in point.velocities],
                accelerations=[float(value) for value in point.accelerations],
            )
            written.time_from_start.sec, written.time_from_start.nanosec = divmod(times_ns, 10**9)
            points.append(written)
        message = JointTrajectory(joint_names=list(request.joint_names), points=points)
        goal = FollowJointTrajectory.Goal(trajectory=message)
        name = f"{controller}/follow_joint_trajectory"
        return self._act(controller, name, FollowJointTrajectory, goal, timeout_s)

    def grip(
        self,
        controller: str,
        position: float,
        max_effort: float = 0.0,
        *,
        timeout_s: float = GOAL_TIMEOUT_S,
    ) -> Any:
        """Move a gripper by its action and wait for the end; return the result.

        Raises:
            GoalError: it was rejected, aborted or cancelled.
            BenchError: it does not end in time.
        """
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = float(position), float(max_effort)
        return self._act(controller, f"{controller}/gripper_cmd", GripperCommand, goal, timeout_s)

    def run(self, *command: str) -> LoggedProcess:
        """Start a program of your own in the launch's domain; it ends with the test at the latest.

        Args:
            command: the program and its arguments, such as sys.executable, "node.py".
        """
        program = LoggedProcess(Path(command[0]).name, command, self.environment)
        self._programs.append(program)
        return program

    def run_until(self, condition: Callable[[], bool], timeout_s: float) -> bool:
        """Wait until a condition holds or the timeout passes; return whether it holds.

        Args:
            condition: called whenever there are new joint states.
            timeout_s: simulated seconds, by the stamps of the joint states.

        Raises:
            AssertionError: joint states no longer arrive.
        """
        history = self._states()
        began_s, seen, heard_s = self.time_s, -1, time.monotonic()
        while True:
            if len(history) != seen:
                seen, heard_s = len(history), time.monotonic()
                if condition():
                    return True
                if self.time_s - began_s > timeout_s:
                    return False
            elif time.monotonic() - heard_s > WAIT_S:
                raise AssertionError(
                    f"no joint states for {WAIT_S:g} s; the last are of {self.time_s:.3f} s"
                )
            time.sleep(0.002)

    def _circumstances(self) -> Iterator[str]:
        return map(str, self.faults.log.spans)

    # The report

    def report(self, folder: Path) -> Iterator[str]:
        """Write files that explain a failure; yield a line for each, and the launch's output."""
        if len(self.history):
            from arm_sim.bench.joint_plot import save_plot

            save_plot(self.history, folder / PLOT, self.faults.log.spans)
            yield f"joints: {folder / PLOT}"
        if self._recording.exists():
            self._finish_recording()
            copied = shutil.copy(self._recording, folder)
            yield f"run it again: arm sim replay {quote(str(copied))}"
        log = self.log
        (folder / LOG).write_text(f"{log}\n", encoding="utf-8")
        yield f"log: {quote(str(folder / LOG))}"
        yield log
        for program in self._programs:
            yield f"output of {program.name}:"
            yield program.log

    def _finish_recording(self) -> None:
        """Let the simulation write the rest of the recording; it does so twice a second."""
        finish = Parameter("record_run", value="").to_parameter_msg()
        # A simulation that has died or hangs has written all but its last half second.
        with suppress(BenchError):
            self._connection.call(
                f"{SIMULATION}/set_parameters",
                SetParameters,
                SetParameters.Request(parameters=[finish]),
                FINISH_TIMEOUT_S,
            )

    def _listen(self) -> None:
        node = self._connection.node
        self._connection.run(
            lambda: node.create_subscription(JointState, "joint_states", self._take_states, 100),
            "joint_states",
        )

    def _act(
        self, controller: str, name: str, action_type: Any, goal: Any, timeout_s: float
    ) -> Any:
        wrapped = self._connection.act(f"/{name.lstrip('/')}", action_type, goal, timeout_s)
        if wrapped is None:
            raise GoalError(f"controller '{controller}' rejected the goal; its log says why")
        result = wrapped.result
        if wrapped.status != STATUS_SUCCEEDED:
            text = getattr(result, "error_string", "") or f"the goal of '{controller}' failed"
            raise GoalError(text, code=getattr(result, "error_code", None))
        return result

    def _states(self) -> StateHistory:
        if not self._first_names.wait(WAIT_S):
            raise AssertionError(f"no joint states within {WAIT_S:g} s")
        return self.history

    def _take_states(self, message: JointState) -> None:
        """Add joint states; the executor's thread."""
        names = tuple(message.name)
        if not self._first_names.is_set():
            self.history = StateHistory(names)
        if names != self.history.names:
            # A message of another publisher, with other joints: only the known joints count.
            return
        stamp = message.header.stamp
        missing = [math.nan] * len(names)
        self.history.add(
            stamp.sec + 1e-9 * stamp.nanosec,
            message.position or missing,
            message.velocity or missing,
            message.effort or missing,
        )
        self._first_names.set()
