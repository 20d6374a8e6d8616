"""Checks what tests expect of joints, and describes what happened instead."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from arm_sim.bench.history import QUANTITIES, ReferenceLine, StateHistory
from arm_sim.errors import CallError, UnknownNameError

Target = Mapping[str, float] | Sequence[float] | NDArray[np.float64]
"""Positions by joint, or of all joints in their order, in rad or m."""

Limit = float | tuple[float, float] | Mapping[str, "float | tuple[float, float]"]
"""A bound of the magnitude, or the lowest and the highest value; for all joints, or by joint."""

AT_REST = 1e-3
"""Speed in rad/s or m/s below which a message says that a joint is at rest."""


class TargetCheck:
    """Whether joints are at their targets, all at the same time.

    Call it as the history grows; it looks only at new states.

    Args:
        history: the states.
        target: where the joints must be.
        tolerance: largest distance from it, in rad or m.
        hold_s: how long they must stay there.

    Raises:
        CallError, UnknownNameError: these are not positions of these joints.
    """

    def __init__(
        self, history: StateHistory, target: Target, tolerance: float, hold_s: float = 0.0
    ) -> None:
        if not tolerance > 0.0:
            raise CallError(f"the tolerance must be positive, not {tolerance}")
        self._history = history
        self._tolerance = tolerance
        self._hold_s = hold_s
        self._targets = _targets(history, target)
        self._indices = [history.names.index(name) for name in self._targets]
        self._values = np.array(list(self._targets.values()))
        self._first = self._next = max(0, len(history) - 1)
        self._there_since_s: float | None = None
        history.guides += [ReferenceLine("position", name, v) for name, v in self._targets.items()]

    def __call__(self) -> bool:
        """Return whether the joints have been at their targets for long enough."""
        history, first = self._history, self._next
        times_s = history.times_s[first:]
        positions = history.position[first:][: len(times_s), self._indices]
        errors = np.abs(positions - self._values).max(axis=1)
        for time_s, error in zip(times_s.tolist(), errors.tolist(), strict=True):
            self._next += 1
            if not error <= self._tolerance:
                self._there_since_s = None
                continue
            if self._there_since_s is None:
                self._there_since_s = time_s
            if time_s - self._there_since_s >= self._hold_s - 1e-9:
                return True
        return False

    def explain(self, within_s: float) -> str:
        """Return what happened instead."""
        positions = self._history.position[self._first :]
        if not len(positions):
            return "no state of the joints was seen"
        away = [
            name
            for name, target in self._targets.items()
            if not abs(self._last(name) - target) <= self._tolerance
        ]
        if not away:
            return (
                f"the joints are at the target, but do not stay for {self._hold_s:g} s "
                f"within {within_s:g} s"
            )
        lines = [f"the joints do not reach the target within {within_s:g} s"]
        lines += [self._describe(name) for name in away]
        there = [name for name in self._targets if name not in away]
        if there:
            lines.append(f"  {', '.join(there)}: at the target")
        return "\n".join(lines)

    def _last(self, name: str) -> float:
        return float(self._history.position[-1, self._history.names.index(name)])

    def _describe(self, name: str) -> str:
        history, target = self._history, self._targets[name]
        index, unit = history.names.index(name), history.unit(name, "position")
        last = self._last(name)
        return (
            f"  {name}: at {_value(last, unit)}, {_value(abs(last - target), unit)} from "
            f"{_value(target, unit)} (tolerance {self._tolerance:g}); {self._motion(name, index)}"
        )

    def _motion(self, name: str, index: int) -> str:
        history = self._history
        times_s, velocity = history.times_s, history.velocity[:, index]
        if not np.isfinite(velocity[-1]) or abs(velocity[-1]) > AT_REST:
            return f"it moves at {_value(float(velocity[-1]), history.unit(name, 'velocity'))}"
        moving = np.flatnonzero(np.abs(velocity[: len(times_s)]) > AT_REST)
        if not len(moving):
            return "it has not moved"
        return f"it has been at rest since {times_s[moving[-1]]:.3f} s"


class JointAssertions(ABC):
    """The assertions about joints, of a simulation or of what a launch has started.

    Attributes:
        history: the states of the joints since the test began.
    """

    history: StateHistory

    @abstractmethod
    def run_until(self, condition: Callable[[], bool], timeout_s: float) -> bool:
        """Let time pass until a condition holds, or so many simulated seconds; return whether."""

    @abstractmethod
    def _circumstances(self) -> Iterable[str]:
        """Return sentences about the circumstances, such as faults and contacts."""

    def _states(self) -> StateHistory:
        """Return the history as soon as the joints are known."""
        return self.history

    def assert_reaches(
        self,
        target: Target,
        *,
        within_s: float = 5.0,
        tolerance: float = 0.01,
        hold_s: float = 0.0,
    ) -> None:
        """Run until the joints are at their targets, all at the same time.

        Args:
            target: positions by joint, or of all joints in their order, in rad or m.
            within_s: simulated seconds to wait at most.
            tolerance: largest distance of each joint from its target, in rad or m.
            hold_s: how long they must stay there, in simulated seconds.

        Raises:
            AssertionError: they do not get there; the message says what they do instead.
            CallError, UnknownNameError: this is not a target for these joints.
        """
        __tracebackhide__ = True
        reaching = TargetCheck(self._states(), target, tolerance, hold_s)
        if not self.run_until(reaching, within_s):
            raise AssertionError("\n".join([reaching.explain(within_s), *self._circumstances()]))

    def assert_never_exceeds(
        self,
        *,
        position: Limit | None = None,
        velocity: Limit | None = None,
        effort: Limit | None = None,
    ) -> None:
        """Check all states since the test began against bounds.

        Each bound is a number that the magnitude must not exceed, or a tuple of the lowest and the
        highest value; for all joints, or a mapping by joint.

        Args:
            position: in rad or m.
            velocity: in rad/s or m/s.
            effort: of the drives, in N m or N.

        Raises:
            AssertionError: a value was beyond its bound, or not a number; the message says when.
            CallError, UnknownNameError: these are not bounds of these joints.
        """
        __tracebackhide__ = True
        limits = {"position": position, "velocity": velocity, "effort": effort}
        history = self._states()
        found = [
            sentence
            for quantity, limit in limits.items()
            if limit is not None
            for sentence in violations(history, quantity, limit)
        ]
        if found:
            raise AssertionError("\n".join([*found, *self._circumstances()]))


def violations(history: StateHistory, quantity: str, limit: Limit) -> list[str]:
    """Return a sentence for each joint whose positions, velocities or efforts broke the bounds.

    Raises:
        CallError, UnknownNameError: these are not bounds of these joints.
    """
    found: list[str] = []
    for name, (lowest, highest) in _bounds(history, quantity, limit).items():
        times_s = history.times_s
        values = history.of(quantity)[: len(times_s), history.names.index(name)]
        # A NaN is not within any bounds.
        beyond = ~((values >= lowest) & (values <= highest))
        if beyond.any():
            history.guides += [
                ReferenceLine(quantity, name, lowest),
                ReferenceLine(quantity, name, highest),
            ]
            found.append(_violation(history, name, quantity, (lowest, highest), beyond))
    return found


def _violation(
    history: StateHistory,
    name: str,
    quantity: str,
    bounds: tuple[float, float],
    beyond: NDArray[np.bool_],
) -> str:
    values, times_s = history.of(quantity)[:, history.names.index(name)], history.times_s
    where = np.flatnonzero(beyond)
    overshoot = np.maximum(values[where] - bounds[1], bounds[0] - values[where])
    # A NaN counts as the largest value.
    worst = int(where[np.argmax(overshoot)])
    bound = bounds[1] if values[worst] > bounds[1] else bounds[0]
    unit = history.unit(name, quantity)
    times = sum(is_beyond for is_beyond, _ in groupby(beyond))
    return (
        f"{name}: {quantity} {_value(float(values[worst]), unit)} at {times_s[worst]:.3f} s, "
        f"beyond {_value(bound, unit)}; first at {times_s[where[0]]:.3f} s, last at "
        f"{times_s[where[-1]]:.3f} s" + (f", {times} times" if times > 1 else "")
    )


def _targets(history: StateHistory, target: Target) -> dict[str, float]:
    names = history.names
    if isinstance(target, Mapping):
        by_joint = {str(name): float(value) for name, value in target.items()}
    else:
        values = [float(value) for value in target]
        if len(values) != len(names):
            raise CallError(
                f"the target has {len(values)} values, and the robot {len(names)} joints: "
                f"{', '.join(names)}; give positions by joint to name fewer"
            )
        by_joint = dict(zip(names, values, strict=True))
    _check_names(history, by_joint)
    if not by_joint or not np.isfinite(list(by_joint.values())).all():
        raise CallError(f"a target is finite positions of at least one joint, not {target!r}")
    return by_joint


def _bounds(history: StateHistory, quantity: str, limit: Limit) -> dict[str, tuple[float, float]]:
    if quantity not in QUANTITIES:
        raise CallError(f"there is no quantity '{quantity}'; there are {', '.join(QUANTITIES)}")
    by_joint = limit if isinstance(limit, Mapping) else dict.fromkeys(history.names, limit)
    _check_names(history, by_joint)
    bounds: dict[str, tuple[float, float]] = {}
    for name, bound in by_joint.items():
        lowest, highest = bound if isinstance(bound, tuple) else (-bound, bound)
        if not lowest <= highest:
            raise CallError(f"the {quantity} of '{name}' cannot be between {lowest} and {highest}")
        bounds[name] = (float(lowest), float(highest))
    return bounds


def _check_names(history: StateHistory, by_joint: Mapping[str, object]) -> None:
    for name in by_joint:
        if name not in history.names:
            raise UnknownNameError(f"no joint '{name}'; the robot has {', '.join(history.names)}")


def _value(value: float, unit: str) -> str:
    return f"{value:.4f} {unit}".rstrip()
