"""`arm lifecycle`: managed nodes, which serve `get_state`, and their transitions."""

import argparse
from typing import TYPE_CHECKING

from arm_cli.arguments import JSON, Argument, Flag, verb
from arm_cli.errors import NoSuchNameError, UnansweredError
from arm_cli.output import complain, say, say_answer
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_node.names import describe_known

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lifecycle_msgs.msg import Transition, TransitionDescription

    from arm_cli.ros.graph import Graph, NodeName

STATE_TYPE = "lifecycle_msgs/srv/GetState"


NODE = (
    Argument(
        "node_name", completer=completers.nodes, help="a node that `arm lifecycle nodes` lists"
    ),
    # Accepted because command lines for ros2 use it. A named node may always be hidden here.
    Flag("--include-hidden-nodes", help=argparse.SUPPRESS),
)
"""The name of one managed node."""


def managed_nodes(graph: "Graph", hidden: bool = False) -> "list[NodeName]":
    """Return the managed nodes, once the graph has settled."""
    graph.settle()
    services = graph.services(hidden=True)
    return [
        node
        for node in graph.nodes(hidden)
        if STATE_TYPE in services.get(f"{node.full_name}/get_state", [])
    ]


def managed_node(graph: "Graph", name: str) -> "NodeName":
    """Return the managed node with this name.

    Raises:
        NoSuchNameError: there is no such node, or it has no lifecycle.
    """
    node = graph.find_node(name)
    managed = managed_nodes(graph, hidden=True)
    if node not in managed:
        hint = describe_known(node.full_name, (n.full_name for n in managed), "managed nodes:")
        raise NoSuchNameError(f"{node.full_name} has no lifecycle; {hint}")
    return node


@verb(
    Flag("-a", "--all", dest="hidden", help="include hidden nodes"),
    Flag("-c", "--count-nodes", help="print only their number"),
    JSON,
)
def nodes(options: argparse.Namespace) -> None:
    """Print the nodes. Controllers are not among them, as they have no lifecycle services."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        names = [node.full_name for node in managed_nodes(Graph(session), options.hidden)]
    say_answer(options, names, [len(names)] if options.count_nodes else names)


@verb(
    Argument(
        "node_name", nargs="?", help="default: every managed node", completer=completers.nodes
    ),
    Flag("--include-hidden-nodes", dest="hidden", help="include hidden nodes"),
    JSON,
)
def get(options: argparse.Namespace) -> None:
    """Print the states."""
    states = {}
    with connect() as session:
        from lifecycle_msgs.srv import GetState

        from arm_cli.ros.graph import Graph
        from arm_cli.ros.service_call import call_service

        graph = Graph(session)
        named = [managed_node(graph, options.node_name)] if options.node_name else None
        for node in named or managed_nodes(graph, options.hidden):
            service = f"{node.full_name}/get_state"
            try:
                answer = call_service(session, GetState, service, GetState.Request())
            except UnansweredError as error:
                if options.node_name:
                    raise
                complain(f"arm lifecycle get: {error}")
                continue
            states[node.full_name] = answer.current_state
    shown = {name: f"{state.label} [{state.id}]" for name, state in states.items()}
    lines = shown.values() if options.node_name else map(": ".join, shown.items())
    say_answer(options, {name: state.label for name, state in states.items()}, lines)


@verb(*NODE, Flag("-a", "--all", help="include those that its state does not allow"))
def list_transitions(options: argparse.Namespace) -> None:
    """Print the transitions."""
    with connect() as session:
        from lifecycle_msgs.srv import GetAvailableTransitions

        from arm_cli.ros.graph import Graph
        from arm_cli.ros.service_call import call_service

        node = managed_node(Graph(session), options.node_name)
        service = "get_transition_graph" if options.all else "get_available_transitions"
        answer = call_service(
            session,
            GetAvailableTransitions,
            f"{node.full_name}/{service}",
            GetAvailableTransitions.Request(),
        )
    for description in answer.available_transitions:
        say(f"- {description.transition.label} [{description.transition.id}]")
        say(f"\tStart: {description.start_state.label}")
        say(f"\tGoal: {description.goal_state.label}")


@verb(*NODE, Argument("transition", help="its label, such as configure, or its id"))
def set_state(options: argparse.Namespace) -> None:
    """Request the transition and print its success."""
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
    say("Transitioning successful")


def _find(word: str, node: str, available: "Sequence[TransitionDescription]") -> "Transition":
    transitions = [description.transition for description in available]
    for transition in transitions:
        if word in (transition.label, str(transition.id)):
            return transition
    known = describe_known(word, [transition.label for transition in transitions])
    raise NoSuchNameError(f"no transition {word!r} of {node} in its present state; {known}")
