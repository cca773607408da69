# Two commands are all a fresh machine needs: `make demo` and `make test`.

PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
SCENES := $(sort $(wildcard scenes/*.yaml))

.PHONY: help demo test check format tests golden figures reference bench torture fuzz clean

help: ## list the targets
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

demo: $(VENV)/installed ## install, run scenes/rods.yaml, draw the strip
	$(BIN)/atomsim run scenes/rods.yaml --force
	$(BIN)/atomsim render out.h5 --rounds 0,300,600,1300
	@echo "Now look at out.png."

test: check tests golden ## everything that must hold

check: $(VENV)/installed-dev ## format, lint, types, layers
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo

tests: $(VENV)/installed-dev ## the test suite
	$(BIN)/pytest --numprocesses 2 --dist worksteal

golden: $(VENV)/installed-dev ## every scene against its golden trajectory, bit for bit
	$(BIN)/atomsim golden check $(SCENES) --into tests/golden --backend numpy
	$(BIN)/atomsim golden check $(SCENES) --into tests/golden --backend numba

format: $(VENV)/installed-dev ## put the code into its format
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

figures: $(VENV)/installed ## draw the pictures of the docs again
	$(BIN)/python docs/make_figures.py

reference: $(VENV)/installed ## write the generated pages of the docs and the JSON Schema again
	$(BIN)/python docs/make_reference.py

bench: $(VENV)/installed-bench ## time everything, on a quiet machine: five minutes; docs/speed.md shows the result
	$(BIN)/python -m benchmarks --json docs/speed.json
	$(BIN)/python -m benchmarks.page docs/speed.json

torture: $(VENV)/installed-dev ## hundreds of kills, thousands of damaged files, a million rounds: an hour
	ATOMSIM_LONG=1 $(BIN)/pytest tests/torture tests/unit/trajectory tests/cli/test_cli_hostile.py tests/property \
		--capture=no --timeout=7200

fuzz: $(VENV)/installed-fuzz ## coverage-guided fuzzing of scenes: five minutes
	$(BIN)/python tests/fuzz/fuzz_scene.py -max_total_time=300

clean: ## remove what the other targets made
	rm -rf $(VENV) out.h5 out.png

$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(VENV)/installed-dev: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(VENV)/installed $@

$(VENV)/installed-fuzz: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[fuzz]'
	@touch $@

$(VENV)/installed-bench: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[fast]'
	@for peer in jax warp-lang openmm; do \
		$(BIN)/python -m pip install --quiet --disable-pip-version-check $$peer || echo "$$peer: not installed"; \
	done
	@touch $@
