"""A client of an action that has sent a goal, asked for its result, and waits for its death.

Arguments: the type of the action, its name, the goal serialized, in hexadecimal.
"""

import sys
from typing import Any

from arm_node.environment import prepare_environment

ANSWER_TIMEOUT_S = 0.5  # then the question is put again
NO_TYPE_HASH = f"RIHS01_{0:064}"  # well-formed, so that nobody complains of it


def main(type_name: str, name: str, goal: str) -> None:
    prepare_environment()
    import control_msgs.action
    import rclpy
    from rclpy.action import ActionClient
    from rclpy.serialization import deserialize_message
    from type_description_interfaces.srv import GetTypeDescription

    action_type = getattr(control_msgs.action, type_name)
    rclpy.init()
    node = rclpy.create_node("dying_client")
    action = ActionClient(node, action_type, name)
    controller = name.rpartition("/")[0]
    server = node.create_client(GetTypeDescription, f"{controller}/get_type_description")
    question = GetTypeDescription.Request(type_hash=NO_TYPE_HASH)

    def wait_for_an_answer() -> None:
        answer: Any = None
        while answer is None or not answer.done():
            answer = server.call_async(question)
            rclpy.spin_until_future_complete(node, answer, timeout_sec=ANSWER_TIMEOUT_S)

    action.wait_for_server()
    server.wait_for_service()
    wait_for_an_answer()  # to a client made later: the server knows the action's, too
    sent = action.send_goal_async(deserialize_message(bytes.fromhex(goal), action_type.Goal))
    rclpy.spin_until_future_complete(node, sent)
    sent.result().get_result_async()
    wait_for_an_answer()  # asked later than for the result, so that this has come
    print("accepted" if sent.result().accepted else "rejected", flush=True)
    rclpy.spin(node)


main(*sys.argv[1:])
