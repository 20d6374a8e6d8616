"""Installs this folder alone, by colcon or pip; the root pyproject.toml installs the suite."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "arm_gazebo"
NEIGHBOURS = ["../arm_control", "../arm_description", "../arm_node"]
REQUIREMENTS = [
    "glfw>=2.5",
    "google-re2>=1.1",
    "lxml>=5.0",
    "mcap>=1.6,<2",
    "mujoco-core[rendering]>=4.0,<5",
    "numpy>=2",
    "opencv-python-headless>=4.9",
    "ros-jazzy-common-interfaces==5.3.6",
    "ros-jazzy-rclpy[fastrtps]==7.1.6",
    "xxhash>=3.4",
    "zstandard>=0.22",
]
DATA_FOLDERS = ["urdf", "worlds", "config", "launch"]
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
    package_data={"arm_gazebo": ["py.typed"]},
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
    description="The simulation: URDF to MuJoCo, simulated hardware, worlds and cameras.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "arm_gazebo_node = arm_gazebo.arm_gazebo_node:main",
            "gz_sim_server = arm_gazebo.gz_sim_server_node:main",
            "ros_gz_create = arm_gazebo.ros_gz_create_node:main",
            "ros_gz_bridge = arm_gazebo.ros_gz_bridge_node:main",
        ],
        "launch_py.nodes": [
            "arm_gazebo_node = controller_manager",
        ],
    },
)
