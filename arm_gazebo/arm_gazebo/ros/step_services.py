"""Serve the steps of a paused simulation, with or without waiting for its cameras."""

import time
from collections.abc import Sequence
from typing import Any

from rclpy.executors import Executor
from rclpy.node import Node
from simulation_interfaces.msg import Result
from simulation_interfaces.srv import StepSimulation

from arm_control.errors import LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.ros_executor_bridge import call_on_loop, wait_for_future
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.ros.world_convert import create_services, refuse
from arm_gazebo.world.refusal import Refusal, RequestError
from arm_gazebo.world.run_control import RunControl

SLICE_S = 0.1
"""Longest time for which a wait for a picture delays the other services."""
PICTURE_TIMEOUT_S = 30.0
"""The first picture takes seconds, because the camera process then loads its renderer."""


class StepServices:
    """Creates the services on a node and answers them.

    /step_simulation answers when the messages of the last step have been sent.
    /step_simulation_with_sensors does not take a step before the pictures of the previous one have
    been published, so that every picture that is due is taken.

    Args:
        node: gets the services.
        executor: spins the node.
        loop: runs the simulation.
        run: its run state.
        cameras: publish pictures from another process.
    """

    def __init__(
        self,
        node: Node,
        executor: Executor,
        loop: ControlLoop,
        run: RunControl,
        cameras: Sequence[CameraFeed],
    ) -> None:
        self._executor = executor
        self._loop = loop
        self._run = run
        self._cameras = tuple(cameras)
        create_services(
            node,
            (
                (StepSimulation, "step_simulation", self._step),
                (StepSimulation, "step_simulation_with_sensors", self._step_with_sensors),
            ),
        )

    # Coroutines, so that a request to end a long run of steps is answered in the meantime.

    async def _step(self, request: StepSimulation.Request, response: Any) -> Any:
        try:
            done = await wait_for_future(self._run.step(request.steps), self._executor)
        except RequestError as error:
            return refuse(response, {}, error)
        except (LoopStoppedError, ValueError) as error:
            return refuse(response, {}, RequestError(Refusal.FAILED, str(error)))
        return self._answered(response, done, request.steps)

    async def _step_with_sensors(self, request: StepSimulation.Request, response: Any) -> Any:
        done = 0
        try:
            with self._run.run_of_steps(request.steps) as goes_on:
                await self._pictures_are_out()
                before = [camera.missed() for camera in self._cameras]
                while done < request.steps and goes_on():
                    done += await wait_for_future(self._run.step(1), self._executor)
                    await self._pictures_are_out()
                    self._check_sent(before)
        except RequestError as error:
            return refuse(response, {}, error)
        except (LoopStoppedError, ValueError) as error:
            return refuse(response, {}, RequestError(Refusal.FAILED, str(error)))
        return self._answered(response, done, request.steps)

    async def _pictures_are_out(self) -> None:
        """Wait until every picture that was taken has been published.

        Raises:
            RequestError: that takes too long.
        """
        for camera in self._cameras:
            deadline_s = time.monotonic() + PICTURE_TIMEOUT_S
            while late := camera.unpublished(SLICE_S):
                # It also lets the executor answer other requests.
                await call_on_loop(self._loop, camera.forget_pace, self._executor)
                if time.monotonic() > deadline_s:
                    raise RequestError(
                        Refusal.FAILED,
                        f"no picture of {', '.join(late)} within {PICTURE_TIMEOUT_S:g} s",
                    )
            await call_on_loop(self._loop, camera.forget_pace, self._executor)

    def _check_sent(self, before: Sequence[dict[str, int]]) -> None:
        """Check that every picture that was due has been taken.

        Raises:
            RequestError: one was not.
        """
        for camera, missed in zip(self._cameras, before, strict=True):
            names = [name for name, count in camera.missed().items() if count > missed[name]]
            if names:
                raise RequestError(
                    Refusal.FAILED,
                    f"no picture of {', '.join(names)}: the camera process is not running",
                )

    def _answered(self, response: Any, done: int, asked: int) -> Any:
        response.result.result = Result.RESULT_OK
        if done < asked:
            failure = self._loop.lock_step and self._loop.lock_step.failure
            response.result.result = Result.RESULT_OPERATION_FAILED
            response.result.error_message = (
                f"{done} of {asked} steps: {failure or 'the state was changed'}"
            )
        return response
