# A required process, one that is taken back, and a test program whose code ends the launch.
# starts: driver servo check
from launch.actions import (
    EmitEvent,
    ExecuteProcess,
    RegisterEventHandler,
    Shutdown,
    UnregisterEventHandler,
)
from launch.event_handlers import OnProcessExit
from launch.events import matches_action
from launch.events.process import ShutdownProcess
from launch_ros.actions import Node
from launch_ros.substitutions import ExecutableInPackage

from launch import LaunchDescription


def generate_launch_description():
    servo = Node(package="demo_arm", executable="servo", sigterm_timeout="10")
    on_servo = OnProcessExit(target_action=servo, on_exit=[Shutdown(reason="servo ended")])
    check = ExecuteProcess(
        cmd=[ExecutableInPackage("detector", "demo_arm"), "--once"], name="check", shell=False
    )
    return LaunchDescription(
        [
            Node(package="demo_arm", executable="driver", on_exit=Shutdown()),
            servo,
            RegisterEventHandler(on_servo),
            check,
            RegisterEventHandler(
                OnProcessExit(
                    target_action=check,
                    on_exit=[
                        UnregisterEventHandler(on_servo),
                        EmitEvent(event=ShutdownProcess(process_matcher=matches_action(servo))),
                    ],
                )
            ),
        ]
    )
