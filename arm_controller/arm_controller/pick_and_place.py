"""Picks an object up, holds it, and puts it back where it was."""

import logging
from dataclasses import dataclass
from typing import Protocol

from arm_controller.errors import PickError
from arm_controller.joint_path import JointPath
from arm_controller.mycobot import CLOSED, WIDE_OPEN
from arm_controller.pick_plan import PickPlan

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Grip:
    """The result of a gripper movement.

    Attributes:
        position: position of the driven joint, in rad.
        reached: whether it reached its goal.
        stalled: whether something between the fingers stopped it.
    """

    position: float
    reached: bool
    stalled: bool


class PickingRobot(Protocol):
    """An arm with a gripper. Each movement returns when it has ended."""

    async def connect(self) -> None:
        """Return once arm and gripper can be moved."""
        ...

    async def follow(self, path: JointPath) -> str | None:
        """Move the arm; return None if it reached its goal, else a phrase with the reason."""
        ...

    async def grip(self, position: float, max_effort: float) -> Grip | str:
        """Move the gripper to a position (rad); return a phrase if there is no result."""
        ...

    async def pause(self, seconds: float) -> None:
        """Return after some time."""
        ...


class PickAndPlace:
    """Executes a plan and logs each step.

    Fingers that close fully hold nothing; fingers that stop earlier hold the object.
    """

    def __init__(self, robot: PickingRobot, plan: PickPlan) -> None:
        self._robot = robot
        self._plan = plan

    async def run(self) -> None:
        """Pick up, hold and put back the object once, then move the arm home.

        Raises:
            PickError: a step failed and the robot stopped; the message says which and why.
        """
        plan, task = self._plan, self._plan.task
        await self._robot.connect()
        await self._open()
        await self._go("to the object", plan.to_object)
        await self._go("around the object", plan.approach)
        await self._close("Closing gripper")
        await self._go(f"up by {task.lift:g} m", plan.up)
        logger.info("Holding for %g s", task.hold_s)
        await self._robot.pause(task.hold_s)
        await self._close("Checking whether the object is still held")
        await self._go("down again", plan.down)
        await self._open()
        await self._go("away", plan.away)
        await self._go("to home position", plan.home)
        logger.info("The object was picked up, held and put back")

    async def _go(self, where: str, path: JointPath) -> None:
        logger.info("Moving %s", where)
        failure = await self._robot.follow(path)
        if failure is not None:
            raise PickError(f"the arm could not move {where}: {failure}")

    async def _open(self) -> None:
        logger.info("Opening gripper")
        grip = await self._grip(WIDE_OPEN)
        if not grip.reached:
            raise PickError(f"the gripper did not open: it is at {grip.position:.3f} rad")

    async def _close(self, doing: str) -> None:
        logger.info("%s", doing)
        grip = await self._grip(CLOSED)
        if grip.reached:
            raise PickError("there is nothing between the fingers: they closed all the way")
        if not grip.stalled:
            raise PickError(
                f"the grip ended at {grip.position:.3f} rad: another node moves the gripper"
            )
        logger.info("The object is held, at %.3f rad", grip.position)

    async def _grip(self, position: float) -> Grip:
        grip = await self._robot.grip(position, self._plan.task.max_effort)
        if isinstance(grip, str):
            raise PickError(f"the gripper did not move: {grip}")
        return grip
