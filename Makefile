# Every target does its own set-up on a fresh Debian 12.

JOBS ?= $(shell nproc)

.PHONY: help demo test deps build bench figures format tidy ci clean

help:
	@echo "make demo    build and run the tour: pictures of five levels in demo/index.html"
	@echo "make test    build and run the tests"
	@echo "make build   build the tool: build/release/bin/varifold"
	@echo "make bench   build and run the benchmarks (BENCH=regular_expression picks some)"
	@echo "make figures draw what is in docs/pictures/strips, deforming and patch_tree (needs the real meshes)"
	@echo "make deps    install the Debian packages of packages.txt that are missing"
	@echo "make format  format all sources with clang-format"
	@echo "make tidy    check all sources with clang-tidy"
	@echo "make ci      everything that must hold before a change is merged (.ci/run)"
	@echo "make clean   remove what was built"

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
	build/bench/bin/varifold_benchmarks --benchmark_filter='$(or $(BENCH),.)'

figures: build
	python3 benchmarks/figures/strip_figures.py build/release/bin/varifold \
	  "$(or $(VARIFOLD_MESHES),../shared/meshes)" docs/pictures/strips
	python3 benchmarks/figures/morph_figures.py build/release/bin/varifold \
	  "$(or $(VARIFOLD_MESHES),../shared/meshes)" docs/pictures/deforming
	python3 benchmarks/figures/patch_figures.py build/release/bin/varifold \
	  "$(or $(VARIFOLD_MESHES),../shared/meshes)" docs/pictures/patch_tree
	@sh cmake/build_preset.sh bench varifold_patch_pixel_error
	python3 benchmarks/figures/pixel_error_figures.py build/bench/bin/varifold_patch_pixel_error \
	  docs/pictures/patch_tree

format:
	git ls-files '*.h' '*.cpp' | xargs clang-format -i

tidy: deps
	@sh cmake/tidy.sh

ci:
	.ci/run

clean:
	rm -rf build demo
