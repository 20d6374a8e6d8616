# Delayed starts, messages, a bag that is recorded, and a handler of lines that ends the launch.
# starts: driver ros2
# later: servo
from launch.actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessIO, OnProcessStart, OnShutdown
from launch.events import Shutdown
from launch.substitutions import LocalSubstitution
from launch_ros.actions import Node

from launch import LaunchDescription


def generate_launch_description():
    driver = Node(package="demo_arm", executable="driver")

    def on_output(event):
        if b"lost" in event.text:
            return EmitEvent(event=Shutdown(reason="the driver lost its robot"))
        return None

    return LaunchDescription(
        [
            driver,
            ExecuteProcess(cmd=["ros2", "bag", "record", "-a", "-o", "run"], output="log"),
            RegisterEventHandler(
                OnProcessStart(target_action=driver, on_start=[LogInfo(msg="the driver is up")])
            ),
            RegisterEventHandler(OnProcessIO(on_stdout=on_output, on_stderr=on_output)),
            RegisterEventHandler(
                OnShutdown(on_shutdown=[LogInfo(msg=["bye: ", LocalSubstitution("event.reason")])])
            ),
            TimerAction(period=5.0, actions=[Node(package="demo_arm", executable="servo")]),
        ]
    )
