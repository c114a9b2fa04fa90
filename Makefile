# shotc: every task a contributor needs. `make` lists them.
.DEFAULT_GOAL := help
SHELL := $(if $(filter Windows_NT,$(OS)),bash,/bin/bash)
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/$(if $(filter Windows_NT,$(OS)),Scripts,bin)
STAMP := $(VENV)/.installed
PLUGINS := $(wildcard plugins/*/pyproject.toml)
UV := $(shell command -v uv 2>/dev/null)
# Two tests at once need no threads of BLAS beside them.
PYTEST := OMP_NUM_THREADS=1 $(BIN)/pytest -n 2 --dist loadgroup --no-loadscope-reorder
# Tests start many processes: all but the first find the modules compiled.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help setup demo test test-all test-fast fuzz check lint type fmt layers platforms gen gen-check bless bench mutants papers build clean

help: ## List the tasks
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 14

setup: $(STAMP) ## Make .venv with shotc, its plugins and all tools in it

$(STAMP): pyproject.toml $(PLUGINS)
ifdef UV
	uv venv --quiet --allow-existing --python '>=3.11' $(VENV)
	uv pip install --quiet --python $(BIN)/python -e '.[dev]' $(foreach p,$(PLUGINS),-e $(dir $(p)))
else
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	  || { echo "shotc needs Python 3.11 or newer; try: make $(MAKECMDGOALS) PYTHON=python3.12" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[dev]' $(foreach p,$(PLUGINS),-e $(dir $(p)))
endif
	@touch $@

demo: $(STAMP) ## Plan a real mission and say where to look at it
	$(BIN)/shotc plan specs/westerhever-lighthouse.yaml
	@echo "  look      out/westerhever-lighthouse/storyboard.png, or play it: $(BIN)/shotc view out/westerhever-lighthouse/plan.json"

test: $(STAMP) ## Run the tests that are not marked long
	$(PYTEST) -m "not long and not fuzz"

test-all: $(STAMP) ## Run every test
	$(PYTEST)

test-fast: $(STAMP) ## Run the tests that are marked neither slow nor long
	$(PYTEST) -m "not slow and not long and not fuzz"

fuzz: $(STAMP) ## Plan 300 drawn missions, run the long cases, and every property test with new random numbers
	CI= FUZZ=1 $(PYTEST) -m "fuzz or hypothesis"

check: lint type layers gen-check platforms test-all build ## Everything, as CI runs it

lint: $(STAMP) ## Lint and formatting
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

type: $(STAMP) ## Strict types
	$(BIN)/mypy

layers: $(STAMP) ## Imports point down only
	$(BIN)/lint-imports

platforms: $(STAMP) ## Every platform has wheels of what is required, or states why not
	$(BIN)/python -m tests.platforms

fmt: $(STAMP) ## Format and fix
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

gen: $(STAMP) ## Write the generated files: schema, reference
	$(BIN)/python -m shotc.cli.generate

gen-check: $(STAMP) ## Fail where a generated file is out of date
	$(BIN)/python -m shotc.cli.generate --check

bless: $(STAMP) ## Rewrite the golden files of the tests; read the diff before you commit it
	$(PYTEST) --bless tests
	$(PYTEST) --bless -m fuzz tests/golden

bench: $(STAMP) ## Measure: ratios to bare imports, growth, memory
	$(BIN)/python -m tests.experiments.bench

mutants: $(STAMP) ## Put 1,000 seeded faults into verification, geometry and solvers; count those that a test finds
	$(BIN)/python -m tests.experiments.mutants $(MUTANTS)

papers: $(STAMP) ## Run the papers' experiments; report in out/papers, tables in shotc/docs/papers.md
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.experiments.papers --write-page

build: $(STAMP) ## Build the wheel of shotc and of each plugin
ifdef UV
	@for package in . $(dir $(PLUGINS)); do uv build --quiet --wheel --out-dir dist $$package || exit 1; done
else
	$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-deps -w dist . $(addprefix ./,$(dir $(PLUGINS)))
endif

clean: ## Remove everything that can be made again
	rm -rf $(VENV) dist build out .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
