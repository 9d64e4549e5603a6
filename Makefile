# Every target builds the .venv that it needs, and renews it when pyproject.toml has changed.

PYTHON ?= python3
ARGS ?=

VENV := .venv
BIN := $(VENV)/bin
BASE := $(VENV)/.base
DEV := $(VENV)/.dev

.PHONY: help setup recover growth conformance nightly test check grammar bench clean

help:
	@echo 'make setup        build .venv with everything for working on the project'
	@echo 'make recover      survey the corpus and write the page (ARGS="PATH --json FILE")'
	@echo 'make growth       replay the ledger over the corpus and write the page'
	@echo 'make test         run the tests (ARGS="tests/krl -k door")'
	@echo 'make check        style, types, layers, and whether generated code is up to date'
	@echo 'make grammar      generate the parser from grammar/KRL.g4 (needs Java)'
	@echo 'make bench        measure the tools; records go to reports/out/bench (ARGS="PATH")'
	@echo 'make clean        remove .venv, caches and reports/out'
	@echo 'make conformance, make nightly: not built yet'

setup: $(DEV)

recover: $(BASE)
	@$(BIN)/krl recover $(ARGS)

growth: $(BASE)
	@$(BIN)/krl growth $(ARGS)

test: $(DEV)
	@$(BIN)/python -m pytest -n auto $(ARGS)

check: $(DEV)
	@$(BIN)/ruff check --quiet --output-format concise
	@$(BIN)/ruff format --check
	@$(BIN)/mypy
	@$(BIN)/lint-imports --no-logo
	@$(BIN)/python -m grammar.generate --check
	@$(BIN)/krl construct replay --check

grammar: $(DEV)
	@command -v java >/dev/null || { echo 'make grammar: ANTLR needs Java, and there is no java on the PATH' >&2; exit 2; }
	@$(BIN)/python -m grammar.generate

conformance nightly:
	@echo 'make $@: not built yet, it comes with the interpreters' >&2; exit 2

bench: $(BASE)
	@$(BIN)/krl bench recover --json reports/out/bench/recover.json $(ARGS)
	@$(BIN)/krl bench mutation --json reports/out/bench/mutation.json $(ARGS)
	@$(BIN)/krl bench check --json reports/out/bench/check.json $(ARGS)

clean:
	@rm -rf $(VENV) build dist reports/out .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis .krl-cache
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(BASE): pyproject.toml
	@echo 'building $(VENV) ...'
	@command -v $(PYTHON) >/dev/null || { echo 'make: $(PYTHON) not found; install Python 3.11 or later, or say make PYTHON=...' >&2; exit 2; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo 'make: $(PYTHON) is older than Python 3.11; say make PYTHON=...' >&2; exit 2; }
	@test -x $(BIN)/pip || $(PYTHON) -m venv $(VENV) || { echo 'make: $(PYTHON) cannot build a virtual environment; on Debian, install python3-venv' >&2; exit 2; }
	@$(BIN)/pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(DEV): $(BASE)
	@$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@
