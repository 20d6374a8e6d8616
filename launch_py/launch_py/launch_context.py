"""The context in which actions are expanded: the scope, and the plan that they add to."""

from __future__ import annotations

from dataclasses import dataclass, field

from launch_py.plan.builder import PlanBuilder
from launch_py.plan.steps import Trigger
from launch_py.substitution import LaunchScope


@dataclass(slots=True)
class LaunchContext(LaunchScope):
    """The scope in which actions are expanded, and the plan that collects their steps.

    All copies of the context share the plan.
    """

    plan: PlanBuilder = field(default_factory=PlanBuilder)
    after: tuple[Trigger, ...] = ()
    """The events that the steps added in this scope wait for."""
    delay_s: float = 0.0
    """How long the steps wait after those events."""
