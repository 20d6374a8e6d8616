"""Names in a MuJoCo specification, which must be unique among elements of one kind."""

from collections.abc import Collection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import mujoco


def free_name(name: str, taken: Collection[str]) -> str:
    """Return the name, or if it is taken the first free one of NAME_2, NAME_3 and so on."""
    candidate, number = name, 1
    while candidate in taken:
        number += 1
        candidate = f"{name}_{number}"
    return candidate


UNNAMED_BODY = "thing"


def name_elements(spec: "mujoco.MjSpec") -> None:
    """Give every unnamed element that has a state a unique name, so that a swap finds it again."""
    bodies = {body.name for body in spec.bodies}
    for body in spec.bodies:
        if not body.name:
            body.name = free_name(UNNAMED_BODY, bodies)
            bodies.add(body.name)
    joints = {joint.name for joint in spec.joints}
    for joint in spec.joints:
        if not joint.name:
            joint.name = free_name(f"{joint.parent.name}::joint", joints)
            joints.add(joint.name)
    for kind, elements, owner in (
        ("actuator", spec.actuators, "target"),
        ("equality", spec.equalities, "name1"),
        ("sensor", spec.sensors, "objname"),
        ("tendon", spec.tendons, ""),
    ):
        names = {element.name for element in elements}
        for element in elements:
            if not element.name:
                prefix = getattr(element, owner, "") or UNNAMED_BODY
                element.name = free_name(f"{prefix}::{kind}", names)
                names.add(element.name)
