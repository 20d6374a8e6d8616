# The steps of CI: `make check` runs linters and type checker, `make test` the tests, and
# `make docs` builds the manual into site/. `make kilted` tests on ROS 2 Kilted.
PYTHON ?= python3
RUN := $(PYTHON) -m

.PHONY: install check docs format test kilted

# An environment holds one distribution of ROS 2, so Kilted's is in a folder of its own.
KILTED ?= .venv-kilted
# The launch with a command, joint states and pictures; discovery, and that other hosts find nothing.
KILTED_TESTS := tests/ros/test_arm_launch.py tests/ros/test_keeps_to_this_host.py \
	tests/arm_node/workarounds/test_discovery.py tests/arm_node/workarounds/test_local_profile.py \
	tests/launch_py/system/test_dds_profile.py

install:
	$(RUN) pip install ./arm_interfaces ./arm_moveit_interfaces '.[test,dev,docs]'

check:
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(RUN) pyright --pythonpath "$$($(PYTHON) -c 'import sys; print(sys.executable)')"

format:
	$(RUN) ruff check --fix .
	$(RUN) ruff format .

test:
	$(RUN) pytest -n 3 --dist loadfile

# The variable switches off a notice of mkdocs-material about its successor.
docs:
	NO_MKDOCS_2_WARNING=1 $(RUN) mkdocs build --strict

kilted:
	$(PYTHON) -m venv $(KILTED)
	ROS_DISTRO=kilted $(KILTED)/bin/python -m pip install -q ./arm_interfaces . \
		pytest pytest-timeout pytest-xdist hypothesis psutil
	[ "$$($(KILTED)/bin/python -c 'import arm_node.ros_distribution as d; print(d.ros_distribution())')" = kilted ]
	$(KILTED)/bin/python -m pytest -n 3 --dist loadfile $(KILTED_TESTS)
