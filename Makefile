# SPDX-License-Identifier: Apache-2.0
# A thin front of CMake. `make` lists the targets; each installs the Debian packages that it misses.
BUILD ?= build
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
DATA ?=
FIGURES ?= tests/accept/figures.json
NEED := platform/host/scripts/need.sh
TOUCHLINE := $(BUILD)/platform/host/touchline

.DEFAULT_GOAL := help
.PHONY: help build program demo run test check golden accept bench profile budget fuzz vmtest format install clean

help:  ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "  make %-9s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

# CMake keeps the generator and the compiler of its first run; Ninja and ccache are used where they are there.
$(BUILD)/CMakeCache.txt:
	@bash $(NEED) build test backends
	@cmake -S . -B $(BUILD) $$(command -v ninja >/dev/null && echo -G Ninja) \
	  $$(command -v ccache >/dev/null && echo -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache) \
	  >$(BUILD).log 2>&1 || { cat $(BUILD).log; rm -f $(BUILD).log $(BUILD)/CMakeCache.txt; exit 1; }
	@rm -f $(BUILD).log

build: $(BUILD)/CMakeCache.txt  ## the library, the command line and the tests
	@bash $(NEED) build test backends
	@cmake --build $(BUILD) --parallel $(JOBS)

# The program alone, its build told on standard error.
program:
	@$(MAKE) --no-print-directory $(BUILD)/CMakeCache.txt >&2
	@cmake --build $(BUILD) --parallel $(JOBS) --target touchline >&2

demo: program  ## a simulated robot finds and follows its place; pictures go to demo/
	@$(TOUCHLINE) demo --output demo

run: program  ## the robot daemon on recorded devices: one JSON line per pose
	@$(TOUCHLINE) run fixtures/robot-replay.toml

test: build  ## all tests
	@ctest --test-dir $(BUILD) --parallel $(JOBS) --output-on-failure

check:  ## all gates: both compilers, sanitizers, format, lint, golden outputs (takes a while)
	@bash $(NEED) build test check backends
	@bash tests/gates/all.sh

golden: build  ## writes the golden outputs anew, for changes of behaviour that are meant
	@$(BUILD)/tests/golden/golden_outputs --write tests/golden/expected fixtures
	@git --no-pager diff --stat -- tests/golden 2>/dev/null || true

accept: program  ## make accept [DATA=folder]: the acceptance figures beside their targets; without DATA the simulator's alone
	@$(TOUCHLINE) accept $(if $(DATA),"$(DATA)" --figures $(FIGURES) $(if $(REWRITE),--rewrite)) --output $(BUILD)/accept.json

bench:  ## make bench [DATA=folder] [BENCH_ARGUMENTS=--help]: times per stage beside OpenCV's; a table, and build/bench.json
	@bash $(NEED) build test backends bench
	@$(MAKE) --no-print-directory $(BUILD)/CMakeCache.txt
	@cmake -S . -B $(BUILD) >/dev/null
	@cmake --build $(BUILD) --parallel $(JOBS) --target touchline_bench
	@$(BUILD)/tests/bench/touchline_bench --json $(BUILD)/bench.json --first-pose $(BUILD)/tests/bench/first_pose \
	  $(if $(DATA),--data "$(DATA)") $(BENCH_ARGUMENTS)

profile:  ## make profile [DATA=data set]: instructions per stage and frame, by callgrind: a figure that repeats on noisy machines
	@bash $(NEED) build test backends profile
	@$(MAKE) --no-print-directory $(BUILD)/CMakeCache.txt
	@cmake --build $(BUILD) --parallel $(JOBS) --target profile_chain
	@bash tests/bench/profile.sh $(BUILD)/tests/bench/profile_chain $(BUILD) $(if $(DATA),"$(DATA)")

budget: build  ## writes the budget of instructions and bytes anew, for changes of cost that are meant
	@bash tests/gates/all.sh new_budget
	@git --no-pager diff --stat -- tests/gates/budget.txt 2>/dev/null || true

fuzz:  ## each decoder and reader against random input, 10 minutes each (SECONDS=600); finds stay in build/fuzz
	@bash $(NEED) build backends check
	@bash tests/fuzz/fuzz.sh --keep $(or $(SECONDS),600)

vmtest: build  ## make vmtest [ARCH=arm64]: every backend and the whole robot on Debian's kernel in QEMU, with virtual devices
	@bash $(NEED) vm $(if $(filter arm64,$(ARCH)),cross bare) || true
	@bash tests/vm/vm.sh $(BUILD) $(or $(ARCH),amd64)

format:  ## clang-format over all sources
	@bash $(NEED) check
	@bash tests/gates/format.sh --write

install: build  ## make install PREFIX=/usr/local
	@cmake --install $(BUILD) $(if $(PREFIX),--prefix "$(PREFIX)")

clean:  ## removes the build and what the demo wrote
	@rm -rf $(BUILD) demo
