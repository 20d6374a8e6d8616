"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_planning"
NEIGHBOURS = ["../arm_node", "../arm_description"]
REQUIREMENTS = [
    "mujoco-core[rendering]>=4.0,<5",
    "numpy>=2",
    "opencv-python-headless>=4.9",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
]
DATA_FOLDERS = ["launch"]
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
    package_data={"arm_planning": ["py.typed"]},
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
        "Motion planning for arms: planning scene, collision checks, inverse kinematics, planners "
        "and timing, with the surface of MoveIt 2's move_group."
    ),
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "move_group = arm_planning.move_group_node:main",
            "servo_node = arm_planning.servo_node:main",
            "mtc_demo = arm_planning.mtc_demo_node:main",
            "mtc_node = arm_planning.mtc_node:main",
            "get_planning_scene_server = arm_planning.get_planning_scene_node:main",
        ],
        "launch_py.packages": [
            "moveit_ros_move_group = arm_planning",
            "moveit_servo = arm_planning",
        ],
        "launch_py.nodes": [
            "move_group = move_group",
            "servo_node = servo_node",
            "mtc_node = mtc_node",
            "get_planning_scene_server = get_planning_scene_server",
        ],
    },
)
