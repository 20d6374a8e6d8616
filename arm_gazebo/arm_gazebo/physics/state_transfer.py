"""Copy the state of one model to another by name; save and restore that of one model."""

from bisect import bisect_right
from collections.abc import Collection, Iterator, Mapping, Sequence
from enum import Enum, auto
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.errors import StateError
from arm_gazebo.physics.state_probe import EVERYTHING

DRIVE_ARRAYS = (
    "actuator_gainprm",
    "actuator_biasprm",
    "actuator_forcerange",
    "actuator_forcelimited",
)
Indices = NDArray[np.intp]
Pair = tuple[int, int]
OBJECT = mujoco.mjtObj


class ModelElement(Enum):
    """The elements of a model whose state is copied."""

    WORLD = auto()
    BODY = auto()
    MOCAP = auto()
    JOINT = auto()
    ACTUATOR = auto()
    EQUALITY = auto()
    SENSOR = auto()
    TENDON = auto()
    FLEX = auto()


OF_VELOCITIES = "nv", {"jnt_dofadr": ModelElement.JOINT}
OF_MOCAPS = "nmocap", {"body_mocapid": ModelElement.MOCAP}
LAYOUT: Mapping[str, tuple[str, Mapping[str, ModelElement]]] = {
    "qpos": ("nq", {"jnt_qposadr": ModelElement.JOINT}),
    "qvel": OF_VELOCITIES,
    "act": ("na", {"actuator_actadr": ModelElement.ACTUATOR}),
    "history": (
        "nhistory",
        {"actuator_historyadr": ModelElement.ACTUATOR, "sensor_historyadr": ModelElement.SENSOR},
    ),
    "qacc_warmstart": OF_VELOCITIES,
    "ctrl": ("nu", {"actuator_ctrladr": ModelElement.ACTUATOR}),
    "qfrc_applied": OF_VELOCITIES,
    "xfrc_applied": ("nbody", {"": ModelElement.BODY}),
    "eq_active": ("neq", {"": ModelElement.EQUALITY}),
    "mocap_pos": OF_MOCAPS,
    "mocap_quat": OF_MOCAPS,
    "userdata": ("nuserdata", {"": ModelElement.WORLD}),
    "plugin_state": ("npluginstate", {"": ModelElement.WORLD}),
    "plastic": (
        "nplastic",
        {
            "jnt_plasticadr": ModelElement.JOINT,
            "tendon_plasticadr": ModelElement.TENDON,
            "flex_plasticadr": ModelElement.FLEX,
        },
    ),
}
"""The arrays of MuJoCo's state but the time: their length, and where the part of an element begins.

A part ends where the next one begins. Without a field ("") an element's number is its place.
"""


class StateTransfer:
    """Copies MuJoCo's state and the drives' gains from one model to another.

    The constructor looks up each name once; `carry` only copies.

    Args:
        source: the model whose state is known.
        target: the model that continues from that state.
        roots: top-level bodies that continue with their joints, and the actuators and equalities
            of these; everything else keeps the target's state. If the world is one of them, its
            equalities, actuators, sensors and tendons continue, too.
    """

    def __init__(
        self, source: mujoco.MjModel, target: mujoco.MjModel, roots: Collection[str]
    ) -> None:
        pairs = _pairs(source, target, roots)
        self._indices = {
            name: _indices(source, target, length, fields, pairs)
            for name, (length, fields) in LAYOUT.items()
        }
        drives = np.array(pairs[ModelElement.ACTUATOR], dtype=np.intp).reshape(-1, 2)
        self._drives = drives[:, 0], drives[:, 1]

    def carry(self, source: mujoco.MjData, target: mujoco.MjData) -> None:
        """Copy the state of the first model to the state of the second one."""
        target.time = source.time
        for name, (there, here) in self._indices.items():
            getattr(target, name)[here] = getattr(source, name)[there]

    def carry_positions(self, source: NDArray[np.float64], target: NDArray[np.float64]) -> None:
        """Copy generalised positions (nq,) of the first model to those of the second one."""
        there, here = self._indices["qpos"]
        target[here] = source[there]

    def carry_drives(self, source: mujoco.MjModel, target: mujoco.MjModel) -> None:
        """Copy the drives' rotors, gains and limits, which are set on the running model."""
        there, here = self._indices["qvel"]
        rotors = source.dof_armature[there]
        # As `Servo` does when it sets them.
        target.dof_M0[here] += rotors - target.dof_armature[here]
        target.dof_armature[here] = rotors
        there, here = self._drives
        for name in DRIVE_ARRAYS:
            getattr(target, name)[here] = getattr(source, name)[there]


def _pairs(
    source: mujoco.MjModel, target: mujoco.MjModel, roots: Collection[str]
) -> dict[ModelElement, list[Pair]]:
    """Return the numbers in both models of the elements that continue."""
    same_world = source.body(0).name in roots
    joints = list(_joints(source, target, roots))
    of_joints, bodies = dict(joints), list(_bodies(source, target, roots))
    others = {
        element: list(_namesakes(source, target, kind, count)) if same_world else []
        for element, kind, count in (
            (ModelElement.SENSOR, OBJECT.mjOBJ_SENSOR, source.nsensor),
            (ModelElement.TENDON, OBJECT.mjOBJ_TENDON, source.ntendon),
            (ModelElement.FLEX, OBJECT.mjOBJ_FLEX, source.nflex),
        )
    }
    return {
        ModelElement.WORLD: [(0, 0)] if same_world else [],
        ModelElement.BODY: bodies,
        ModelElement.MOCAP: list(_mocaps(source, target, bodies)),
        ModelElement.JOINT: joints,
        ModelElement.ACTUATOR: list(_actuators(source, target, of_joints, same_world)),
        ModelElement.EQUALITY: list(_equalities(source, target, of_joints, same_world)),
        **others,
    }


def _namesakes(
    source: mujoco.MjModel, target: mujoco.MjModel, kind: mujoco.mjtObj, count: int
) -> Iterator[Pair]:
    """Yield the numbers of elements that have the same name in both models."""
    for number in range(count):
        name = mujoco.mj_id2name(source, kind, number)
        other = mujoco.mj_name2id(target, kind, name) if name else -1
        if other >= 0:
            yield number, other


def _bodies(
    source: mujoco.MjModel, target: mujoco.MjModel, roots: Collection[str]
) -> Iterator[Pair]:
    for body, other in _namesakes(source, target, OBJECT.mjOBJ_BODY, source.nbody):
        if source.body(source.body_rootid[body]).name in roots:
            yield body, other


def _joints(
    source: mujoco.MjModel, target: mujoco.MjModel, roots: Collection[str]
) -> Iterator[Pair]:
    for joint, other in _namesakes(source, target, OBJECT.mjOBJ_JOINT, source.njnt):
        root = source.body(source.body_rootid[source.jnt_bodyid[joint]]).name
        if root in roots and target.jnt_type[other] == source.jnt_type[joint]:
            yield joint, other


def _actuators(
    source: mujoco.MjModel, target: mujoco.MjModel, joints: dict[int, int], same_world: bool
) -> Iterator[Pair]:
    for actuator, other in _namesakes(source, target, OBJECT.mjOBJ_ACTUATOR, source.nactuator):
        if source.actuator_trntype[actuator] == mujoco.mjtTrn.mjTRN_JOINT:
            joint = int(source.actuator_trnid[actuator, 0])
            continues = joints.get(joint) == int(target.actuator_trnid[other, 0])
        else:
            continues = same_world
        if continues:
            yield actuator, other


def _equalities(
    source: mujoco.MjModel, target: mujoco.MjModel, joints: dict[int, int], same_world: bool
) -> Iterator[Pair]:
    for equality, other in _namesakes(source, target, OBJECT.mjOBJ_EQUALITY, source.neq):
        kind = source.eq_type[equality]
        if kind == mujoco.mjtEq.mjEQ_JOINT:
            joint = int(source.eq_obj1id[equality])
            continues = joints.get(joint) == int(target.eq_obj1id[other])
        else:
            continues = same_world
        if continues and kind == target.eq_type[other]:
            yield equality, other


def _mocaps(
    source: mujoco.MjModel, target: mujoco.MjModel, bodies: Sequence[Pair]
) -> Iterator[Pair]:
    for body, other in bodies:
        # A body with another pose in the target model was moved there on purpose.
        if np.array_equal(source.body_pos[body], target.body_pos[other]) and np.array_equal(
            source.body_quat[body], target.body_quat[other]
        ):
            yield body, other


def _indices(
    source: mujoco.MjModel,
    target: mujoco.MjModel,
    length: str,
    fields: Mapping[str, ModelElement],
    pairs: Mapping[ModelElement, Sequence[Pair]],
) -> tuple[Indices, Indices]:
    """Return where the same values are in an array of both models, shape (n,) each."""
    there, here = (_parts(model, length, fields) for model in (source, target))
    found = [
        (there[field][one], here[field][other])
        for field, element in fields.items()
        for one, other in pairs[element]
    ]
    # An element whose part has another size was made anew.
    same = [both for both in found if len(both[0]) == len(both[1])]
    places = [pair for one, other in same for pair in zip(one, other, strict=True)]
    table = np.array(places, dtype=np.intp).reshape(-1, 2)
    return table[:, 0], table[:, 1]


def _parts(
    model: mujoco.MjModel, length: str, fields: Mapping[str, ModelElement]
) -> dict[str, list[range]]:
    """Return for each field which values of an array belong to each element."""
    total = getattr(model, length)
    starts: dict[str, Sequence[int]] = {
        name: getattr(model, name).tolist()
        if name
        else range(1 if element is ModelElement.WORLD else total)
        for name, element in fields.items()
    }
    ends = [*sorted(start for each in starts.values() for start in each if start >= 0), total]
    return {
        name: [
            range(start, ends[bisect_right(ends, start, hi=len(ends) - 1)])
            if start >= 0
            else range(0)
            for start in each
        ]
        for name, each in starts.items()
    }


MODEL_ARRAYS = (*DRIVE_ARRAYS, "dof_armature", "dof_M0")
"""Fields of the model that the drives set."""
AWAKE_COUNTS = ("nbody_awake", "nparent_awake", "ntree_awake", "nv_awake")


class PhysicsState:
    """The running part of one model and its state. Loop thread.

    After a step, MuJoCo's derived quantities (inertias, gravity, poses of shapes) belong to the
    state before it. The drives read them, and MuJoCo itself keeps those of sleeping bodies. So the
    integration state alone would not let a run continue with the same bits, and all arrays are
    saved.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Refer to a model and its state."""
        self._model = model
        self._data = data
        self._names: tuple[str, ...] = ()
        self._integration = np.empty(mujoco.mj_stateSize(model, EVERYTHING))

    def save(self) -> dict[str, Any]:
        """Return the arrays themselves, by name; encode them at once."""
        data, model = self._data, self._model
        if not self._names:
            self._names = _array_names(mujoco.MjData(model))
        return {
            "time": data.time,
            "arrays": {name: getattr(data, name) for name in self._names},
            "awake": [getattr(data, name) for name in AWAKE_COUNTS],
            "model": {name: getattr(model, name) for name in MODEL_ARRAYS},
        }

    def load(self, state: dict[str, Any]) -> None:
        """Restore saved arrays of the same model.

        Raises:
            StateError: they are those of another model or of another MuJoCo; nothing has changed.
        """
        for owner, saved in ((self._model, state["model"]), (self._data, state["arrays"])):
            for name, values in saved.items():
                if getattr(getattr(owner, name, None), "shape", None) != values.shape:
                    raise StateError(
                        f"the state's array {name} does not fit this model in MuJoCo "
                        f"{mujoco.__version__}"
                    )
        for name, values in state["model"].items():
            getattr(self._model, name)[...] = values
        self._load_data(state)
        # Contacts are not saved; they are computed again from this state for whatever shows them.
        mujoco.mj_forward(self._model, self._data)
        self._load_data(state)

    def _load_data(self, state: dict[str, Any]) -> None:
        data = self._data
        for name, values in state["arrays"].items():
            getattr(data, name)[...] = values
        # With the counts of another state MuJoCo looks for contacts between sleeping bodies, and
        # ends with an error if it finds one.
        for name, count in zip(AWAKE_COUNTS, state["awake"], strict=True):
            setattr(data, name, count)
        data.time = state["time"]

    def integration(self) -> NDArray[np.float64]:
        """Return the numbers that the next step depends on; valid until the next call."""
        mujoco.mj_getState(self._model, self._data, self._integration, EVERYTHING)
        return self._integration


def _array_names(fresh: mujoco.MjData) -> tuple[str, ...]:
    """Return the names of the arrays whose size does not depend on the contacts."""
    return tuple(
        name
        for name in dir(fresh)
        if not name.startswith("_")
        and isinstance(values := getattr(fresh, name), np.ndarray)
        and values.size
    )
