#!/usr/bin/env bash
# lerobot 0.6.1: q01 and q99 of a dataset are the means of its episodes' q01 and q99.
#
# A good guess is that q99 in meta/stats.json is what 99 % of the dataset's frames do not exceed, as the
# min, max, mean and std beside it are those of all frames. aggregate_feature_stats() takes the mean of
# the episodes' quantiles instead. Where episodes differ, it lies far inside: one episode in ten reaches
# to 0.8 rad here, the true q99 is 0.72, and 0.17 is written; 8 % of all frames are beyond it. Policies that
# are normalised by QUANTILES map q01 and q99 to -1 and 1. Issue 4156 of huggingface/lerobot, open.
# The function is taken out of the wheel, as the package itself imports torch.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'numpy==2.4.6'
"$folder/venv/bin/pip" download -q --no-deps --only-binary=:all: --python-version 3.12 \
  -d "$folder" 'lerobot==0.6.1'

"$folder/venv/bin/python" - "$folder"/lerobot-*.whl <<'PYTHON'
import ast
import sys
import zipfile
from pathlib import Path

import numpy as np

wheel = Path(sys.argv[1])
with zipfile.ZipFile(wheel) as archive:
    source = ast.parse(archive.read("lerobot/datasets/compute_stats.py"))
names = {"np": np}
source.body = [
    part
    for part in source.body
    if isinstance(part, ast.FunctionDef) and part.name == "aggregate_feature_stats"
]
exec(compile(source, "compute_stats.py", "exec"), names)


def statistics(values: np.ndarray) -> dict[str, np.ndarray]:
    """Return what stands in a dataset for values of shape (frames, joints)."""
    return {
        "min": values.min(axis=0),
        "max": values.max(axis=0),
        "mean": values.mean(axis=0),
        "std": values.std(axis=0),
        "count": np.array([len(values)]),
        "q01": np.quantile(values, 0.01, axis=0),
        "q99": np.quantile(values, 0.99, axis=0),
    }


near, far = np.linspace(-0.1, 0.1, 1000)[:, None], np.linspace(0.0, 0.8, 1000)[:, None]
episodes = [near] * 9 + [far]
frames = np.concatenate(episodes)
merged = names["aggregate_feature_stats"]([statistics(one) for one in episodes])
true = statistics(frames)
print(wheel.name.split("-py3")[0])
for name in true:
    print(f"{name}: {float(merged[name][0]):.3f}, of all frames {float(true[name][0]):.3f}")
beyond = float((frames > merged["q99"]).mean())
print(f"{beyond:.1%} of the frames are above q99")
same = {name for name in true if np.allclose(merged[name], true[name])}
if same != {"min", "max", "mean", "std", "count"}:
    sys.exit("the behaviour has changed")
if not np.isclose(merged["q99"][0], np.mean([statistics(one)["q99"] for one in episodes])):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# lerobot-0.6.1
# min: -0.100, of all frames -0.100
# max: 0.800, of all frames 0.800
# mean: 0.040, of all frames 0.040
# std: 0.151, of all frames 0.151
# count: 10000.000, of all frames 10000.000
# q01: -0.087, of all frames -0.098
# q99: 0.167, of all frames 0.720
# 7.9% of the frames are above q99
