"""The errors of this package.

ArmSimError
├── UnknownNameError  a controller, joint, camera or sensor that the simulation does not have
├── MissingPackageError  an optional package that is needed is not installed
├── CallError         a method that cannot be called now, or an argument that cannot be used
│   └── ArgumentsError    arguments of a simulation that do not fit; also a TypeError
├── BenchError        what a test requests and the bench cannot do
└── GoalError         a goal that was rejected, failed or did not end in time

Everything else that goes wrong raises the error that ends or warns the node, with its sentence:
`arm_description.DescriptionError` of a robot description, `arm_gazebo.errors.GazeboError` of a
world or a request to it, and `arm_control.ArmControlError` of a controller or its parameters.
"""

from arm_control.controllers.goals import GoalOutcome


class ArmSimError(Exception):
    """Root of the errors that this package adds; the message is for the user."""


class UnknownNameError(ArmSimError, KeyError):
    """The simulation has nothing of that name; the message says what it has."""

    def __str__(self) -> str:
        # KeyError would show the message in quotes.
        return str(self.args[0])


class BenchError(ArmSimError):
    """The test bench cannot do what a test requests; the message says why."""


class MissingPackageError(ArmSimError, ImportError):
    """A required optional package is not installed; the message tells how to install it."""

    def __init__(self, package: str, extra: str) -> None:
        super().__init__(f"{package} is not installed; pip install 'arm-suite[{extra}]'")


class CallError(ArmSimError):
    """A method cannot be called now, or an argument cannot be used."""


class ArgumentsError(CallError, TypeError):
    """Arguments that do not fit: one that is unknown, missing or given twice."""


class GoalError(ArmSimError):
    """A goal was rejected, failed, or did not end in time.

    Attributes:
        outcome: the state in which it ended; None if it was rejected or has not ended.
        code: the error code of control_msgs/action/FollowJointTrajectory; None if the action has
            none.
    """

    def __init__(
        self, message: str, outcome: GoalOutcome | None = None, code: int | None = None
    ) -> None:
        super().__init__(message)
        self.outcome = outcome
        self.code = code
