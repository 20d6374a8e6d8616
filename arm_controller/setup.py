"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_controller"
NEIGHBOURS = ["../arm_control", "../arm_description", "../arm_planning"]
REQUIREMENTS = [
    "PyYAML>=6.0",
    "numpy>=2",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
]
DATA_FOLDERS = ["config", "launch"]
DATA_FILES = [
    path
    for folder in DATA_FOLDERS
    for path in Path(folder).rglob("*")
    if path.is_file() and path.suffix != ".pyc"
]

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        *((f"share/{PACKAGE}/{path.parent}", [str(path)]) for path in DATA_FILES),
    ],
    install_requires=[
        "setuptools",
        *REQUIREMENTS,
        *(f"{Path(path).name} @ {Path(path).resolve().as_uri()}" for path in NEIGHBOURS),
    ],
    zip_safe=True,
    description=(
        "Nodes that use the arm: arm_controller_node, publisher_terminal, publisher_defined, "
        "arm_gripper_loop_controller, mycobot_pick_and_place."
    ),
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "arm_controller_node = arm_controller.arm_controller_node:main",
            "publisher_terminal = arm_controller.publisher_terminal_node:main",
            "publisher_defined = arm_controller.publisher_defined_node:main",
            "arm_gripper_loop_controller = arm_controller.arm_gripper_loop_controller_node:main",
            "mycobot_pick_and_place = arm_controller.pick_and_place_node:main",
            "hello_moveit = arm_controller.hello_moveit_node:main",
            "plan_around_objects = arm_controller.plan_around_objects_node:main",
            "example_gripper = arm_controller.example_gripper_node:main",
            "example_diff_drive = arm_controller.example_diff_drive_node:main",
        ],
        "launch_py.nodes": [
            "arm_controller_node = arm_controller_node",
            "publisher_terminal = publisher_terminal",
            "publisher_defined = publisher_defined",
            "arm_gripper_loop_controller = arm_gripper_loop_controller",
            "mycobot_pick_and_place = mycobot_pick_and_place",
            "hello_moveit = hello_moveit",
            "plan_around_objects = plan_around_objects",
            "example_gripper = gripper_test_node",
            "example_diff_drive = diff_drive_test_node",
        ],
    },
)
