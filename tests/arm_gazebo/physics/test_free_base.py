"""The arm that stands free on its foot moves when it pushes the ground."""

import numpy as np
import pytest


@pytest.mark.parametrize(("base", "moves"), [("free", True), ("fixed", False)])
def test_a_gripper_that_pushes_the_ground_moves_an_arm_that_stands_free(bench, parts, base, moves):
    arm = bench(parts.arm(base=base, camera="none", effort_limit="300"), base=base)
    foot = arm.built.bodies["base_link"]
    arm.claim()
    arm.command(0.0, 0.0, 0.0, 0.0)
    arm.run(1.0)
    before = arm.simulation.data.xpos[foot].copy()
    arm.command(0.0, 2.4, 0.3, 0.3)
    arm.run(4.0)
    moved = np.linalg.norm(arm.simulation.data.xpos[foot] - before)
    assert (moved > 0.01) == moves
