"""Which joint stands where in the messages of the joint state broadcaster."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

QUANTITIES = ("position", "velocity", "effort")
"""The arrays of a sensor_msgs/JointState, in the order of the flat array published."""


@dataclass(frozen=True, slots=True)
class JointStateLayout:
    """What is published while one activation lasts.

    Attributes:
        joints: names in joint_states.
        components: (name, names of its interfaces) in dynamic_joint_states.
    """

    joints: tuple[str, ...]
    components: tuple[tuple[str, tuple[str, ...]], ...]


class Gather:
    """Copies chosen states into a flat array; what has no state keeps its fixed value."""

    def __init__(self, sources: Sequence[int | float]) -> None:
        """Set up the array.

        Args:
            sources: for each element either the index of a state (int) or its fixed value (float).
        """
        taken = [i for i, source in enumerate(sources) if isinstance(source, int)]
        self._source = np.array([sources[i] for i in taken], dtype=np.intp)
        self._target = slice(None) if len(taken) == len(sources) else np.array(taken, dtype=np.intp)
        self.values = np.array([np.nan if isinstance(s, int) else s for s in sources])

    def update(self, states: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the array with the present states; it is the same array every time."""
        self.values[self._target] = states[self._source]
        return self.values


@dataclass(frozen=True, slots=True)
class JointStatePlan:
    """A layout and where its values come from."""

    layout: JointStateLayout
    joints: Gather
    components: Gather


def plan_joint_states(
    states: Sequence[str],
    *,
    quantity_of: Mapping[str, str],
    ordered_joints: Sequence[str] = (),
    allowed_joints: Collection[str] | None = None,
    extra_joints: Sequence[str] = (),
    left_out: Collection[str] = (),
) -> JointStatePlan:
    """Lay out the messages for these state interfaces.

    Args:
        states: full names, 'j0/position', in the order of the array of states.
        quantity_of: standard name of each interface that goes by another one.
        ordered_joints: the joints to publish, in this order; empty for all.
        allowed_joints: joints to publish in alphabetical order where none are ordered; None for
            all in the order of their interfaces.
        extra_joints: joints without states, at zero, after the others.
        left_out: full names of states not to publish.
    """
    components: dict[str, dict[str, int | float]] = {}
    for index, full_name in enumerate(states):
        if full_name in left_out:
            continue
        name, _, interface = full_name.rpartition("/")
        components.setdefault(name, {})[quantity_of.get(interface, interface)] = index
    joints = [name for name, has in components.items() if not has.keys().isdisjoint(QUANTITIES)]
    if ordered_joints:
        joints = [name for name in ordered_joints if name in joints]
    elif allowed_joints is not None:
        joints = sorted(name for name in joints if name in allowed_joints)
    for name in extra_joints:
        if name not in components:
            components[name] = dict.fromkeys(QUANTITIES, 0.0)
            joints.append(name)
    return JointStatePlan(
        layout=JointStateLayout(
            tuple(joints), tuple((name, tuple(has)) for name, has in components.items())
        ),
        joints=Gather([components[n].get(q, np.nan) for q in QUANTITIES for n in joints]),
        components=Gather([source for has in components.values() for source in has.values()]),
    )
