"""Errors of arm_control.

ArmControlError
├── HardwareInfoError      a <ros2_control> block that cannot be used
├── RegistryError          a controller or hardware type that is unknown or cannot be loaded
├── ParameterError         a parameter of a controller that is missing or wrong
├── ControllerError        a controller refuses a life-cycle transition
├── ControllerManagerError the manager refuses a request
├── StateError             a state that cannot be saved or restored
├── UnhandledFailureError  a controller or component raised, and the process must end
├── LoopStoppedError       a call to a control loop that has ended
├── ManagerUnreachableError a controller manager that is not running or does not answer
├── SpawnError             a step of a spawner that failed
└── WaitInterruptedError   a wait that ended early because the process is shutting down
"""


class ArmControlError(Exception):
    """Root of every error that this package raises; the message is for the user."""


class HardwareInfoError(ArmControlError):
    """A `<ros2_control>` block is missing, incomplete or contradictory."""


class RegistryError(ArmControlError):
    """No installed package provides the controller or hardware type, or its import fails."""


class ParameterError(ArmControlError):
    """A parameter of a controller is missing, of the wrong type or out of its range."""


class ControllerError(ArmControlError):
    """Raised by a controller's life-cycle method to refuse a transition; the message says why."""


class ControllerManagerError(ArmControlError):
    """The manager refuses a request; the message says why and what exists."""


class StateError(ArmControlError):
    """A state cannot be saved or restored; the message says whose, and why."""


class UnhandledFailureError(ArmControlError):
    """A controller or component raised in a cycle while `handle_exceptions` is false."""


class LoopStoppedError(ArmControlError):
    """The control loop has ended, so it cannot run the function passed to it."""


class ManagerUnreachableError(ArmControlError):
    """The controller manager is not running or does not answer."""


class SpawnError(ArmControlError):
    """A step of a spawner failed; the message says which."""


class WaitInterruptedError(ArmControlError):
    """The process was told to shut down while it waited."""
