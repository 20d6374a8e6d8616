"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_description"
NEIGHBOURS = ["../arm_node"]
REQUIREMENTS = [
    "lxml>=5.0",
    "networkx>=3",
    "numpy>=2",
    "pycollada>=0.8",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
    "trimesh>=4.4",
    "xacro>=2.1",
]
DATA_FOLDERS = ["urdf", "meshes", "config", "launch"]
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
    package_data={"arm_description": ["py.typed"]},
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
        "The 4-DOF arm: xacro, meshes, robot model and kinematics; robot_state_publisher "
        "and joint_state_publisher in Python."
    ),
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "robot_state_publisher = arm_description.robot_state_publisher_node:main",
            "joint_state_publisher = arm_description.joint_state_publisher_node:main",
            "static_transform_publisher = arm_description.static_transform_publisher_node:main",
        ],
        "launch_py.packages": [
            "robot_state_publisher = arm_description",
            "joint_state_publisher = arm_description",
        ],
        "launch_py.programs": ["xacro = arm_description.xacro.program:main"],
        "launch_py.nodes": [
            "robot_state_publisher = robot_state_publisher",
            "joint_state_publisher = joint_state_publisher",
        ],
    },
)
