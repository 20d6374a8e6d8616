"""YAML by libyaml where PyYAML has it: metadata are written again and again while recording."""

from typing import Any

import yaml

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


def load_yaml(text: str) -> Any:
    """Return the value of a YAML text.

    Raises:
        ValueError: it is none.
    """
    try:
        return yaml.load(text, Loader=_LOADER)
    except (yaml.YAMLError, ValueError) as error:
        raise ValueError(f"no YAML: {error}") from error


def dump_yaml(value: Any) -> str:
    """Return plain values as YAML, keys in their order."""
    return yaml.dump(value, Dumper=_DUMPER, sort_keys=False)
