"""`arm lifecycle set`: take a managed node through a transition."""

import argparse
from typing import TYPE_CHECKING

from arm_cli.errors import NotFoundError, UnansweredError
from arm_cli.lifecycle.managed_nodes import add_node_argument, managed_node
from arm_cli.ros.connection import connect
from launch_py.near_names import describe_known

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lifecycle_msgs.msg import Transition, TransitionDescription


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    parser.add_argument("transition", help="its label, such as configure, or its id")


def run(options: argparse.Namespace) -> None:
    """Ask for the transition, and say that it was done.

    Raises:
        NotFoundError: there is no such node or transition now, or the node has no lifecycle.
        UnansweredError: the node does not answer, or its transition failed.
    """
    with connect() as session:
        from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions

        from arm_cli.ros.graph import Graph
        from arm_cli.ros.service_call import call_service

        node = managed_node(Graph(session), options.node_name)
        answer = call_service(
            session,
            GetAvailableTransitions,
            f"{node.full_name}/get_available_transitions",
            GetAvailableTransitions.Request(),
        )
        transition = _find(options.transition, node.full_name, answer.available_transitions)
        request = ChangeState.Request(transition=transition)
        done = call_service(session, ChangeState, f"{node.full_name}/change_state", request)
    if not done.success:
        raise UnansweredError(f"Transitioning failed: {node.full_name} did not {transition.label}")
    print("Transitioning successful")


def _find(word: str, node: str, available: "Sequence[TransitionDescription]") -> "Transition":
    transitions = [description.transition for description in available]
    for transition in transitions:
        if word in (transition.label, str(transition.id)):
            return transition
    known = describe_known(word, [transition.label for transition in transitions])
    raise NotFoundError(f"no transition {word!r} of {node} as it is now; {known}")
