# Every target does its own set-up on a fresh Debian 12.

JOBS ?= $(shell nproc)
export CCACHE_BASEDIR := $(CURDIR)
export CCACHE_NOHASHDIR := 1

.PHONY: demo test deps build bench format tidy clean

demo: build
	build/release/bin/varifold demo -o demo

test: build
	ctest --test-dir build/release --output-on-failure -j$(JOBS)

deps:
	@sh cmake/install_packages.sh packages.txt

build: deps
	@sh cmake/build_preset.sh release

bench: deps
	@sh cmake/build_preset.sh bench
	build/bench/bin/varifold_benchmarks

format:
	git ls-files '*.h' '*.cpp' | xargs clang-format -i

tidy: deps
	@sh cmake/tidy.sh

clean:
	rm -rf build
