# A managed driver that is configured at once and activated when it is inactive.
# starts: driver
# managed: /driver
from launch.actions import EmitEvent, RegisterEventHandler
from launch.events import matches_action
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import Transition

from launch import LaunchDescription


def generate_launch_description():
    driver = LifecycleNode(
        package="demo_arm", executable="driver", name="driver", namespace="", output="screen"
    )

    def change(transition):
        return EmitEvent(
            event=ChangeState(
                lifecycle_node_matcher=matches_action(driver), transition_id=transition
            )
        )

    activate = RegisterEventHandler(
        OnStateTransition(
            target_lifecycle_node=driver,
            start_state="configuring",
            goal_state="inactive",
            entities=[change(Transition.TRANSITION_ACTIVATE)],
        )
    )
    return LaunchDescription([driver, activate, change(Transition.TRANSITION_CONFIGURE)])
