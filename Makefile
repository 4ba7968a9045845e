# Everything happens in .venv, which the first target that needs it makes. Without make: see the README.
PYTHON ?= python3
MINUTES ?= 40
BIN = .venv/bin
C = $(wildcard model/boreprop/kernel/*.[ch] fmu_build/boreprop_fmu/native/*.[ch] fmu_build/boreprop_fmu/native/*/*.h)

.PRECIOUS: .venv/%.installed
.PHONY: demo binaries wheels test soak lint docs bench clean

demo: .venv/all.compiled  # the main job: case file, FMU, run, viewer recording, figures, summary; results in out/
	mkdir -p out
	$(BIN)/boreprop-fmu build examples/build_section.toml --output out/Borehole.fmu
	$(BIN)/boreprop-fmu run out/Borehole.fmu --schedule examples/build_section_rss.csv --output out/run.csv
	$(BIN)/boreprop-fmu build examples/build_section.toml --runtime python --output out/python.fmu
	$(BIN)/boreprop-fmu run out/python.fmu --schedule examples/build_section_rss.csv --output out/python.csv
	$(BIN)/boreprop-view out/run.csv --plan examples/build_section_plan.csv --save out/run.rrd
	$(BIN)/boreprop figures out
	$(BIN)/boreprop summary out/run.csv
	@printf '\nResults are in %s/out:\n' "$$PWD"
	@printf '  %-15s %s\n' \
		Borehole.fmu    'the FMU, for any FMI 2.0 co-simulation tool' \
		run.csv         'the run, and its case in run.case.toml' \
		python.fmu      'the same FMU as Python code, and its run in python.csv' \
		run.rrd         'the recording: $(BIN)/rerun out/run.rrd' \
		'figure_*.png'  'figures 6 to 8 of the paper'

binaries: .venv/dev.installed  # what native FMUs are packed with, for all platforms
	$(BIN)/python -m boreprop_fmu.native all

wheels: .venv/dev.installed  # wheels for all platforms and the source distribution, in dist/; then all that is asked of them
	rm -rf dist
	$(BIN)/python build_wheels.py
	$(BIN)/python -m pytest tests/wheels --wheels dist -n auto --dist loadfile -rap

test: .venv/dev.compiled  # the whole suite
	$(BIN)/python -m pytest -n auto --dist worksteal

soak: .venv/dev.compiled  # new examples of the property tests, then the fuzzers: make soak MINUTES=40 [SEED=…]
	$(BIN)/python tests/soak.py --minutes $(MINUTES) $(if $(SEED),--seed $(SEED))

lint: .venv/dev.installed  # style, types and the import contract; style and faults of the C; the workflows
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python tests/lint_c.py
	$(BIN)/python tests/lint_yaml.py

docs: .venv/docs.compiled  # the documentation, with its tutorials executed: out/docs/index.html
	rm -rf out/docs
	$(BIN)/sphinx-build --fail-on-warning --keep-going docs out/docs

bench: .venv/bench.compiled  # speed, side by side with something else
	$(BIN)/python benchmarks/integrator.py
	$(BIN)/python benchmarks/whole_process.py
	$(BIN)/python benchmarks/fmu_cost.py
	$(BIN)/python benchmarks/viewer_cost.py
	$(BIN)/python benchmarks/viewer_seek.py
	$(BIN)/python benchmarks/stability_chart.py
	$(BIN)/python benchmarks/study.py
	$(BIN)/python benchmarks/native.py
	$(BIN)/python benchmarks/ground.py
	$(BIN)/python benchmarks/body.py
	$(BIN)/python benchmarks/space.py

clean:
	rm -rf .venv out dist build .*_cache .hypothesis model/boreprop/kernel/boreprop_kernel.* fmu_build/boreprop_fmu/binaries

.venv/%.installed: pyproject.toml
	@$(PYTHON) -c 'import sys; v = sys.version.split()[0]; sys.exit(v and sys.version_info < (3, 11) and \
		"Python 3.11 or later is needed, got " + v + "; name one: make PYTHON=python3.11 $(MAKECMDGOALS)")'
	@echo 'Installing into .venv: a minute or two the first time'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check uv || echo 'no uv: pip takes a minute longer'
	export HATCH_BUILD_NO_HOOKS=true UV_SYSTEM_CERTS=true; \
	$(BIN)/uv pip install --quiet --python $(BIN)/python --editable ".[$*]" || \
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[$*]"
	@touch $@

# What is compiled, again whenever its C has changed; without a compiler the model in Python drills.
.venv/%.compiled: .venv/%.installed $(C)
	-$(BIN)/python -m boreprop.kernel
	-$(BIN)/python -m boreprop_fmu.native
	@touch $@
