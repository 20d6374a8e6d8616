"""The errors of this package, each with the code that MoveIt gives to it.

PlanningError            a request that cannot be answered, or a plan that was not found
├── SrdfError            an SRDF that cannot be used
├── SettingError         a parameter, or a file of a MoveIt configuration, that cannot be used
├── InvalidRequestError  a request, or a command, that cannot be used
├── NoPlanError          there is no plan
├── InvalidGoalError     a goal or a constraint that cannot be used
├── InvalidPlanError     a motion that cannot be planned as it is described
├── InvalidStateError    a state that the robot cannot be in, or that is not known
├── InvalidLinkError     a link that does not exist
├── InvalidObjectError   an object that does not exist, or that cannot be used
├── ControlError         a motion that no controllers take, or that they gave up
├── PerceptionError      a view in which nothing can be found
└── MissingOmplError     OMPL is not installed
"""

from enum import IntEnum
from typing import ClassVar


class MoveItErrorCode(IntEnum):
    """The values of moveit_msgs/MoveItErrorCodes."""

    SUCCESS = 1
    UNDEFINED = 0
    FAILURE = 99999
    PLANNING_FAILED = -1
    INVALID_MOTION_PLAN = -2
    MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE = -3
    CONTROL_FAILED = -4
    UNABLE_TO_AQUIRE_SENSOR_DATA = -5
    TIMED_OUT = -6
    PREEMPTED = -7
    START_STATE_IN_COLLISION = -10
    START_STATE_VIOLATES_PATH_CONSTRAINTS = -11
    GOAL_IN_COLLISION = -12
    GOAL_VIOLATES_PATH_CONSTRAINTS = -13
    GOAL_CONSTRAINTS_VIOLATED = -14
    INVALID_GROUP_NAME = -15
    INVALID_GOAL_CONSTRAINTS = -16
    INVALID_ROBOT_STATE = -17
    INVALID_LINK_NAME = -18
    INVALID_OBJECT_NAME = -19
    FRAME_TRANSFORM_FAILURE = -21
    COLLISION_CHECKING_UNAVAILABLE = -22
    ROBOT_STATE_STALE = -23
    SENSOR_INFO_STALE = -24
    COMMUNICATION_FAILURE = -25
    START_STATE_INVALID = -26
    GOAL_STATE_INVALID = -27
    UNRECOGNIZED_GOAL_TYPE = -28
    CRASH = -29
    ABORT = -30
    NO_IK_SOLUTION = -31


class PlanningError(Exception):
    """A request that cannot be answered; the message is a sentence for the user.

    Attributes:
        code: MoveIt's code of the failure.
    """

    def __init__(self, code: MoveItErrorCode, message: str) -> None:
        super().__init__(message)
        self.code = code


class _CodedError(PlanningError):
    """An error whose kind has a code of its own."""

    CODE: ClassVar[MoveItErrorCode] = MoveItErrorCode.FAILURE

    def __init__(self, message: str) -> None:
        super().__init__(self.CODE, message)


class SrdfError(_CodedError):
    """An SRDF that cannot be used; the message names the element and its line."""


class SettingError(_CodedError):
    """A parameter, or a file of a MoveIt configuration, that cannot be used."""


class InvalidRequestError(_CodedError):
    """A request, or a command, that cannot be used."""


class NoPlanError(_CodedError):
    """There is no plan."""

    CODE = MoveItErrorCode.PLANNING_FAILED


class InvalidGoalError(_CodedError):
    """A goal or a constraint that cannot be used."""

    CODE = MoveItErrorCode.INVALID_GOAL_CONSTRAINTS


class InvalidPlanError(_CodedError):
    """A motion that cannot be planned as it is described."""

    CODE = MoveItErrorCode.INVALID_MOTION_PLAN


class InvalidStateError(_CodedError):
    """A state that the robot cannot be in, or that is not known."""

    CODE = MoveItErrorCode.INVALID_ROBOT_STATE


class InvalidLinkError(_CodedError):
    """A link that does not exist."""

    CODE = MoveItErrorCode.INVALID_LINK_NAME


class InvalidObjectError(_CodedError):
    """An object that does not exist, or that cannot be used."""

    CODE = MoveItErrorCode.INVALID_OBJECT_NAME


class ControlError(_CodedError):
    """A motion that no controllers take, or that they gave up."""

    CODE = MoveItErrorCode.CONTROL_FAILED


class PerceptionError(_CodedError):
    """A camera's view in which nothing can be found."""

    CODE = MoveItErrorCode.UNABLE_TO_AQUIRE_SENSOR_DATA


class MissingOmplError(PlanningError):
    """OMPL is not installed."""

    def __init__(self) -> None:
        super().__init__(
            MoveItErrorCode.PLANNING_FAILED,
            "OMPL's planners need the package ompl: pip install 'arm-suite[ompl]'",
        )
