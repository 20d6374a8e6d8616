"""Many copies of one environment in threads: physics only, each bit-identical to `ArmEnv`."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from arm_gazebo.batch.choice import HOST, make_copies
from arm_sim.gym.actions import Commands, action_mode
from arm_sim.gym.arm_env import CONTROL_RATE_HZ, DECISION_S, task_spaces
from arm_sim.gym.robot import CommandedRobot, RobotOptions
from arm_sim.gym.task import Array, Task
from arm_sim.robots import AnyPath

Actions = NDArray[np.float32]
Flags = NDArray[np.bool_]
Observations = dict[str, NDArray[np.float32]]


class BatchEnv(VectorEnv[Observations, Actions, Any]):
    """Copies of one robot in its world that MuJoCo steps in threads.

    With seed s, copy i goes through the same states as an `ArmEnv` with seed s + i, bit for bit. A
    copy whose episode ends starts its next one in the same step; infos contain its last
    observations as `final_obs` and its last info as `final_info`. Cameras and other sensors are
    left out.

    Args:
        num_envs: number of copies.
        description: see `ArmEnv`.
        task: see `ArmEnv`.
        actions: see `ArmEnv`.
        joints: see `ArmEnv`.
        decision_s: see `ArmEnv`.
        control_rate_hz: see `ArmEnv`.
        restart: see `ArmEnv`.
        max_episode_steps: actions after which an episode is truncated; None for never.
        threads: number of threads; 0 for one on each core. A few copies run in the caller's thread.
        device: "host", or "cuda" for MuJoCo Warp on a GPU ("cuda:1" for a certain one): many more
            copies, whose numbers are close to those of single environments, but not equal. Needs
            the extra `gpu`.
        simulation: see `ArmEnv`.
    """

    def __init__(
        self,
        num_envs: int,
        description: AnyPath = "arm",
        task: Task | None = None,
        *,
        actions: str = "position",
        joints: Sequence[str] | None = None,
        decision_s: float = DECISION_S,
        control_rate_hz: int = CONTROL_RATE_HZ,
        restart: bool = True,
        max_episode_steps: int | None = None,
        threads: int = 0,
        device: str = HOST,
        simulation: Mapping[str, Any] | None = None,
    ) -> None:
        """Build one simulation and its copies.

        Raises:
            CallError, DescriptionError, GazeboError, ArmControlError: see `ArmEnv`.
            BatchError: there is no such device, or MuJoCo Warp cannot simulate the copies.
        """
        self.metadata = {"autoreset_mode": AutoresetMode.SAME_STEP}
        self.num_envs = num_envs
        self.task = task or Task()
        options = RobotOptions(description, joints, decision_s, control_rate_hz, simulation or {})
        self._robot = CommandedRobot(options, action_mode(actions).interface)
        self.lower, self.upper = self._robot.lower, self._robot.upper
        self.joints = tuple(joint.name for joint in self._robot.joints)
        self._commands = Commands(actions, self._robot.joints, decision_s)
        parts = self._robot.simulation.parts
        self._physics = make_copies(parts.physics, parts.hardware, num_envs, threads, device)
        self._of_drives = np.zeros((num_envs, len(parts.physics.servo.joints)))
        self._addresses = np.array([joint.qpos_address for joint in self._robot.joints])
        self._dofs = np.array([joint.dof_address for joint in self._robot.joints])
        self._restarts, self._max_steps = restart, max_episode_steps
        self._steps = np.zeros(num_envs, dtype=np.int64)
        self._last = np.tile(self._commands.home, (num_envs, 1))
        self._randoms: list[np.random.Generator] = []
        self.goal: Mapping[str, Array] = {}
        self.reset()
        self._make_spaces()

    def _make_spaces(self) -> None:
        observed = {name: values[0] for name, values in self.task.observe(self).items()}
        self.single_observation_space = spaces.Dict(task_spaces(self.task, observed))
        self.single_action_space = spaces.Box(-1.0, 1.0, (len(self.joints),), np.float32)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)

    # The scene that the task's functions see

    @property
    def position(self) -> Array:
        """Positions of the commanded joints, shape (copies, n)."""
        return self._physics.qpos[:, self._addresses]

    @property
    def velocity(self) -> Array:
        """Velocities of the commanded joints, shape (copies, n)."""
        return self._physics.qvel[:, self._dofs]

    @property
    def command(self) -> Array:
        """The last commands of the joints, shape (copies, n)."""
        return self._last.copy()

    def point(self, link: str) -> Array:
        """Return the origins of a link, or of a thing, in the world in m, shape (copies, 3)."""
        return self._physics.link_positions(self._robot.body(link))

    def point_at(self, link: str, positions: Array) -> Array:
        """Return where a link would be, shape (3,), with the joints at positions, shape (n,)."""
        return self._robot.point_at(link, positions)

    # Gymnasium

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observations, dict[str, Any]]:
        """Start an episode in every copy.

        Args:
            seed: copy i gets seed + i, or the seed of that index; None continues their random
                sequences.
            options: not used.
        """
        seeds = [seed + i for i in range(self.num_envs)] if isinstance(seed, int) else seed
        if not self._randoms:
            self._randoms = [seeding.np_random(None)[0] for _ in range(self.num_envs)]
        for index, one in enumerate(seeds or []):
            if one is not None:
                self._randoms[index] = seeding.np_random(one)[0]
        self._begin(np.arange(self.num_envs), restart=True)
        return self.task.observe(self), {}

    def step(
        self, actions: Actions
    ) -> tuple[Observations, NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        """Apply an action to each copy; see `ArmEnv.step`."""
        self._last = self._commands.of(actions, self._last)
        self._of_drives[:, self._robot.drives] = self._last
        failed = self._physics.advance(self._of_drives, self._robot.periods)
        self._steps += 1
        observed = self.task.observe(self)
        rewards = np.asarray(self.task.reward(self), dtype=np.float64)
        terminated = np.array(self.task.terminated(self), dtype=bool)
        succeeded = np.array(self.task.succeeded(self), dtype=bool)
        truncated = failed.copy()
        if self._max_steps is not None:
            truncated |= self._steps >= self._max_steps
        everywhere = np.ones(self.num_envs, dtype=bool)
        infos: dict[str, Any] = {"is_success": succeeded, "_is_success": everywhere}
        ended = np.flatnonzero(terminated | truncated)
        if len(ended):
            infos |= self._final(ended, observed, succeeded)
            self._begin(ended, restart=self._restarts, failed=failed)
            observed = self.task.observe(self)
        return observed, rewards, terminated, truncated, infos

    def close_extras(self, **kwargs: Any) -> None:
        """Close the simulation that the copies were made from."""
        self._robot.simulation.close()

    def _final(
        self, ended: NDArray[np.intp], observed: Observations, succeeded: Flags
    ) -> dict[str, Any]:
        """Return the last observations and infos of ended episodes, in Gymnasium's layout."""
        mask = np.zeros(self.num_envs, dtype=bool)
        mask[ended] = True
        last = np.full(self.num_envs, None, dtype=object)
        for index in ended.tolist():
            last[index] = {name: values[index].copy() for name, values in observed.items()}
        info = {"is_success": succeeded & mask, "_is_success": mask.copy()}
        return {
            "final_obs": last,
            "_final_obs": mask.copy(),
            "final_info": info,
            "_final_info": mask,
        }

    def _begin(self, rows: NDArray[np.intp], restart: bool, failed: Flags | None = None) -> None:
        """Start an episode in some copies; those that became unstable restart in any case."""
        again = rows if restart else rows[failed[rows]] if failed is not None else rows[:0]
        if len(again):
            self._physics.reset(again)
            self._last[again] = self._commands.home
        self._steps[rows] = 0
        for row in rows.tolist():
            for name, values in self.task.start(self, self._randoms[row]).items():
                if name not in self.goal:
                    self.goal = {**self.goal, name: np.zeros((self.num_envs, len(values)))}
                self.goal[name][row] = values
