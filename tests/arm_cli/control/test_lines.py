"""Output of `arm control` that the black-box tests do not cover."""

import argparse

from controller_manager_msgs.msg import ChainConnection, ControllerState

from arm_cli.control import listing
from arm_cli.control.changing import _impossible
from arm_cli.control.listing import controller_graph
from arm_node.drawing import Edge

UPPER = ControllerState(
    name="upper",
    state="active",
    type="a/Upper",
    update_rate=50,
    required_command_interfaces=["lower/j0/position", "j1/position"],
    required_state_interfaces=["j0/position"],
    chain_connections=[ChainConnection(name="lower", reference_interfaces=["j0/position"])],
)
LOWER = ControllerState(
    name="lower",
    state="inactive",
    type="b/Lower",
    is_chainable=True,
    reference_interfaces=["j0/position"],
    required_command_interfaces=["j0/position"],
)


class Manager:
    """A fake of the running manager."""

    def __init__(self, controllers):
        self._controllers = controllers

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def controllers(self):
        return self._controllers


def printed(capsys, monkeypatch, controllers, *words):
    parser = argparse.ArgumentParser()
    listing.list_controllers.add_arguments(parser)
    monkeypatch.setattr(listing, "ask_manager", lambda _: Manager(controllers))
    listing.list_controllers.run(parser.parse_args(words))
    return capsys.readouterr().out


def test_columns_are_padded(capsys, monkeypatch):
    assert printed(capsys, monkeypatch, [UPPER, LOWER]) == (
        "upper a/Upper  active  \nlower b/Lower  inactive\n"
    )


def test_parts_can_be_requested_one_by_one(capsys, monkeypatch):
    text = printed(capsys, monkeypatch, [UPPER], "--chained-interfaces")
    assert text == "upper a/Upper  active\n\tchained to interfaces:\n\t\tj0/position\n"


def test_exported_states_are_listed_with_the_reference_interfaces(capsys, monkeypatch):
    LOWER.exported_state_interfaces = ["j0/filtered"]
    text = printed(capsys, monkeypatch, [LOWER], "--reference-interfaces")
    assert text == (
        "lower b/Lower  inactive\n\texported reference interfaces:\n\t\tj0/position\n"
        "\texported state interfaces:\n\t\tj0/filtered\n"
    )


def test_no_controllers(capsys, monkeypatch):
    assert printed(capsys, monkeypatch, []) == "No controllers are currently loaded!\n"


def test_states_are_coloured_on_a_terminal_only(capsys, monkeypatch):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert "\033[92mupper\033[0m" in printed(capsys, monkeypatch, [UPPER])


def test_impossible_transitions_are_reported_in_ros2_control_s_words():
    assert _impossible("c", "active", "active") == "cannot activate c from its current state active"
    assert _impossible("c", "active", "unconfigured").startswith("cannot cleanup c from")
    assert _impossible("c", "finalized", "inactive") == (
        "cannot put c in 'inactive' state from its current state finalized"
    )


def test_a_chain_links_the_two_controllers():
    edges = controller_graph([UPPER, LOWER]).edges
    assert Edge("upper", "lower", "lower/j0/position") in edges
    assert Edge("upper", "command interfaces", "j1/position") in edges
    assert Edge("state interfaces", "upper", "j0/position") in edges
