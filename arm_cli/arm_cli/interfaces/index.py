"""The installed message, service and action types, found by their definition files."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from arm_cli.errors import NotFoundError
from launch_py.near_names import describe_known
from launch_py.packages import ament_prefixes

KINDS = ("msg", "srv", "action")
KIND_NAMES = {"msg": "message", "srv": "service", "action": "action"}


@dataclass(frozen=True, slots=True)
class InterfaceType:
    """One type, and the file that defines it."""

    package: str
    kind: str
    name: str
    path: Path

    @property
    def full_name(self) -> str:
        """Its name, such as std_msgs/msg/String."""
        return f"{self.package}/{self.kind}/{self.name}"


class InterfaceIndex:
    """Finds types in the share folders of the prefixes."""

    def __init__(self, environ: Mapping[str, str] = os.environ) -> None:
        """Look in the prefixes of AMENT_PREFIX_PATH and of this Python."""
        self._shares = [Path(prefix, "share") for prefix in ament_prefixes(environ)]

    def packages(self, kinds: tuple[str, ...] = KINDS) -> list[str]:
        """Return the packages that define types of these kinds, sorted."""
        return sorted(
            {
                folder.parent.name
                for share in self._shares
                for kind in kinds
                for folder in share.glob(f"*/{kind}")
                if any(folder.glob(f"*.{kind}"))
            }
        )

    def types(self, kinds: tuple[str, ...] = KINDS, package: str = "*") -> list[InterfaceType]:
        """Return the types of these kinds, of one package or of all, sorted by name."""
        found: dict[str, InterfaceType] = {}
        for share in self._shares:
            for kind in kinds:
                for path in share.glob(f"{package}/{kind}/*.{kind}"):
                    type_ = InterfaceType(path.parent.parent.name, kind, path.stem, path)
                    found.setdefault(type_.full_name, type_)
        return sorted(found.values(), key=lambda type_: type_.full_name)

    def find(self, name: str, kinds: tuple[str, ...] = KINDS) -> InterfaceType:
        """Return the type of a name; `std_msgs/String` is `std_msgs/msg/String`, too.

        Raises:
            NotFoundError: there is no such type; the message names near ones.
        """
        parts = name.split("/")
        if len(parts) == 3 and parts[1] in kinds:
            wanted = [name]
        elif len(parts) == 2:
            wanted = [f"{parts[0]}/{kind}/{parts[1]}" for kind in kinds]
        else:
            wanted = []
        for full_name in wanted:
            package, kind, stem = full_name.split("/")
            for share in self._shares:
                path = share / package / kind / f"{stem}.{kind}"
                if path.is_file():
                    return InterfaceType(package, kind, stem, path)
        raise self._unknown(name, kinds)

    def _unknown(self, name: str, kinds: tuple[str, ...]) -> NotFoundError:
        what = KIND_NAMES[kinds[0]] if len(kinds) == 1 else "interface"
        package = name.split("/")[0]
        installed = self.packages(kinds)
        if package not in installed:
            known = describe_known(package, installed)
            return NotFoundError(f"no {what} type {name!r}: no package {package!r}; {known}")
        known = [type_.full_name for type_ in self.types(kinds, package)]
        return NotFoundError(f"no {what} type {name!r}; {describe_known(name, known)}")


def load_class(type_: InterfaceType) -> Any:
    """Return the Python class of a type.

    Raises:
        NotFoundError: its package has no Python module, or one without the type.
    """
    try:
        return getattr(import_module(f"{type_.package}.{type_.kind}"), type_.name)
    except (ImportError, AttributeError) as error:
        raise NotFoundError(
            f"{type_.full_name} is defined in {type_.path}, but cannot be used: {error}"
        ) from error
