"""Inputs of a run: the calls by which something outside the run changes it.

A run of a simulation repeats to the last bit if the same inputs take effect between the same two
ticks. A method marked with `run_input` is such an input. Usually it is an ordinary method. While a
run is recorded, each call goes through a gate, which runs it on the loop thread between two ticks
and notes it.
"""

import inspect
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, Concatenate, ParamSpec, Protocol, TypeGuard, TypeVar

ArgumentsT = ParamSpec("ArgumentsT")
ResultT = TypeVar("ResultT")


class InputGate(Protocol):
    """Stands between a run and its inputs while the run is recorded."""

    def give(
        self,
        target: object,
        method: str,
        arguments: Mapping[str, object],
        act: Callable[[], ResultT],
        /,
    ) -> ResultT:
        """Run an input between two ticks, note it, and return its result. Any thread.

        The arguments are plain data by name, without `self`; `act` calls the method.
        """
        ...


class InputTarget(Protocol):
    """An object with inputs.

    Attributes:
        input_gate: notes the inputs; None while the run is not recorded.
    """

    input_gate: InputGate | None


TargetT = TypeVar("TargetT", bound=InputTarget)
Input = Callable[Concatenate[TargetT, ArgumentsT], ResultT]

_MARK = "_is_run_input"


def is_run_input(method: object) -> TypeGuard[Callable[..., object]]:
    """Return whether `run_input` marks a method; a file may call no other."""
    return getattr(method, _MARK, False) is True


def run_input(method: Input[TargetT, ArgumentsT, ResultT]) -> Input[TargetT, ArgumentsT, ResultT]:
    """Mark a method as an input; its arguments must be plain values, see `state.encoding`."""
    return run_input_noted_as(lambda arguments: arguments)(method)


def run_input_noted_as(
    note: Callable[[Mapping[str, Any]], Mapping[str, object]],
) -> Callable[[Input[TargetT, ArgumentsT, ResultT]], Input[TargetT, ArgumentsT, ResultT]]:
    """Mark a method as an input whose arguments are not plain data.

    `note` returns the plain data to note instead of the arguments by name.
    """

    def mark(method: Input[TargetT, ArgumentsT, ResultT]) -> Input[TargetT, ArgumentsT, ResultT]:
        signature = inspect.signature(method)

        @wraps(method)
        def given(self: TargetT, *args: ArgumentsT.args, **kwargs: ArgumentsT.kwargs) -> ResultT:
            gate = self.input_gate
            if gate is None:
                return method(self, *args, **kwargs)
            arguments = dict(signature.bind(self, *args, **kwargs).arguments)
            del arguments["self"]
            noted = note(arguments)
            return gate.give(self, method.__name__, noted, lambda: method(self, *args, **kwargs))

        setattr(given, _MARK, True)
        return given

    return mark
