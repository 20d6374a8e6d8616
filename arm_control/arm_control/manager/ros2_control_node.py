"""The executable `ros2_control_node`: a controller manager for a description's hardware."""

import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager

from arm_control.errors import ArmControlError
from arm_node.process import NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run the controller manager until it is told to stop; return the exit code."""
    arguments = list(sys.argv if argv is None else argv)

    def application(process: NodeProcess) -> AbstractContextManager[None]:
        # Imported after the environment is prepared, because message packages are found through it.
        from arm_control.manager.ros.control_process import control_process

        return control_process(process, arguments)

    return run_process(application, arguments, (ArmControlError,))


if __name__ == "__main__":
    sys.exit(main())
