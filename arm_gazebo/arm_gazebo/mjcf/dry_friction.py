"""How firmly MuJoCo's dry friction of joints holds.

MuJoCo's friction is a constraint that yields: below the friction, a joint creeps at a speed in
proportion to its load. `sticking` is the firmest that MuJoCo takes. A joint under nine tenths of
its friction then creeps by 0.2 mrad in 10 s where a link hangs 0.1 m from its axis, and by 2 mrad
at 1 cm; by MuJoCo's default, by 0.9 rad and 1.6 rad. It does not chatter.

`yielding` is for a joint that a servo holds: a friction that sticks would hold it away from its
set-point, by up to the friction over the stiffness. MuJoCo's default yields more than is good:
a light joint feels little of it at low speeds, and a servo that makes up for it overshoots.
"""

import mujoco

from arm_node.frozen import frozen


@frozen
class FrictionSolver:
    """Parameters of MuJoCo's solver for the friction of a degree of freedom.

    Attributes:
        solref: time constant in s, at least two steps, and damping ratio.
        solimp: impedance; the first two numbers are what counts.
    """

    solref: tuple[float, float]
    solimp: tuple[float, float, float, float, float]

    def apply(self, model: mujoco.MjModel, dof: int) -> None:
        """Set them while the model runs."""
        model.dof_solref[dof] = self.solref
        model.dof_solimp[dof] = self.solimp


YIELD = 0.1 / 0.9
"""Softness of a friction that yields, for a joint without a rotor: an impedance of 0.9."""


def sticking(step_s: float) -> FrictionSolver:
    """Return the firmest solver at this physics step."""
    return FrictionSolver((2.0 * step_s, 1.0), (0.9999, 0.9999, 0.001, 0.5, 2.0))


def yielding(inverse_inertia: float, rotor: float) -> FrictionSolver:
    """Return the solver for a joint that a servo holds.

    Args:
        inverse_inertia: MuJoCo's `dof_invweight0`, from which its solver takes how far a friction
            yields; it does not know the rotor.
        rotor: the inertia that the servo adds.
    """
    impedance = 1.0 / (1.0 + YIELD / (1.0 + inverse_inertia * rotor))
    return FrictionSolver((0.006, 1.0), (impedance, max(impedance, 0.95), 0.001, 0.5, 2.0))
