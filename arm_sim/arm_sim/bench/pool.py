"""The simulations of a test session: built once, restored for each later test."""

from typing import Any

from arm_control.errors import StateError
from arm_gazebo.world.refusal import RequestError
from arm_sim.bench.configuration import configuration_key
from arm_sim.bench.simulation import BenchSimulation
from arm_sim.errors import CallError


class SimulationPool:
    """Gives each test a simulation of its configuration, in its initial state."""

    def __init__(self) -> None:
        self._built: dict[str, BenchSimulation] = {}

    def take(self, arguments: dict[str, Any]) -> BenchSimulation:
        """Return a simulation in its initial state.

        Args:
            arguments: those of `BenchSimulation`.

        Raises:
            DescriptionError, GazeboError, ArmControlError, ParameterValueError: it cannot be built.
        """
        key = configuration_key(arguments)
        known = self._built.pop(key, None)
        simulation = known if known is not None and _is_restored(known) else None
        self._built[key] = simulation = simulation or BenchSimulation(**arguments)
        return simulation

    def close(self) -> None:
        """Close all of them."""
        for simulation in self._built.values():
            simulation.close()
        self._built.clear()


def _is_restored(simulation: BenchSimulation) -> bool:
    """Bring a simulation back to its start; if that is impossible, close it and return False."""
    try:
        simulation.reset(simulation.first_seed)
    except (StateError, CallError, RequestError):
        # The state of a controller cannot be saved, or a test has closed the simulation.
        simulation.close()
        return False
    return True
