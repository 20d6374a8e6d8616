"""Read the files that launch arguments name."""

from pathlib import Path
from typing import Any

from arm_gazebo.errors import SimSettingsError
from arm_node import user_file
from arm_node.limited_yaml import YamlError, load_yaml


def read_text(path: Path, title: str) -> str:
    """Return the content of a file in UTF-8; messages give its title, such as "the robots' file".

    Raises:
        SimSettingsError: the file cannot be read.
    """
    try:
        return user_file.read_text(path)
    except OSError as error:
        raise SimSettingsError(f"cannot read {title} {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise SimSettingsError(f"{title} {path} is not UTF-8: {error}") from error


def parse_yaml(text: str, path: Path, title: str) -> Any:
    """Return the parsed YAML.

    Raises:
        SimSettingsError: the text is not YAML, or exceeds the limits of `load_yaml`.
    """
    try:
        return load_yaml(text)
    except YamlError as error:
        raise SimSettingsError(f"{title} {path} is not YAML: {error}") from error
