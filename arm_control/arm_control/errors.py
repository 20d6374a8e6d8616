"""Errors of arm_control.

ArmControlError
├── HardwareInfoError      a <ros2_control> block that cannot be used
├── RegistryError          a controller or hardware type that is not known or not loadable
├── ParameterError         a parameter of a controller that is missing or wrong
├── ControllerError        a controller refuses a step of its life cycle
├── ControllerManagerError the manager refuses what was asked of it
├── UnhandledFailureError  a controller or component raised, and nobody is to catch it
├── LoopStoppedError       a call to a control loop that runs no more
├── ManagerUnreachableError a controller manager that is not there, or does not answer
├── SpawnError             a step of a spawner that failed
└── WaitInterruptedError   a wait that was given up because the process is to end
"""


class ArmControlError(Exception):
    """Root of every error that this package raises; the message is for the user."""


class HardwareInfoError(ArmControlError):
    """A `<ros2_control>` block is missing, incomplete or contradictory."""


class RegistryError(ArmControlError):
    """No installed package offers the controller or hardware type, or it cannot be imported."""


class ParameterError(ArmControlError):
    """A parameter of a controller is missing, of the wrong type or out of its range."""


class ControllerError(ArmControlError):
    """Raised by a controller's life-cycle method to refuse, with the reason."""


class ControllerManagerError(ArmControlError):
    """The manager refuses a request; the message says why and what exists."""


class UnhandledFailureError(ArmControlError):
    """A controller or component raised in a cycle, and the manager is told not to catch it."""


class LoopStoppedError(ArmControlError):
    """The control loop has ended, so it will not run the function handed to it."""


class ManagerUnreachableError(ArmControlError):
    """The controller manager is not there, or does not answer."""


class SpawnError(ArmControlError):
    """A step failed; the message says which."""


class WaitInterruptedError(ArmControlError):
    """The process was told to end while it waited."""
