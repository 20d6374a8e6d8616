"""Errors and warnings of the library: they show the caller's lines, not the suite's."""

import sys
import warnings
from collections.abc import Callable
from functools import wraps
from inspect import isfunction
from types import FrameType, TracebackType
from typing import Any, TypeVar

from arm_control.errors import ArmControlError
from arm_description.errors import DescriptionError
from arm_gazebo.errors import GazeboError
from arm_node.parameter_values import ParameterValueError
from arm_sim.errors import ArmSimError

ClassT = TypeVar("ClassT", bound=type)

USER_ERRORS = (ArmSimError, DescriptionError, GazeboError, ArmControlError, ParameterValueError)
"""Errors whose message says all; any other one is a fault of the suite, and shows where."""
_SUITE = {"arm_sim", "arm_gazebo", "arm_control", "arm_description", "arm_node"}
_SPECIAL = {"__init__", "__getitem__"}


def ends_at_the_caller(cls: ClassT) -> ClassT:
    """Make the tracebacks of a class's public methods and properties end at the caller's line.

    Frames of a user's own code stay, such as those of a controller that raised.
    """
    for name, member in list(vars(cls).items()):
        if name.startswith("_") and name not in _SPECIAL:
            continue
        if isfunction(member):
            setattr(cls, name, _shortened(member))
        elif isinstance(member, property) and member.fget is not None:
            setattr(cls, name, property(_shortened(member.fget), member.fset, doc=member.__doc__))
    return cls


def warn_caller(message: str) -> None:
    """Give a Python warning at the line that called the library."""
    level, frame = 1, sys._getframe()  # pyright: ignore[reportPrivateUsage]
    while frame is not None and _is_suite(frame):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, stacklevel=level)


def _shortened(function: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(function)
    def call(*arguments: Any, **keywords: Any) -> Any:
        try:
            return function(*arguments, **keywords)
        except USER_ERRORS as error:
            _hide_suite(error)
            raise
        except TypeError as error:
            # No frame below this one: the arguments do not fit, which is the caller's mistake.
            if error.__traceback__ is not None and error.__traceback__.tb_next is None:
                _hide_suite(error)
            raise

    return call


def _hide_suite(error: BaseException) -> None:
    """Remove the suite's frames from an error and from its causes."""
    error.__traceback__ = _of_others(error.__traceback__)
    cause = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    if cause is not None:
        _hide_suite(cause)
        if cause.__traceback__ is None:
            error.__cause__, error.__suppress_context__ = None, True


def _of_others(traceback: TracebackType | None) -> TracebackType | None:
    if traceback is None:
        return None
    rest = _of_others(traceback.tb_next)
    if _is_suite(traceback.tb_frame):
        return rest
    return TracebackType(rest, traceback.tb_frame, traceback.tb_lasti, traceback.tb_lineno)


def _is_suite(frame: FrameType) -> bool:
    return frame.f_globals.get("__name__", "").partition(".")[0] in _SUITE
