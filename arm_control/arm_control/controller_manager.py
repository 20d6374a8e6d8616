"""Loads, configures, switches and updates controllers on top of hardware components."""

import logging
from collections.abc import Iterable, Sequence
from typing import Any, Protocol

from arm_control.controller import Controller, ControllerContext
from arm_control.controller_switch import Strictness, SwitchRequest, SwitchResult
from arm_control.errors import ControllerManagerError
from arm_control.guarded import failure_of
from arm_control.hardware import Hardware, HardwareReturn
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.managed_controller import ManagedController
from arm_control.registry import controller_class
from arm_control.resource_manager import ResourceManager, Trouble
from arm_control.status import ControllerStatus, HardwareComponentStatus, InterfaceStatus
from arm_control.switch_planner import SwitchPlan, SwitchPlanner, SwitchRefusedError

logger = logging.getLogger(__name__)
