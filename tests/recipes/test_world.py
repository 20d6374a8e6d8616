"""The recipe for a world: a ball above a floor."""

from checkout import Checkout

WORLD = """\
<mujoco model="ball">
  <worldbody>
    <geom name="floor" type="plane" size="0 0 0.5"/>
    <body name="ball" pos="0.5 0 1">
      <freejoint/>
      <geom type="sphere" size="0.05" mass="0.1"/>
    </body>
  </worldbody>
</mujoco>
"""

SCRIPT = """\
import mujoco
from arm_gazebo.launching.world_path import find_world, shipped_worlds
from arm_gazebo.model.world_file import load_world

model = load_world(sys.argv[1]).compile()
data = mujoco.MjData(model)
while data.time < 1.0:
    mujoco.mj_step(model, data)
print(*shipped_worlds())
print(round(data.body("ball").xpos[2], 2))
"""


def test_a_world_is_added_through_the_file_of_its_recipe(tmp_path):
    checkout = Checkout(tmp_path, "A world", NAME="ball")
    checkout.write("arm_gazebo/worlds/ball.xml", WORLD)

    worlds, height = checkout.run(SCRIPT, "ball").splitlines()
    assert {"ball", "empty"} <= set(worlds.split())
    assert float(height) == 0.05
