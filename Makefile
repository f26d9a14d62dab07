# `make demo` does the main job, `make paper` the paper's, `make test` is the whole truth. What is missing is brought into target/.
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

.PHONY: help demo paper test test-ecosystem lint bench soak soak-damage fuzz fuzz-check conformance clean build

help: ## Say what there is to make.
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | awk -F ':.*## ' '{ printf "  make %-16s %s\n", $$1, $$2 }'

$(TOOLS)/bin/cmake:
	$(PYTHON) -m venv $(TOOLS)
	$(TOOLS)/bin/pip install --quiet --disable-pip-version-check 'cmake>=3.26'

$(VENV)/ready: tests/python/requirements.txt
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -r tests/python/requirements.txt
	touch $@

build: $(CMAKE_READY) ## Build the command, optimised.
	$(CARGO) build --release --locked --bin bbrf

demo: build ## Import the simulated scan, fit it, validate the file, draw it.
	bash scripts/demo.sh $(RELEASE)

paper: $(CMAKE_READY) ## The paper's figures from simulated scans of its objects: target/paper, docs/paper.md.
	$(CARGO) build --locked --bin bbrf --example paper
	rm -rf $(TARGET)/paper
	$(TARGET)/debug/examples/paper simulate $(TARGET)/paper
	bash scripts/paper.sh $(TARGET)/debug/bbrf $(TARGET)/paper
	$(TARGET)/debug/examples/paper page $(TARGET)/paper docs

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
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -r benches/requirements.txt
	touch $@

bench: $(CMAKE_READY) $(VENV)/bench-ready ## Every figure in the README, measured here and now; docs/cost.md anew.
	BBRF_PYTHON=$(VENV)/bin/python $(CARGO) bench --locked --bench fit --bench archive --bench validate --bench donaldson --bench simulate
	BBRF_UPDATE=1 $(CARGO) bench --locked --bench cost

$(VENV)/soak-ready: $(VENV)/ready tests/python/soak.txt
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -r tests/python/soak.txt
	touch $@

soak: soak-damage fuzz-check $(VENV)/soak-ready ## Long runs: ten thousand cases of every property, two thousand scans, a million points against 60 digits, scenes against Mitsuba 3, and the two below.
	BBRF_PROPTEST_CASES=10000 BBRF_SCENES=10000 BBRF_TRIALS=2000 BBRF_POINTS=1000000 BBRF_PYTHON=$(VENV)/bin/python $(CARGO) test --locked --release

# Unoptimised, where arithmetic that overflows is a panic; in 4 GiB of memory, where what asks for more is refused.
soak-damage: $(CMAKE_READY) $(VENV)/ready ## 100,000 damaged copies, 500 killed writers, full disks: the figures of docs/damage.md.
	$(CARGO) test --locked --no-run --test damage --test kill --test full_disk
	ulimit -v 4194304; BBRF_DAMAGED=100000 BBRF_KILLS=500 BBRF_PYTHON=$(VENV)/bin/python \
		$(CARGO) test --locked --test damage --test kill --test full_disk -- --nocapture

# As cargo-fuzz builds without a sanitizer, which needs no other toolchain: safe Rust has little to sanitize.
FUZZ := RUSTFLAGS='--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
	-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
	-Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1' \
	$(CARGO) run --locked --release --manifest-path fuzz/Cargo.toml --target-dir $(TARGET)/fuzz \
	--target $(shell rustc -vV | sed -n 's/^host: //p') --bin validate --

fuzz: $(TARGET)/kit/kit.csv ## Look for bytes that break the reader or the validator, until stopped (docs/damage.md).
	mkdir -p $(TARGET)/corpus
	$(FUZZ) $(TARGET)/corpus $(TARGET)/kit $(TARGET)/kit/encodings -rss_limit_mb=1024 -timeout=20 -max_len=200000

fuzz-check: $(TARGET)/kit/kit.csv ## Build the fuzz target and run it once on every file of the kit.
	$(CARGO) build --locked --manifest-path fuzz/Cargo.toml --target-dir $(TARGET)
	$(TARGET)/debug/validate $(TARGET)/kit/*.bbrf $(TARGET)/kit/encodings/*.bbrf 2>&1 | tail -n 3

$(TARGET)/kit/kit.csv: $(CMAKE_READY) $(VENV)/ready $(wildcard conformance/*)
	$(CARGO) run --locked --quiet --example conformance_kit -- write $(TARGET)/kit $(VENV)/bin/python

conformance: $(TARGET)/kit/kit.csv ## Score the validator and the Python reader with the kit: docs/conformance.md.
	$(CARGO) build --locked --bin bbrf --example conformance_kit
	$(TARGET)/debug/examples/conformance_kit score $(TARGET)/kit --page docs/conformance.md \
		-- $(TARGET)/debug/bbrf validate --json {}
	$(TARGET)/debug/examples/conformance_kit score-reader $(TARGET)/kit --page docs/conformance.md \
		-- $(VENV)/bin/python examples/read_bbrf.py {}

clean: ## Remove what was built.
	$(CARGO) clean
	rm -rf demo
