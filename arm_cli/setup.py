"""Installs this folder as an ament_python package, for colcon; pip uses the root pyproject.toml."""

from setuptools import find_packages, setup

PACKAGE = "arm_cli"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    description="The arm command.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["arm = arm_cli.main:main"],
    },
)
