"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_control"
NEIGHBOURS = ["../arm_description", "../arm_node"]
REQUIREMENTS = [
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
    package_data={"arm_control": ["py.typed"]},
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
        "ros2_control in Python: hardware interface, controller manager, controllers and spawner."
    ),
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "ros2_control_node = arm_control.manager.ros2_control_node:main",
            "spawner = arm_control.spawner.spawner_node:main",
            "unspawner = arm_control.spawner.unspawner_node:main",
            "hardware_spawner = arm_control.spawner.hardware_spawner_node:main",
        ],
        "launch_py.packages": ["controller_manager = arm_control"],
        "launch_py.nodes": ["ros2_control_node = controller_manager"],
    },
)
