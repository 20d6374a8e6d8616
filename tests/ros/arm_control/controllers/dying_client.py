"""A client of an action that has sent a goal, asked for its result, and waits for its death.

Arguments: the type of the action, its name, the goal serialized, in hexadecimal.
"""

import sys

from arm_node.environment import prepare_environment


def main(type_name: str, name: str, goal: str) -> None:
    prepare_environment()
    import control_msgs.action
    import rclpy
    from rclpy.action import ActionClient
    from rclpy.serialization import deserialize_message

    from arm_node.testing import DiscoveryCheck

    action_type = getattr(control_msgs.action, type_name)
    rclpy.init()
    node = rclpy.create_node("dying_client")
    action = ActionClient(node, action_type, name)

    def be_known() -> None:
        check = DiscoveryCheck.with_server(node, f"{name}/_action/send_goal")
        while not check.complete:
            rclpy.spin_once(node, timeout_sec=0.02)

    action.wait_for_server()
    be_known()
    sent = action.send_goal_async(deserialize_message(bytes.fromhex(goal), action_type.Goal))
    rclpy.spin_until_future_complete(node, sent)
    sent.result().get_result_async()
    be_known()  # asked later than for the result, so that this has come
    print("accepted" if sent.result().accepted else "rejected", flush=True)
    rclpy.spin(node)


main(*sys.argv[1:])
