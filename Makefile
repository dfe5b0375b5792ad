# Set-up is `make demo`; `make test` runs every test.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

# Everything that the installed package is made of.
SOURCES := Cargo.toml Cargo.lock pyproject.toml README.md \
	$(shell find crates python/trove -name '*.rs' -o -name Cargo.toml -o -name '*.py')

.PHONY: demo install test test-rust test-python lint bench-build bench-frame bench-memory clean

demo: install
	$(BIN)/trove demo --out demo-out

install: $(VENV)/.installed

$(VENV)/.installed: $(SOURCES)
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check '.[test]'
	touch $@

test: test-rust test-python

# The Rust tests use Embree and Open Image Denoise where .venv has them, as users do.
test-rust: install
	packages="$$($(CURDIR)/$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')"; \
	TROVE_EMBREE="$$packages" TROVE_OIDN="$$packages" \
	cargo test --workspace --exclude trove-py --no-fail-fast

test-python: install
	$(BIN)/python -m pytest -q

lint:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	if command -v cargo-deny >/dev/null; then cargo deny check; fi

# Benchmarks on the real data in TROVE_TEST_DATA; see benches/README.md.
bench-build bench-frame bench-memory: bench-%: install
	$(BIN)/python benches/bench.py $*

clean:
	rm -rf target $(VENV) demo-out
