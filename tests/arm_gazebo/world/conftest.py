"""Things to spawn, and a running arm whose world is kept."""

from collections.abc import Callable

import numpy as np
import pytest
from robots import crate, joint, link

from arm_gazebo.world.editor import SpawnRequest, WorldEditor
from arm_gazebo.world.spawn_model import ModelSource

LID = link("lid", mass=0.1)
HINGE = joint("hinge", "base", "lid", limits=(-1.5, 1.5), axis="1 0 0", effort=1, velocity=1)
CRATE = crate()
CHEST = crate(LID, HINGE)
LAMP = crate(
    "<link name='world'/><joint name='j' type='{joint}'><parent link='world'/>"
    "<child link='base'/><origin xyz='0 0.5 1' rpy='0 0 1.5707963267948966'/></joint>"
)
POST = crate("<gazebo><static>true</static></gazebo>")
BALL = """<sdf version="1.9"><model name="ball"><link name="body"><collision name="c"><geometry>
  <sphere><radius>0.05</radius></sphere></geometry></collision><visual name="v"><geometry><sphere>
  <radius>0.05</radius></sphere></geometry></visual></link></model></sdf>"""
PUCK = """<mujoco><worldbody><body pos="0 0 5" euler="0 0 90"><freejoint/>
  <geom type="cylinder" size="0.05 0.02" mass="0.1"/></body></worldbody></mujoco>"""


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    """Return a pose (4, 4) without a turn."""
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


class Things:
    """Texts of things, and poses."""

    crate = CRATE
    chest = CHEST
    post = POST
    lamp = LAMP
    ball = BALL
    puck = PUCK
    at = staticmethod(at)


class KeptWorld:
    """An arm in a world, and the editor of that world; the loop is called straight away."""

    def __init__(self, bench, arm: str, world: str, rate_hz: float = 100.0, **options) -> None:
        self.arm = bench(arm, rate_hz, world, **options)
        self.editor = WorldEditor(
            self.arm.simulation,
            lambda function: function(),
            [self.arm.hardware],
            [],
            ModelSource(self.arm.simulation.timing.step_s),
        )

    def spawn(self, name: str, text: str, pose: np.ndarray, frame: str = "", **more) -> str:
        return self.editor.spawn(SpawnRequest(name, "", text, pose, frame, **more))

    def reset(self, spawned: bool) -> None:
        """Return everything to its start; without spawned things if they are to go as well."""
        simulation = self.arm.simulation
        self.editor.undo(spawned, True, lambda: simulation.reset(simulation.time_s))

    def names(self) -> list[str]:
        return [entity.name for entity in self.editor.entities]

    def where(self, entity: str) -> np.ndarray:
        """Return where an entity is now, shape (3,)."""
        return self.editor.motions().of(self.editor.entities.find(entity)).pose[:3, 3]


@pytest.fixture
def things() -> type[Things]:
    return Things


@pytest.fixture
def kept(bench, parts) -> Callable[..., KeptWorld]:
    """Return a maker of kept worlds."""

    def make(
        world: str = "pick_and_place_demo", rate_hz: float = 100.0, robot: str = "", **options
    ) -> KeptWorld:
        return KeptWorld(bench, robot or parts.arm(), world, rate_hz, **options)

    return make
