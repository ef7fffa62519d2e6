# Everything a fresh machine with cargo needs.
#   make demo    build isolux, light a room, leave picture, model and report in out/
#   make test    every test
#   make viewer  the page for browsers, which isolux then writes; needs npm. Without it all else is built
#   make test-viewer   tests of the page, in Chromium if it is there
#   make test-python   those of the Python package: needs Python 3.10 or later, and is skipped without
#   make bench   speed of the ray kernel and of global lines, into docs/performance.md
#                EMBREE=1 puts Embree beside it, which needs Debian's libembree-dev (apt-get install libembree-dev)
#   make bench-viewer   how fast a page of a million elements is drawn without a graphics card, and how much of that is its script
#   make studies                  the nine published experiments and the study of speed in full: two hours
#   make study-reference-rooms    real rooms against an independent renderer
#   make growth                   time to a fixed accuracy from 10^4 to 10^6 elements, in two rooms
#   make study-methods            all methods on one scene, error and time
#   make study-clusters           what elements of many triangles are worth, in two rooms
#   make study-smoothing          what taking noise out gains, and its bias, in four rooms
#   make study-mesh               what a mesh that follows the light gains, in three rooms, and after whole solves in two

ISOLUX = target/release/isolux

STUDIES = order lines walk sequences form-factor-variance warm-up variance cost ray-count speed

.PHONY: demo test test-python run-test-python bench bench-viewer lint build viewer test-viewer studies growth study-reference-rooms study-methods study-smoothing study-mesh study-clusters

build: viewer
	cargo build --release --locked

# The page is built anew only if something of it has changed.
PAGE = viewer/dist/viewer.html

viewer:
	@if command -v npm > /dev/null; then $(MAKE) --no-print-directory $(PAGE); \
	else echo "npm is not installed: isolux is built without the viewer, and cannot write .html"; fi

$(PAGE): $(wildcard viewer/src/* viewer/src/shaders/*) viewer/build.mjs viewer/node_modules/.package-lock.json
	cd viewer && npm run --silent build

viewer/node_modules/.package-lock.json: viewer/package.json viewer/package-lock.json
	cd viewer && PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1 npm ci --no-audit --no-fund
	@touch $@

test-viewer: build
	@bash viewer/test.sh

demo: build
	@mkdir -p out
	$(ISOLUX) solve office --elements 200k --time 45 --objects 8 -o out/office.png -o out/office.glb -o out/office.json -o out/office.isolux
	@if [ -e $(PAGE) ]; then $(ISOLUX) view out/office.isolux -o out/office.html --quiet; fi
	@echo
	@echo "out/office.png     the picture"
	@echo "out/office.glb     the lit model, for any viewer of glTF"
	@echo "out/office.json    the report: totals, balance, light on each object"
	@if [ -e $(PAGE) ]; then echo "out/office.html    the room to walk about in and read lux off, in any browser"; \
	else echo "(no page for browsers: npm is not installed)"; fi
	@echo "out/office.isolux  the solution; look again with: $(ISOLUX) render out/office.isolux -o out/again.png"

test: viewer
	cargo test --release --locked --workspace --no-fail-fast
	$(MAKE) --no-print-directory test-viewer
	$(MAKE) test-python

# The wheel is built and installed into an environment of its own, with the versions of python/constraints.txt.
PYTHON = python3
PYTHON_ENV = target/python
PYTHON_NEEDS = maturin mypy numpy matplotlib pandas pandas-stubs pytest pyvista ruff scipy tqdm trimesh xatlas

test-python:
	@if $(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then $(MAKE) run-test-python; \
	else echo "SKIPPED: the tests of the Python package need Python 3.10 or later; name one with PYTHON=..."; fi

run-test-python:
	test -x $(PYTHON_ENV)/bin/python || $(PYTHON) -m venv $(PYTHON_ENV)
	$(PYTHON_ENV)/bin/python -m pip install --quiet --disable-pip-version-check -c python/constraints.txt $(PYTHON_NEEDS)
	rm -rf $(PYTHON_ENV)/wheel
	$(PYTHON_ENV)/bin/maturin build --release --locked --quiet --interpreter $(PYTHON_ENV)/bin/python --out $(PYTHON_ENV)/wheel
	$(PYTHON_ENV)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall $(PYTHON_ENV)/wheel/*.whl
	$(PYTHON_ENV)/bin/ruff check --quiet python examples
	$(PYTHON_ENV)/bin/ruff format --quiet --check python examples
	$(PYTHON_ENV)/bin/python -m pytest --quiet python/tests

bench:
	BENCH_REPORT=$(CURDIR)/docs/performance.md BENCH_DATE=$$(date +%F) CRITERION_HOME=$(CURDIR)/target/criterion \
	cargo bench --locked --workspace $(if $(EMBREE),--features isolux-testing/embree) --bench speed --bench lines

bench-viewer: build
	@mkdir -p out
	$(ISOLUX) solve office --elements 1e6 --rays 20M --quiet -o out/million.html
	cd viewer && node bench.mjs ../out/million.html

lint:
	cargo fmt --all --check
	cargo clippy --release --locked --workspace --all-targets -- -D warnings

studies: build
	for study in $(STUDIES); do $(ISOLUX) study $$study -o studies/$$study --progress || exit; done

study-reference-rooms:
	cargo run --release --locked -p isolux-testing --bin reference-rooms

growth:
	cargo run --release --locked -p isolux-testing --bin growth

study-methods:
	cargo run --release --locked -p isolux-testing --bin methods

study-smoothing:
	cargo run --release --locked -p isolux-testing --bin smoothing

study-mesh:
	cargo run --release --locked -p isolux-testing --bin mesh
	cargo run --release --locked -p isolux-testing --bin mesh-solves

study-clusters:
	cargo run --release --locked -p isolux-testing --bin clusters
