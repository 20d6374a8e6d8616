"""The file of `--qos-profile-overrides-path`: other quality of service for some topics."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from arm_cli.bag.offered_qos import POLICIES, OfferedQos, read_offers
from arm_cli.bag.yaml_text import load_yaml
from arm_cli.errors import BagError
from arm_cli.names import absolute_name
from launch_py.near_names import describe_known


def read_qos_overrides(path: Path | None) -> dict[str, OfferedQos]:
    """Return the quality of service by topic; none without a file.

    Raises:
        BagError: it is no such file; the message says what is wrong where.
    """
    if path is None:
        return {}
    try:
        content = load_yaml(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise BagError(f"cannot read {path}: {error.strerror}") from error
    except ValueError as error:
        raise BagError(f"{path} is {error}") from error
    if not isinstance(content, dict):
        raise BagError(f"{path} has no topics: it is not of the form '/topic: {{depth: 10}}'")
    return {
        absolute_name(str(name)): _read(value, f"{path}: {name}") for name, value in content.items()
    }


def _read(value: Any, where: str) -> OfferedQos:
    if not isinstance(value, Mapping):
        raise BagError(f"{where} has no policies, such as 'reliability: best_effort'")
    known = OfferedQos().to_plain()
    for key, setting in value.items():
        if key not in known:
            raise BagError(f"{where} has no policy {str(key)!r}; {describe_known(str(key), known)}")
        names = POLICIES.get(key)
        if names is not None and setting not in names:
            hint = describe_known(str(setting), names)
            raise BagError(f"{where}: {key} cannot be {setting!r}; {hint}")
    return read_offers([dict(value)])[0]
