"""Steps an environment of a pick with random actions; prints its steps a second of processor time.

Called by `pick_env.py`: PYTHON pick_env_client.py MODULE ID STEPS
"""

import importlib
import sys
import time

import gymnasium

LIMIT = {"FetchPickAndPlace-v4": 50, "arm_sim/ArmPick-v0": 400}
"""Actions of an episode; resets are not timed."""


def main() -> None:
    """Print the figure."""
    module, name, steps = sys.argv[1], sys.argv[2], int(sys.argv[3])
    gymnasium.register_envs(importlib.import_module(module))
    env = gymnasium.make(name)
    env.action_space.seed(0)
    spent_s, done = 0.0, 0
    while done < steps:
        env.reset(seed=done)
        actions = [env.action_space.sample() for _ in range(LIMIT[name])]
        began_s = time.process_time()
        for action in actions:
            done += 1
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                break
        spent_s += time.process_time() - began_s
    print(done / spent_s)


if __name__ == "__main__":
    main()
