"""The loop of arm and gripper: to a target, close, home, open, and again."""

import logging
from typing import Protocol

from arm_controller.mycobot import CLOSED, HOME, OPEN

TARGET = (1.345, -1.23, 0.264, -0.296, 0.389, -1.5)
"""Positions of the arm's joints (rad)."""
PAUSE_S = 1.0

logger = logging.getLogger(__name__)


class ArmWithGripper(Protocol):
    """What the loop moves.

    A movement returns when it has ended: None where it got there, else a phrase that says why not.
    """

    async def connect(self) -> None:
        """Return once arm and gripper can be moved."""
        ...

    async def move_arm(self, positions: tuple[float, ...]) -> str | None:
        """Move the arm's joints to positions in rad, shape (n,)."""
        ...

    async def move_gripper(self, position: float) -> str | None:
        """Move the gripper's driven joint to a position in rad."""
        ...

    async def pause(self, seconds: float) -> None:
        """Return after some time."""
        ...


class ArmGripperLoop:
    """Moves an arm and its gripper to and fro.

    What is logged about a movement is its result: a place that was not reached is an error, and
    the loop goes on.
    """

    def __init__(self, robot: ArmWithGripper) -> None:
        self._robot = robot

    async def run_for_ever(self) -> None:
        """Go round and round."""
        while True:
            await self.run_once()

    async def run_once(self) -> None:
        """Go round once; waits first for whatever is not there (yet, or any more)."""
        await self._robot.connect()
        await self._move_arm("target", TARGET)
        await self._move_gripper("Closing", CLOSED)
        await self._move_arm("home", HOME)
        await self._move_gripper("Opening", OPEN)
        await self._robot.pause(PAUSE_S)

    async def _move_arm(self, place: str, positions: tuple[float, ...]) -> None:
        logger.info("Moving to %s position", place)
        failure = await self._robot.move_arm(positions)
        if failure is None:
            logger.info("Reached %s position - Pausing", place)
        else:
            logger.error("%s position not reached: %s", place.capitalize(), failure)
        await self._robot.pause(PAUSE_S)

    async def _move_gripper(self, doing: str, position: float) -> None:
        logger.info("%s gripper", doing)
        failure = await self._robot.move_gripper(position)
        if failure is not None:
            logger.warning("%s gripper: %s", doing, failure)
