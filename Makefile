# Two commands: `make demo` does the main job, `make test` is the whole truth. What is missing is brought into target/.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help

TARGET := $(CURDIR)/target
CARGO ?= cargo
PYTHON ?= python3
TOOLS := $(TARGET)/tools
VENV := $(TARGET)/venv

# hdf5-metno's static build needs cmake 3.26 or newer. A good one on the path is used; otherwise one is brought into
# target/. This file is the only one that sets CMAKE.
CMAKE_GOOD := $(shell cmake --version 2>/dev/null | awk 'NR==1 { split($$3, v, "."); print (v[1] > 3 || (v[1] == 3 && v[2] >= 26)) ? "yes" : "no" }')
ifeq ($(CMAKE_GOOD),yes)
CMAKE_READY :=
else
CMAKE_READY := $(TOOLS)/bin/cmake
export CMAKE := $(TOOLS)/bin/cmake
endif

RELEASE := $(TARGET)/release/bbrf

.PHONY: help demo test test-ecosystem lint bench soak clean build

help: ## Say what there is to make.
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | awk -F ':.*## ' '{ printf "  make %-16s %s\n", $$1, $$2 }'

$(TOOLS)/bin/cmake:
	$(PYTHON) -m venv $(TOOLS)
	$(TOOLS)/bin/pip install --quiet --disable-pip-version-check 'cmake>=3.26'

$(VENV)/ready: tests/python/requirements.txt
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/pip install --quiet --disable-pip-version-check -r tests/python/requirements.txt
	touch $@

build: $(CMAKE_READY) ## Build the command, optimised.
	$(CARGO) build --release --locked --bin bbrf

demo: build ## Import the simulated scan, fit it, validate the file, draw it.
	bash scripts/demo.sh $(RELEASE)

test: $(CMAKE_READY) $(VENV)/ready ## All tests: unit, property, golden, command line, C, other readers, doc examples.
	$(CARGO) build --locked --package bbrf-capi
	BBRF_CAPI=$(TARGET)/debug BBRF_PYTHON=$(VENV)/bin/python $(CARGO) test --locked

$(VENV)/ecosystem-ready: $(VENV)/ready tests/python/ecosystem.txt
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -r tests/python/ecosystem.txt
	touch $@

# Debian's hdf5-tools, libhdf5-dev and minisign are needed; .ci/run brings them.
test-ecosystem: $(CMAKE_READY) $(VENV)/ecosystem-ready ## Heavier partners: h5dump, h5repack, C with libhdf5, minisign, pre-commit, the GitHub action.
	BBRF_PYTHON=$(VENV)/bin/python $(CARGO) test --locked --test ecosystem --test pipelines --test examples --test signature -- --ignored

lint: $(CMAKE_READY) ## rustfmt, clippy and docs with warnings denied; the reading half without a C compiler.
	$(CARGO) fmt --all --check
	$(CARGO) clippy --locked --all-targets -- -D warnings
	$(CARGO) clippy --locked --package bbrf-capi -- -D warnings
	RUSTDOCFLAGS='-D warnings' $(CARGO) doc --locked --no-deps
	RUSTFLAGS='-D warnings' $(CARGO) check --locked --no-default-features --lib --target-dir target/no-write
	RUSTFLAGS='-D warnings' $(CARGO) check --locked --no-default-features --package bbrf-capi --target-dir target/no-write

$(VENV)/bench-ready: $(VENV)/ready benches/requirements.txt
	$(VENV)/bin/pip install --quiet --disable-pip-version-check -r benches/requirements.txt
	touch $@

bench: $(CMAKE_READY) $(VENV)/bench-ready ## Every figure in the README, measured here and now.
	BBRF_PYTHON=$(VENV)/bin/python $(CARGO) bench --locked --bench fit --bench archive --bench validate

soak: $(CMAKE_READY) $(VENV)/ready ## Long runs: ten thousand cases of every property, two thousand scans.
	BBRF_PROPTEST_CASES=10000 BBRF_TRIALS=2000 BBRF_PYTHON=$(VENV)/bin/python $(CARGO) test --locked --release

clean: ## Remove what was built.
	$(CARGO) clean
	rm -rf demo
