"""Reads and writes YAML, with libyaml if available: a recorder writes its metadata often."""

from typing import Any

import yaml

from arm_node import limited_yaml

_DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


def load_yaml(text: str) -> Any:
    """Return the value of a YAML text.

    Raises:
        ValueError: the text is not YAML, or exceeds the limits of `limited_yaml`.
    """
    try:
        return limited_yaml.load_yaml(text)
    except limited_yaml.YamlError as error:
        raise ValueError(f"not YAML: {error}") from error


def dump_yaml(value: Any) -> str:
    """Return plain values as YAML, with keys in their order."""
    return yaml.dump(value, Dumper=_DUMPER, sort_keys=False)
