"""A node answers requests for parameters of a type that does not exist."""

from types import SimpleNamespace

import pytest
from rcl_interfaces.msg import Parameter, ParameterValue, SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.parameter_service import ParameterService

from arm_node.workarounds.parameter_types import refuse_unknown_parameter_types

pytestmark = pytest.mark.workaround("parameter_types")

STRANGE = Parameter(name="x\n", value=ParameterValue(type=77))
GOOD = Parameter(name="y", value=ParameterValue(type=2, integer_value=3))
REASON = r"parameter 'x\n' has type 77; the types are 0 to 9"


@pytest.fixture
def node(monkeypatch):
    """A stand-in for the node that records its calls."""
    for name in ("_set_parameters_callback", "_set_parameters_atomically_callback"):
        monkeypatch.setattr(ParameterService, name, getattr(ParameterService, name))
    refuse_unknown_parameter_types()
    taken = []

    def set_parameters_atomically(parameters):
        taken.extend((parameter.name, parameter.value) for parameter in parameters)
        return SetParametersResult(successful=True)

    return SimpleNamespace(set_parameters_atomically=set_parameters_atomically, taken=taken)


def answer(node, callback, service, parameters):
    fake = SimpleNamespace(_get_node=lambda: node)
    return callback(fake, service.Request(parameters=parameters), service.Response())


def test_each_parameter_is_answered_for_itself(node):
    response = answer(
        node, ParameterService._set_parameters_callback, SetParameters, [STRANGE, GOOD]
    )
    assert [(result.successful, result.reason) for result in response.results] == [
        (False, REASON),
        (True, ""),
    ]
    assert node.taken == [("y", 3)]


def test_an_atomic_request_sets_none_of_its_parameters(node):
    callback = ParameterService._set_parameters_atomically_callback
    response = answer(node, callback, SetParametersAtomically, [GOOD, STRANGE])
    assert (response.result.successful, response.result.reason) == (False, REASON)
    assert node.taken == []
    assert answer(node, callback, SetParametersAtomically, [GOOD]).result.successful
