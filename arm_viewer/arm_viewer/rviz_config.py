"""Read and write what the page shows as an RViz configuration, as far as the page has it."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, cast

import yaml

from arm_description.view_fitting import View
from arm_node.limited_yaml import YamlError, load_yaml
from arm_node.names import listing
from arm_node.user_file import read_bytes
from arm_viewer.errors import ConfigError

MAX_BYTES = 1_000_000
ROBOT, TF, WORLD = (f"rviz_default_plugins/{name}" for name in ("RobotModel", "TF", "MarkerArray"))
ALWAYS_SHOWN = {"rviz_default_plugins/Grid", "rviz_default_plugins/Image"}
ORBIT = "rviz_default_plugins/Orbit"
SWITCHES: dict[str, tuple[str, tuple[str, ...]]] = {
    "visual": (ROBOT, ("Visual Enabled",)),
    "collision": (ROBOT, ("Collision Enabled",)),
    "mass": (ROBOT, ("Mass Properties", "Mass")),
    "inertia": (ROBOT, ("Mass Properties", "Inertia")),
    "frames": (TF, ("Show Axes",)),
    "frame names": (TF, ("Show Names",)),
    "world": (WORLD, ()),
}
"""The display's class and the keys of its property, by switch of the page."""
SHOWN_BY_DEFAULT = {"Visual Enabled", "Show Axes", "Show Names"}
"""The properties that RViz enables unless the file says otherwise."""

Section = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class PageConfig:
    """What the page shows.

    Attributes:
        shown: whether each thing is shown, by key of SWITCHES; a missing key says nothing.
        view: the camera; None if the page has no such view.
        fixed_frame: the frame that RViz draws in, "" if none is named.
        remark: what the page does not have, in a sentence; "" if it has everything.
    """

    shown: Mapping[str, bool]
    view: View | None
    fixed_frame: str = ""
    remark: str = ""


def read_config(content: bytes, name: str) -> PageConfig:
    """Read an RViz configuration; errors name it.

    Raises:
        ConfigError: it is not an RViz configuration.
    """
    if len(content) > MAX_BYTES:
        raise ConfigError(f"{name} is not an RViz configuration: it exceeds {MAX_BYTES} bytes")
    try:
        document: object = load_yaml(content.decode())
    except (YamlError, UnicodeDecodeError) as error:
        raise ConfigError(f"{name} is not an RViz configuration: {error}") from error
    manager = _section(document, "Visualization Manager")
    if not manager:
        raise ConfigError(f"{name} is not an RViz configuration: it has no Visualization Manager")
    entries: object = manager.get("Displays")
    displays = (
        [_section(entry) for entry in cast(list[object], entries)]
        if isinstance(entries, list)
        else []
    )
    kinds = [str(display.get("Class", "")) for display in displays]
    missing = [k for k in kinds if k not in {ROBOT, TF, WORLD} | ALWAYS_SHOWN]
    current = _section(_section(manager, "Views"), "Current")
    view = _view(current)
    if current and view is None:
        missing.append(str(current.get("Class", "a view without a class")))
    return PageConfig(
        _shown(dict(zip(kinds, displays, strict=True))),
        view,
        str(_section(manager, "Global Options").get("Fixed Frame") or ""),
        f"The page does not have {listing(missing)} of {name}." if missing else "",
    )


def read_config_file(path: str) -> PageConfig:
    """Read the RViz configuration at a path; raise ConfigError if there is none."""
    try:
        content = read_bytes(path, MAX_BYTES)
    except OSError as error:
        raise ConfigError(f"cannot read {path}: {error.strerror}") from error
    return read_config(content, path)


def write_config(config: PageConfig) -> bytes:
    """Return the configuration as an RViz file."""
    enabled = {kind: any(_values(config, kind).values()) for kind in (ROBOT, TF, WORLD)}
    displays = [
        {"Class": "rviz_default_plugins/Grid", "Name": "Grid", "Enabled": True, "Value": True}
    ]
    topics = {
        ROBOT: ("Description Topic", "/robot_description"),
        WORLD: ("Topic", "/world_markers"),
    }
    for kind, is_enabled in enabled.items():
        display: dict[str, Any] = {"Class": kind, "Name": kind.rpartition("/")[2]}
        display |= {"Enabled": is_enabled, "Value": is_enabled}
        for keys, value in _values(config, kind).items():
            place = display
            for key in keys[:-1]:
                place = place.setdefault(key, {})
            if keys:
                place[keys[-1]] = value
        if kind in topics:
            key, topic = topics[kind]
            display[key] = {"Value": topic, "Durability Policy": "Transient Local"}
        displays.append(display)
    manager = {
        "Class": "",
        "Displays": displays,
        "Enabled": True,
        "Global Options": {"Fixed Frame": config.fixed_frame},
        "Name": "root",
        "Views": {"Current": _orbit(config.view) if config.view else {}, "Saved": None},
    }
    return yaml.safe_dump({"Visualization Manager": manager}, sort_keys=False).encode()


def _values(config: PageConfig, kind: str) -> dict[tuple[str, ...], bool]:
    return {
        keys: config.shown.get(switch, False)
        for switch, (owner, keys) in SWITCHES.items()
        if owner == kind
    }


def _section(value: object, key: str = "") -> Section:
    """Return a mapping, or its entry; an empty one if there is none."""
    found: object = value if isinstance(value, dict) else {}
    if key:
        found = cast(Section, found).get(key)
    return cast(Section, found) if isinstance(found, dict) else {}


def _shown(displays: Mapping[str, Section]) -> dict[str, bool]:
    # As in RViz, what is not among the displays is not shown.
    shown: dict[str, bool] = {}
    for switch, (kind, keys) in SWITCHES.items():
        display = displays.get(kind, {})
        if kind == WORLD and not display:
            # Most files say nothing about the world, which RViz shows only where it is added.
            continue
        value: object = bool(display) and display.get("Enabled", True)
        for key in keys if value is True else ():
            value = display.get(key, key in SHOWN_BY_DEFAULT)
            display = _section(value)
        shown[switch] = value is True
    return shown


def _view(current: Section) -> View | None:
    if current.get("Class") != ORBIT:
        return None
    focal = _section(current, "Focal Point")
    numbers = [*_numbers(focal, ("X", 0.0), ("Y", 0.0), ("Z", 0.0))]
    numbers += _numbers(current, ("Distance", 10.0), ("Pitch", 0.5), ("Yaw", 0.5))
    if not all(map(math.isfinite, numbers)) or numbers[3] <= 0.0:
        return None
    x, y, z, distance, pitch, yaw = numbers
    level = distance * math.cos(pitch)
    position = (
        x + level * math.cos(yaw),
        y + level * math.sin(yaw),
        z + distance * math.sin(pitch),
    )
    return View(position, (x, y, z))


def _numbers(section: Section, *wanted: tuple[str, float]) -> Iterator[float]:
    for key, default in wanted:
        value: object = section.get(key, default)
        try:
            yield float(value) if isinstance(value, int | float) else math.nan
        except OverflowError:  # YAML's integers have any number of digits.
            yield math.inf


def _orbit(view: View) -> dict[str, Any]:
    dx, dy, dz = (float(p) - float(t) for p, t in zip(view.position, view.target, strict=True))
    return {
        "Class": ORBIT,
        "Name": "Current View",
        "Distance": math.hypot(dx, dy, dz),
        "Focal Point": dict(zip("XYZ", map(float, view.target), strict=True)),
        "Pitch": math.atan2(dz, math.hypot(dx, dy)),
        "Target Frame": "<Fixed Frame>",
        "Value": "Orbit (rviz)",
        "Yaw": math.atan2(dy, dx),
    }
