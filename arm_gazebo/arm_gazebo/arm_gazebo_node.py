"""The executable `arm_gazebo_node`: the simulated robot and its controller manager."""

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager

from arm_control.errors import ArmControlError
from arm_description.errors import DescriptionError
from arm_gazebo.errors import GazeboError
from arm_node.process import NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run the simulation until it is told to stop; return the exit code."""
    arguments = list(sys.argv if argv is None else argv)

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        with _simulation(process, arguments):
            yield

    return run_process(application, arguments, (GazeboError, ArmControlError, DescriptionError))


def _simulation(process: NodeProcess, arguments: list[str]) -> AbstractContextManager[None]:
    # This process draws nothing; MuJoCo would load a window library all the same, in 50 ms.
    os.environ.setdefault("MUJOCO_GL", "disabled")
    # Imported once the environment is prepared: message packages are found through it.
    from arm_gazebo.ros.simulation_process import simulation_process

    return simulation_process(process, arguments)


if __name__ == "__main__":
    sys.exit(main())
