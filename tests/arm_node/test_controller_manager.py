"""The client of a controller manager: what it asks, and how it tells that a change was made."""

import pytest
from controller_manager_msgs.msg import ControllerState, HardwareComponentState
from lifecycle_msgs.msg import State

from arm_node.controller_manager import SERVICES, ControllerManagerClient

INACTIVE = State(id=State.PRIMARY_STATE_INACTIVE, label="inactive")


class ManagerWithoutAnswers:
    """Answers questions; of a change it tells only whether it counts as made by now."""

    def __init__(self) -> None:
        self.states = {"arm": "active", "grip": "inactive", "base": "unconfigured"}
        self.requests = []

    def query(self, service, request):
        response = SERVICES[service].Response()
        if service == "list_controllers":
            states = self.states.items()
            response.controller = [ControllerState(name=n, state=s) for n, s in states]
        elif service == "list_hardware_components":
            response.component = [HardwareComponentState(name="hand", state=INACTIVE)]
        elif service == "list_parameters":
            response.result.names = ["update_rate", "grip.type", "arm.type"]
        return response

    def change(self, service, request, is_done):
        self.requests.append(request)
        return SERVICES[service].Response(ok=is_done())


@pytest.fixture
def manager():
    return ManagerWithoutAnswers()


@pytest.fixture
def client(manager):
    return ControllerManagerClient(manager)


@pytest.mark.parametrize(
    ("is_made", "change"),
    [
        (True, lambda client: client.load("arm")),
        (False, lambda client: client.load("new")),
        (True, lambda client: client.configure("grip")),
        (False, lambda client: client.configure("base")),
        (True, lambda client: client.cleanup("base")),
        (False, lambda client: client.cleanup("grip")),
        (True, lambda client: client.unload("new")),
        (False, lambda client: client.unload("arm")),
        (False, lambda client: client.reload_libraries(force_kill=True)),
        (True, lambda client: client.switch(["arm"], ["grip"]).ok),
        (False, lambda client: client.switch(["arm", "grip"]).ok),
        (False, lambda client: client.switch(deactivate=["arm", "grip"]).ok),
        (True, lambda client: client.set_component_state("hand", "inactive").ok),
        (False, lambda client: client.set_component_state("hand", "active").ok),
    ],
)
def test_the_state_of_the_manager_tells_whether_a_change_was_made(client, is_made, change):
    assert change(client) is is_made


def test_a_switch_is_strict_and_takes_its_time_in_seconds_and_nanoseconds(client, manager):
    client.switch(["grip"], ["arm"], timeout_s=1.25)
    (request,) = manager.requests
    assert (request.activate_controllers, request.deactivate_controllers) == (["grip"], ["arm"])
    assert request.strictness == request.STRICT
    assert request.activate_asap
    assert (request.timeout.sec, request.timeout.nanosec) == (1, 250_000_000)


def test_what_can_be_loaded_has_a_type(client):
    assert client.loadable() == ["arm", "grip"]
