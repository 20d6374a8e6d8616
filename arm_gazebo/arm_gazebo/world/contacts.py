"""The contacts between bodies in one state of the world."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.world.entity import WORLD_FRAME, Entities
from arm_node.frozen import frozen
from arm_node.names import listing

Vector = NDArray[np.float64]


@frozen
class Contact:
    """A point at which two bodies touch, so that forces act there.

    Attributes:
        body: name of the body; the requested one, if there is one.
        other: name of the body that it touches; "world" for the world.
        position: of the point in the world, in m, shape (3,).
        normal: unit vector away from `other`, shape (3,).
        depth: how deep the shapes overlap, in m; negative within the margin of a geom, in which
            forces act already.
        force: on `body` in the world, in N, shape (3,).
    """

    body: str
    other: str
    position: Vector
    normal: Vector
    depth: float
    force: Vector


def contacts_of(
    name: str | None, model: mujoco.MjModel, data: mujoco.MjData, entities: Entities
) -> tuple[Contact, ...]:
    """Return the contacts of a body or entity, None for all, in a state that has their forces.

    Raises:
        RequestError: there is no such body or entity.
    """
    bodies = None if name is None else bodies_of(name, model, entities)
    found: list[Contact] = []
    wrench = np.zeros(6)
    for index in range(data.ncon):
        contact = data.contact[index]
        # MuJoCo lists shapes that are near each other, too: in the gap of a geom.
        if contact.efc_address < 0:
            continue
        first, second = (int(model.geom_bodyid[geom]) for geom in contact.geom)
        if bodies is not None and not bodies.intersection((first, second)):
            continue
        # MuJoCo's normal points from the first body to the second, and its force acts on the
        # second.
        is_first = bodies is None or first in bodies
        body, other, sign = (first, second, -1.0) if is_first else (second, first, 1.0)
        mujoco.mj_contactForce(model, data, index, wrench)
        axes = contact.frame.reshape(3, 3)
        found.append(
            Contact(
                model.body(body).name or WORLD_FRAME,
                model.body(other).name or WORLD_FRAME,
                contact.pos.copy(),
                sign * axes[0],
                -float(contact.dist),
                sign * (wrench[:3] @ axes),
            )
        )
    return tuple(found)


def bodies_of(name: str, model: mujoco.MjModel, entities: Entities) -> frozenset[int]:
    """Return the bodies of an entity, or a single body, by their numbers in the model.

    Raises:
        RequestError: there is no such body or entity.
    """
    entity = next((entity for entity in entities if entity.name == name), None)
    if entity is not None:
        roots = [model.body(root).id for root in entity.roots]
        return frozenset(np.flatnonzero(np.isin(model.body_rootid, roots)).tolist())
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
    if body < 0:
        names = sorted({entity.name for entity in entities})
        raise RequestError(
            Refusal.NOT_FOUND, f"no entity or link '{name}'; there are {listing(names)} and links"
        )
    return frozenset((body,))
