"""Errors of the library end at the caller's line; faults of the caller's own code stay visible."""

import traceback
from pathlib import Path

import pytest

from arm_control.errors import UnhandledFailureError
from arm_gazebo.errors import RequestError
from arm_sim import CallError, Simulation, UnknownNameError
from arm_sim.user_traceback import ends_at_the_caller


def files_of(error: BaseException) -> list[str]:
    return [Path(frame.filename).name for frame in traceback.extract_tb(error.__traceback__)]


HERE = Path(__file__).name


def test_an_error_of_a_method_ends_here_without_a_cause(sim):
    with pytest.raises(RequestError, match=r"no file for 'can\.sdf'") as raised:
        sim.spawn("can.sdf")
    assert files_of(raised.value) == [HERE]
    assert raised.value.__cause__ is None
    assert "direct cause" not in "".join(traceback.format_exception(raised.value))


def test_so_do_those_of_the_constructor_of_items_and_of_what_items_offer(sim):
    with pytest.raises(Exception, match="nothing_there") as raised:
        Simulation("nothing_there.urdf")
    assert files_of(raised.value) == [HERE]
    with pytest.raises(UnknownNameError, match="position_controler") as raised:
        sim["position_controler"]
    assert files_of(raised.value) == [HERE]
    with pytest.raises(CallError) as raised:
        sim["position_controller"].follow({"times_s": [1.0], "positions": [[0.0]]})
    assert files_of(raised.value) == [HERE]


def test_a_condition_of_the_caller_stays_in_the_traceback(sim):
    def condition() -> bool:
        return bool(sim.contacts("nobody"))

    with pytest.raises(RequestError, match="nobody") as raised:
        sim.run_until(condition, 1.0)
    names = [frame.name for frame in traceback.extract_tb(raised.value.__traceback__)]
    assert names == ["test_a_condition_of_the_caller_stays_in_the_traceback", "condition"]


def fail_as_a_users_controller() -> None:
    raise ZeroDivisionError("the user's fault")


def test_a_cause_in_the_callers_code_stays():
    @ends_at_the_caller
    class Machine:
        def work(self) -> None:
            try:
                fail_as_a_users_controller()
            except ZeroDivisionError as error:
                raise UnhandledFailureError("a controller raised") from error

        def break_down(self) -> None:
            raise AssertionError("a fault of the suite")

    with pytest.raises(UnhandledFailureError) as raised:
        Machine().work()
    cause = raised.value.__cause__
    assert isinstance(cause, ZeroDivisionError)
    assert traceback.extract_tb(cause.__traceback__)[-1].name == "fail_as_a_users_controller"
    with pytest.raises(AssertionError) as fault:
        Machine().break_down()
    assert Path(traceback.extract_tb(fault.value.__traceback__)[0].filename).name == HERE
    assert len(files_of(fault.value)) == 3


def test_arguments_that_do_not_fit_are_shown_where_they_are_given(sim):
    with pytest.raises(TypeError, match="spawn") as raised:
        sim.spawn("can", "can.sdf")  # pyright: ignore[reportCallIssue]
    assert files_of(raised.value) == [HERE]
