# The steps of CI: `make check` runs linters and type checker, `make test` the tests, and
# `make docs` builds the manual into site/.
PYTHON ?= python3
RUN := $(PYTHON) -m

.PHONY: install check docs format test

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
