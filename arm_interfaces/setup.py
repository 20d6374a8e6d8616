"""Tell setuptools which packages to build and which commands build them.

Only the backend runs it (``pip install ./arm_interfaces``). The other metadata are in
``pyproject.toml``.
"""

from pathlib import Path

from interface_build import command, interface_package
from setuptools import Extension, setup

PACKAGES = interface_package.find_packages(Path(__file__).parent / "interfaces")

setup(
    ext_modules=[Extension(package.extension_name, sources=[]) for package in PACKAGES],
    cmdclass={
        "build": command.Build,
        "build_ext": command.BuildInterfaces,
        "egg_info": command.EggInfo,
    },
)
