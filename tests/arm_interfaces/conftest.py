"""The record of what each type must be."""

import importlib
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

FOLDER = Path(__file__).parent
EXPECTED_TYPES: dict[str, str] = yaml.safe_load((FOLDER / "expected_types.yaml").read_bytes())


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that asks for `recorded` once for the recorded types of every package."""
    if "recorded" in metafunc.fixturenames:
        packages = sorted({name.split("/")[0] for name in EXPECTED_TYPES})
        of = {
            p: {n: r for n, r in EXPECTED_TYPES.items() if n.startswith(f"{p}/")} for p in packages
        }
        metafunc.parametrize("recorded", of.values(), ids=of)


@pytest.fixture
def expected_types() -> dict[str, str]:
    """The recorded hash of each type by its name, such as `tf2_msgs/msg/TFMessage`."""
    return EXPECTED_TYPES


@pytest.fixture
def load_type() -> Callable[[str], type]:
    """Import the class of a type by its ROS name."""

    def load(name: str) -> type:
        package, kind, class_name = name.split("/")
        return getattr(importlib.import_module(f"{package}.{kind}"), class_name)

    return load
