"""Reads the files that a launch argument names."""

from pathlib import Path
from typing import Any

from arm_gazebo.errors import SettingsError


def read_text(path: Path, title: str) -> str:
    """Return what a file holds.

    Args:
        path: in UTF-8.
        title: what to call the file, such as "the robots' file".

    Raises:
        SettingsError: it cannot be read.
    """
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise SettingsError(f"cannot read {title} {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise SettingsError(f"{title} {path} is not UTF-8: {error}") from error


def parse_yaml(text: str, path: Path, title: str) -> Any:
    """Return what YAML says.

    Args:
        text: what the file holds.
        path: the file, for the message.
        title: as for `read_text`.

    Raises:
        SettingsError: it is not YAML.
    """
    import yaml  # Only here: most launches read no file.

    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        reason = " ".join(str(error).split())
        raise SettingsError(f"{title} {path} is not YAML: {reason}") from error
