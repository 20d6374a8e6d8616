"""The executable `arm_gazebo_node`: the simulated robot and its controller manager."""

import os
import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager

from arm_control.errors import ArmControlError
from arm_description.errors import DescriptionError
from arm_gazebo.errors import GazeboError
from arm_node.process import NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run the simulation until it is told to stop; return the exit code."""
    arguments = list(sys.argv if argv is None else argv)

    def application(process: NodeProcess) -> AbstractContextManager[None]:
        # This process draws nothing. Without this setting MuJoCo loads a window library, in 50 ms.
        os.environ.setdefault("MUJOCO_GL", "disabled")
        # Imported only after the environment is prepared, because it locates the message packages.
        from arm_gazebo.ros.simulation_process import simulation_process

        return simulation_process(process, arguments)

    return run_process(application, arguments, (GazeboError, ArmControlError, DescriptionError))


if __name__ == "__main__":
    sys.exit(main())
