#!/usr/bin/env bash
# minari 0.5.4, gymnasium 1.4.0: of an environment that fills the same array again, only the last is recorded.
#
# Gymnasium asks of an observation that it lies in its space, not that it is a new array, and simulators hand
# out views of their state. A good guess is that what keeps observations beyond the next step copies
# them, as gymnasium's vector environments do. minari's DataCollector keeps the array itself until the
# episode ends: a recorded episode of 0, 1, 2, 3 has 3 in every row, with the right shape, rewards and actions,
# and is written without a warning. A mean or a learned policy of it is nonsense. gymnasium's
# FrameStackObservation shows the newest frame three times. An environment that returns a copy is
# recorded right.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'minari[create,hdf5]==0.5.4' 'gymnasium==1.4.0' 'pillow==13.0.0' 'numpy==2.4.6'
cd "$folder"

cat > slide.py <<'PYTHON'
import gymnasium
import numpy as np


class Slide(gymnasium.Env):
    """Something that moves by 1 in each step."""

    def __init__(self, copy: bool = False):
        self.observation_space = gymnasium.spaces.Box(-10, 10, (1,), np.float64)
        self.action_space = gymnasium.spaces.Box(-1, 1, (1,), np.float64)
        self._place, self._copy = np.zeros(1), copy

    def _observed(self) -> np.ndarray:
        return self._place.copy() if self._copy else self._place

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple[np.ndarray, dict]:
        super().reset(seed=seed)
        self._place[:] = 0
        return self._observed(), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict]:
        self._place += 1
        return self._observed(), float(self._place[0]), False, False, {}
PYTHON

MINARI_DATASETS_PATH="$folder/datasets" venv/bin/python -W ignore - <<'PYTHON'
import sys
from importlib.metadata import version

import gymnasium
import minari
import numpy as np

sys.path.insert(0, ".")
gymnasium.register("Slide-v0", "slide:Slide", max_episode_steps=3)


def recorded(copy: bool) -> tuple[list[int], list[int]]:
    """Return the observations and the rewards of a recorded episode of three steps."""
    collector = minari.DataCollector(gymnasium.make("Slide-v0", copy=copy))
    collector.reset(seed=0)
    for _ in range(3):
        collector.step(np.zeros(1))
    episode = collector.create_dataset(f"slide/{'copy' if copy else 'same'}-v0")[0]
    collector.close()
    return [int(value) for value in episode.observations.ravel()], [int(value) for value in episode.rewards]


def stacked(copy: bool) -> list[int]:
    """Return the last three observations after three steps."""
    env = gymnasium.wrappers.FrameStackObservation(gymnasium.make("Slide-v0", copy=copy), 3)
    env.reset(seed=0)
    for _ in range(3):
        observation = env.step(np.zeros(1))[0]
    return [int(value) for value in observation.ravel()]


def vectors(copy: bool) -> list[int]:
    """Return what a vector environment gave at each step, looked at after the last one."""
    env = gymnasium.vector.SyncVectorEnv([lambda: gymnasium.make("Slide-v0", copy=copy)])
    found = [env.reset(seed=0)[0]] + [env.step(np.zeros((1, 1)))[0] for _ in range(3)]
    return [int(value[0, 0]) for value in found]


print("minari", version("minari"), "gymnasium", version("gymnasium"))
found = {copy: (*recorded(copy), stacked(copy), vectors(copy)) for copy in (False, True)}
for copy, (observations, rewards, stack, vector) in found.items():
    print(f"{'a copy' if copy else 'the same array'} each time:")
    print(f"   minari: observations {observations}, rewards {rewards}")
    print(f"   FrameStackObservation: {stack}; SyncVectorEnv: {vector}")
right = [0, 1, 2, 3], [1, 2, 3], [1, 2, 3], [0, 1, 2, 3]
if found != {True: right, False: ([3, 3, 3, 3], [1, 2, 3], [3, 3, 3], [0, 1, 2, 3])}:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# minari 0.5.4 gymnasium 1.4.0
# the same array each time:
#    minari: observations [3, 3, 3, 3], rewards [1, 2, 3]
#    FrameStackObservation: [3, 3, 3]; SyncVectorEnv: [0, 1, 2, 3]
# a copy each time:
#    minari: observations [0, 1, 2, 3], rewards [1, 2, 3]
#    FrameStackObservation: [1, 2, 3]; SyncVectorEnv: [0, 1, 2, 3]
