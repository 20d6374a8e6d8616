# A file that can also be run by itself, and imports more than it uses.
# starts: driver
import sys

import launch.actions
import launch_ros.actions

import launch
from launch import LaunchDescription, LaunchIntrospector, LaunchService


def generate_launch_description():
    return LaunchDescription(
        [
            launch.actions.DeclareLaunchArgument("port", default_value="5000"),
            launch_ros.actions.Node(
                package="demo_arm",
                executable="driver",
                parameters=[{"port": launch.substitutions.LaunchConfiguration("port")}],
            ),
        ]
    )


def main(argv=sys.argv[1:]):
    description = generate_launch_description()
    print(LaunchIntrospector().format_launch_description(description))
    service = LaunchService(argv=argv)
    service.include_launch_description(description)
    return service.run()


if __name__ == "__main__":
    sys.exit(main())
