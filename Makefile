# What CI does, for a person: `make check` for the linters and types, `make test` for the tests.
PYTHON ?= python3
RUN := $(PYTHON) -m

.PHONY: install check format test

install:
	$(RUN) pip install ./arm_interfaces '.[test,dev]'

check:
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(RUN) pyright --pythonpath "$$($(PYTHON) -c 'import sys; print(sys.executable)')"

format:
	$(RUN) ruff check --fix .
	$(RUN) ruff format .

test:
	$(RUN) pytest
