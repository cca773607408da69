# Two commands are all a fresh machine needs: `make demo` and `make test`.

PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
SCENES := $(sort $(wildcard scenes/*.yaml))

.PHONY: help demo test test-newest test-lowest check format tests golden expectations figures reference bench torture fuzz lock upgrade clean

help: ## list the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 16

demo: $(VENV)/installed ## install, run scenes/rods.yaml, draw the strip
	$(BIN)/atomsim run scenes/rods.yaml --force
	$(BIN)/atomsim render out.h5 --rounds 0,300,600,1300
	@echo "Now look at out.png."

test: check tests golden expectations ## everything that must hold

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

expectations: $(VENV)/installed-dev ## every scene does what it says it should
	$(BIN)/atomsim test scenes -j 2

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
	rm -rf $(VENV) $(VENV)-newest $(VENV)-lowest out.h5 out.png

# The locked versions with their hashes; then the project itself, which needs nothing more.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check

$(VENV)/installed: pyproject.toml requirements/run.txt
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) --require-hashes --requirement requirements/run.txt
	$(INSTALL) --no-deps --no-build-isolation --editable .
	@touch $@

$(VENV)/installed-dev: pyproject.toml requirements/dev.txt
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) --require-hashes --requirement requirements/dev.txt
	$(INSTALL) --no-deps --no-build-isolation --editable .
	@touch $(VENV)/installed $@

$(VENV)/installed-fuzz: $(VENV)/installed
	$(INSTALL) --editable '.[fuzz]'
	@touch $@

$(VENV)/installed-bench: $(VENV)/installed-dev
	@for peer in jax warp-lang openmm; do $(INSTALL) $$peer || echo "$$peer: not installed"; done
	@touch $@

# Other versions than the locked ones: only what depends on them is tried, and warnings are told, not errors.
SHORT := --numprocesses 2 --dist worksteal -W default tests/unit tests/cli tests/golden
NEWEST_PYTHON := $(firstword $(foreach v,14 13 12 11,$(shell python3.$(v) -c 'print("python3.$(v)")' 2>/dev/null)) $(PYTHON))

test-newest: ## a short pass with the newest versions, on the newest Python at hand
	$(NEWEST_PYTHON) -m venv --clear $(VENV)-newest
	$(VENV)-newest/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	$(VENV)-newest/bin/python -m pytest $(SHORT)

test-lowest: ## a short pass with the lowest versions that pyproject.toml allows
	$(PYTHON) -m venv --clear $(VENV)-lowest
	$(VENV)-lowest/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes \
		--requirement requirements/lowest.txt
	$(VENV)-lowest/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	$(VENV)-lowest/bin/python -m pytest $(SHORT)

COMPILE := $(BIN)/uv pip compile pyproject.toml --quiet --universal --python-version 3.11 --no-annotate --no-header
HASHED  := $(COMPILE) requirements/build.in --generate-hashes

lock: $(VENV)/installed-dev ## write requirements/ again after a change of pyproject.toml; what is locked stays
	$(HASHED) --extra dev --output-file requirements/dev.txt
	$(HASHED) --constraint requirements/dev.txt --output-file requirements/run.txt
	$(COMPILE) --extra fast --resolution lowest-direct --output-file $(VENV)/lowest.txt
	$(HASHED) --extra dev --constraint $(VENV)/lowest.txt --output-file requirements/lowest.txt

upgrade: $(VENV)/installed-dev ## move the locked versions to the newest, and say what moved
	@cp requirements/dev.txt $(VENV)/dev-before.txt
	@$(HASHED) --upgrade --extra dev --output-file requirements/dev.txt
	@$(MAKE) --no-print-directory lock
	@diff $(VENV)/dev-before.txt requirements/dev.txt | sed -n '/==/{s/ \\$$//; s/^</was/p; s/^>/now/p}'
