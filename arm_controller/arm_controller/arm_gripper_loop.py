"""Moves arm and gripper in a loop: move to a target, close, move home, open."""

import logging
from typing import Protocol

from arm_controller.mycobot import CLOSED, HOME, OPEN

TARGET = (1.345, -1.23, 0.264, -0.296, 0.389, -1.5)
"""Positions of the arm's joints (rad)."""
PAUSE_S = 1.0

logger = logging.getLogger(__name__)


class ArmWithGripper(Protocol):
    """The robot that the loop moves.

    Each movement returns when it has ended: None if it reached its goal, else a phrase with the
    reason.
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
        """Return after this time."""
        ...


async def run_for_ever(robot: ArmWithGripper) -> None:
    """Repeat the loop until the task is cancelled."""
    while True:
        await run_once(robot)


async def run_once(robot: ArmWithGripper) -> None:
    """Move arm and gripper to the target and back; first wait until they can be moved.

    The result of each movement is logged. A position that was not reached is logged as an error,
    and the loop goes on.
    """
    await robot.connect()
    await _move_arm(robot, "target", TARGET)
    await _move_gripper(robot, "Closing", CLOSED)
    await _move_arm(robot, "home", HOME)
    await _move_gripper(robot, "Opening", OPEN)
    await robot.pause(PAUSE_S)


async def _move_arm(robot: ArmWithGripper, place: str, positions: tuple[float, ...]) -> None:
    logger.info("Moving to %s position", place)
    failure = await robot.move_arm(positions)
    if failure is None:
        logger.info("Reached %s position - Pausing", place)
    else:
        logger.error("%s position not reached: %s", place.capitalize(), failure)
    await robot.pause(PAUSE_S)


async def _move_gripper(robot: ArmWithGripper, doing: str, position: float) -> None:
    logger.info("%s gripper", doing)
    failure = await robot.move_gripper(position)
    if failure is not None:
        logger.warning("%s gripper: %s", doing, failure)
