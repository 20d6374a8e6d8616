"""Services are asked again and again only while a browser shows the answers."""

import pytest

from arm_viewer.requests import LookAtThing, OpenWorld
from arm_viewer.ros import controller_observer, run_observer, world_client
from arm_viewer.ros.controller_observer import ControllerObserver
from arm_viewer.ros.run_observer import RunObserver
from arm_viewer.ros.world_client import WorldClient

LIST = "/controller_manager/list_controllers"


class Node:
    """A graph with a simulation and a controller manager."""

    services = 1

    def count_services(self, name):
        return self.services

    def get_service_names_and_types(self):
        return [(LIST, [controller_observer.SERVICE_TYPE])]


@pytest.fixture
def asked(monkeypatch):
    """Return the services that were asked; those that are not looked at do not answer."""
    asked = []

    class Caller:
        def __init__(self, node, service_class, service, max_wait_s=0.0):
            self.service = service
            self.is_pending = False

        def ask(self, request, then):
            asked.append(self.service)
            self.is_pending = True
            return True

        def is_overdue(self):
            return self.is_pending

        def forget(self):
            self.is_pending = False

        def close(self):
            pass

    for module in (controller_observer, run_observer, world_client):
        monkeypatch.setattr(module, "ServiceCaller", Caller)
    return asked


@pytest.mark.parametrize("observer_class", [RunObserver, WorldClient])
def test_the_simulation_is_asked_only_while_somebody_watches(asked, observer_class):
    watched = [False]
    observer = observer_class(Node(), lambda: watched[0])
    observer.discover({})
    observer.collect(1.0)
    assert asked == []
    watched[0] = True
    observer.discover({})
    observer.collect(2.0)
    assert asked


def test_a_thing_is_not_looked_at_any_more_when_the_simulation_has_gone(asked):
    node = Node()
    client = WorldClient(node, lambda: True)
    client.discover({})
    client.serve(LookAtThing("crate"))
    client.collect(1.0)
    assert "/get_entity_state" in asked
    asked.clear()
    node.services = 0
    client.discover({})
    client.collect(2.0)
    assert (client.view, asked) == (None, [])


def test_a_change_without_an_answer_is_said_once_and_without_another_change(asked):
    client = WorldClient(Node(), lambda: True)
    client.discover({})
    client.serve(OpenWorld("file:///shapes"))
    client.collect(1.0)
    assert (asked[-1], client.view.answer.text) == ("/load_world", "")
    client.collect(2.0)
    client.collect(3.0)
    answer = client.view.answer
    assert (answer.number, answer.is_done) == (1, False)
    assert answer.text == "/load_world did not answer within 60 s"


def test_controllers_are_known_before_somebody_watches(asked):
    observer = ControllerObserver(Node(), lambda: False)
    observer.discover({})
    assert asked == [LIST]
