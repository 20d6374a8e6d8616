"""A Gymnasium environment for any robot; a policy takes the place of its controllers."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from arm_sim.errors import CallError
from arm_sim.gym.actions import Commands, action_mode
from arm_sim.gym.expert import Expert
from arm_sim.gym.robot import CommandedRobot, RobotOptions
from arm_sim.gym.task import Array, Task
from arm_sim.robots import AnyPath
from arm_sim.simulation import Simulation

Images = NDArray[np.uint8]
Observations = dict[str, Any]
DECISION_S = 0.04
CONTROL_RATE_HZ = 100


class ArmEnv(gymnasium.Env[Observations, NDArray[np.float32]]):
    """One robot in its world; each action holds for `decision_s` of simulated time.

    It runs the classes of the simulation node, as `Simulation` does. Equal seeds and actions give
    equal bits.

    Args:
        description: URDF or xacro file, or "arm" or "mycobot"; see `Simulation`.
        task: observations, reward, end and start of the episodes.
        actions: "position", "step", "velocity" or "effort", see `ACTIONS`; an action has a number
            from -1 to 1 for each joint.
        cameras: cameras whose images are observations, under their names.
        joints: the joints that actions command; None for all that have the interface.
        decision_s: simulated time of one action, a whole number of control periods.
        control_rate_hz: control rate.
        restart: whether each episode starts from the robot's initial pose. With False the robot
            stays where it is and gets a new goal, unless `reset` gets a seed.
        simulation: further arguments of `Simulation`, such as `world` or `arguments`.
        vary: changes the scene at the start of each episode, before the task draws its goal.
        expert: makes the expert of each episode, whose action infos contain as `expert_action`;
            None for none. For actions of positions only.
        render_mode: "rgb_array" for images of a camera, or None.
        render_camera: the camera of `render`; None for the robot's first.

    Attributes:
        simulation: the simulation behind it.
        lower: lowest positions of the commanded joints, shape (n,).
        upper: highest positions of the commanded joints, shape (n,).
        goal: the values that the task drew for this episode.
        decision_s: simulated time of one action.
    """

    # Gymnasium reads it from the class, to check render modes before it creates an environment.
    metadata = {"render_modes": ["rgb_array"], "render_fps": round(1.0 / DECISION_S)}  # noqa: RUF012

    def __init__(
        self,
        description: AnyPath = "arm",
        task: Task | None = None,
        *,
        actions: str = "position",
        cameras: Sequence[str] = (),
        joints: Sequence[str] | None = None,
        decision_s: float = DECISION_S,
        control_rate_hz: int = CONTROL_RATE_HZ,
        restart: bool = True,
        simulation: Mapping[str, Any] | None = None,
        vary: "Callable[[ArmEnv, np.random.Generator], None] | None" = None,
        expert: "Callable[[ArmEnv], Expert] | None" = None,
        render_mode: str | None = None,
        render_camera: str | None = None,
    ) -> None:
        """Build the simulation.

        Raises:
            CallError: an argument cannot be used.
            UnknownNameError: a camera does not exist.
            DescriptionError, GazeboError, ArmControlError: see `Simulation`.
        """
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise CallError(f"no render mode '{render_mode}'; the only one is rgb_array")
        interface = action_mode(actions).interface
        if expert is not None and interface != "position":
            raise CallError(f"an expert commands positions, so it has no actions '{actions}'")
        self.render_mode = render_mode
        self.task, self.decision_s = task or Task(), decision_s
        options = RobotOptions(description, joints, decision_s, control_rate_hz, simulation or {})
        self._robot = CommandedRobot(options, interface)
        self.simulation: Simulation = self._robot.simulation
        self._physics = self.simulation.parts.physics
        self.lower, self.upper = self._robot.lower, self._robot.upper
        self._commands = Commands(actions, self._robot.joints, decision_s)
        self._cameras = tuple(cameras)
        self._render_camera = render_camera
        self._restarts, self._started = restart, False
        self._vary, self._make_expert = vary, expert
        self._expert: Expert | None = None
        self.goal: Mapping[str, Array] = {}
        self.metadata = {**self.metadata, "render_fps": round(1.0 / decision_s)}
        self._begin(np.random.default_rng(0))
        count = len(self._robot.joints)
        self.action_space = spaces.Box(-1.0, 1.0, (count,), np.float32)
        self.observation_space = spaces.Dict(self._spaces())

    # The scene that the task's functions see

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the commanded joints."""
        return tuple(joint.name for joint in self._robot.joints)

    @property
    def position(self) -> Array:
        """Positions of the commanded joints, shape (n,)."""
        return self._qpos[self._addresses]

    @property
    def velocity(self) -> Array:
        """Velocities of the commanded joints, shape (n,)."""
        return self._qvel[self._dofs]

    @property
    def command(self) -> Array:
        """The last commands of the joints, shape (n,)."""
        return self._last.copy()

    def point(self, link: str) -> Array:
        """Return the origin of a link, or of a thing in the world, in m, shape (3,)."""
        return self._physics.poses().xpos[self._robot.body(link)].copy()

    def point_at(self, link: str, positions: Array) -> Array:
        """Return where a link would be, shape (3,), with the joints at positions, shape (n,)."""
        return self._robot.point_at(link, positions)

    # Gymnasium

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Start an episode; return the observations, and the info.

        Raises:
            PlanError, PlanningError: the expert has no plan for this episode.
        """
        super().reset(seed=seed)
        if self._restarts or seed is not None or not self._started:
            self._begin(self.np_random)
        else:
            self.goal = self.task.start(self, self.np_random)
        self._started = True
        self._expert = self._make_expert(self) if self._make_expert is not None else None
        return self._observe(), self._shown()

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[Observations, float, bool, bool, dict[str, Any]]:
        """Apply an action; return observations, reward, terminated, truncated and info.

        The episode is truncated if the physics became unstable; then the info contains `failure`.
        """
        self._last = self._commands.of(action, self._last)
        self._robot.command(self._last.tolist())
        tick = self.simulation.parts.tick
        for _ in range(self._robot.periods):
            tick()
        failures = self._physics.take_failures()
        task = self.task
        succeeded = bool(task.succeeded(self))
        info = {"is_success": succeeded, **self._shown()}
        if failures:
            info["failure"] = failures[0]
        ends_there = task.terminated is task.succeeded
        terminated = succeeded if ends_there else bool(task.terminated(self))
        reward = float(task.reward(self))
        return self._observe(), reward, terminated, bool(failures), info

    def move(self, positions: Array, time_s: float) -> None:
        """Command the joints evenly to positions, outside of any action; for the start of episodes.

        Args:
            positions: shape (n,).
            time_s: simulated time until they are commanded.
        """
        parts, start = self.simulation.parts, self._last
        for share in np.linspace(0.0, 1.0, round(time_s / self.simulation.period_s) + 1)[1:]:
            self._last = start + share * (positions - start)
            self._robot.command(self._last.tolist())
            parts.tick()

    def render(self) -> Images | None:
        """Return an image of the camera, shape (h, w, 3), or None without a render mode."""
        if self.render_mode is None:
            return None
        names = self.simulation.cameras
        if not names:
            raise CallError("the robot has no camera, so there is nothing to render with")
        return self.simulation.camera(self._render_camera or names[0]).image().copy()

    def close(self) -> None:
        """Close the simulation; may be called again."""
        self.simulation.close()

    def _begin(self, random: np.random.Generator) -> None:
        """Return to the start and draw a goal."""
        self._robot.restart()
        self._qpos, self._qvel = self._physics.data.qpos, self._physics.data.qvel
        self._addresses = np.array([joint.qpos_address for joint in self._robot.joints])
        self._dofs = np.array([joint.dof_address for joint in self._robot.joints])
        self._last = self._commands.home.copy()
        if self._vary is not None:
            self._vary(self, random)
        self.goal = self.task.start(self, random)

    def _shown(self) -> dict[str, Any]:
        """Return the expert's action, if there is an expert."""
        if self._expert is None:
            return {}
        wanted = self._expert.command(self._last.copy())
        return {"expert_action": self._commands.action_to(wanted, self._last)}

    def _observe(self) -> Observations:
        observed: Observations = dict(self.task.observe(self))
        for name in self._cameras:
            observed[name] = self.simulation.camera(name).image().copy()
        return observed

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        found: dict[str, spaces.Space[Any]] = task_spaces(self.task, self.task.observe(self))
        for name in self._cameras:
            camera = self.simulation.camera(name)
            found[name] = spaces.Box(0, 255, (camera.height, camera.width, 3), np.uint8)
        return found


def task_spaces(
    task: Task, observed: Mapping[str, NDArray[np.float32]]
) -> dict[str, spaces.Space[Any]]:
    """Return the spaces of a task's observations, as those of one environment."""
    return {
        name: spaces.Box(one.low, one.high, observed[name].shape, np.float32)
        for name, one in task.observations.items()
    }
