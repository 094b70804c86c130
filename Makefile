# Two commands: `make demo` and `make test`. Everything else is detail.

PYTHON ?= python3
BIN := .venv/bin
TYPES := --noEmit --checkJs --allowJs --strict --target es2022 --module es2022 --lib es2022,dom,dom.iterable

.PHONY: demo test unit lint format schemas bench soak fuzz clean

demo: .venv/installed
	@$(BIN)/zteleop demo

# What claims an order shares the machine, three tests at a time, with the units; what claims a duration, or holds the
# keys of a real terminal, has it alone, afterwards. Thousands of processes start meanwhile, so Python keeps what it compiled, whatever the surroundings say.
test: export PYTHONDONTWRITEBYTECODE =
test: .venv/installed-dev
	@$(BIN)/python -m compileall -q zteleop
	@said=$$(mktemp); $(BIN)/pytest tests/unit >$$said 2>&1 & units=$$!; \
	$(BIN)/pytest --numprocesses 3 --dist loadfile --no-loadscope-reorder --durations 20 \
		tests/sweeps tests/peers tests/system tests/faults tests/fuzz; order=$$?; \
	wait $$units; units=$$?; cat $$said; rm $$said; \
	$(BIN)/pytest --durations 20 tests/timing tests/desktop && exit $$((order | units))

# Two halves side by side, each in one process: what workers say to each other costs more than these tests.
HALF := $(addprefix tests/unit/,interfaces recording sim terminal text)
unit: .venv/installed-dev
	@said=$$(mktemp); $(BIN)/pytest $(HALF) >$$said 2>&1 & half=$$!; \
	$(BIN)/pytest tests/unit $(HALF:%=--ignore=%); rest=$$?; \
	wait $$half; half=$$?; cat $$said; rm $$said; exit $$((half | rest))

lint: .venv/installed-dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/mypy examples/*.py
	@if command -v tsc >/dev/null; then tsc $(TYPES) zteleop/bridges/web/static/*.js; \
	else echo "not here: tsc (Debian: node-typescript); the types of the page are not checked"; fi

format: .venv/installed-dev
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

schemas: .venv/installed
	$(BIN)/zteleop schema

bench: .venv/installed-dev
	@for name in key_to_wheel publish_to_handler control_and_codec shell graph keyboard idle_cost flood; do \
		$(BIN)/python benchmarks/$$name.py || exit 1; done
	@$(BIN)/python benchmarks/history.py

# Above three hours: each fault 50 times, every failure in every state, bad links, half an hour each of floods and of
# all that strangers do, an hour of driving under load.
soak: .venv/installed-dev
	$(BIN)/zteleop chaos --times 50
	ZTELEOP_STEPS=2_000_000 $(BIN)/pytest --timeout 0 tests/sweeps/test_states.py
	$(BIN)/pytest --timeout 0 --hypothesis-profile long tests/unit tests/sweeps tests/peers
	cd tests && ../$(BIN)/python -m faults.matrix
	cd tests && ../$(BIN)/python -m faults.link.table
	cd tests && ../$(BIN)/python -m faults.endurance
	cd tests && ../$(BIN)/python -m faults.siege
	$(BIN)/python benchmarks/under_load.py --seconds 600

fuzz: .venv/installed-dev
	@$(BIN)/pip install --quiet --retries 10 --disable-pip-version-check --editable '.[fuzz]'
	@cd tests && for target in $$(../$(BIN)/python -m fuzz.coverage --list); do \
		../$(BIN)/python -m fuzz.coverage $$target --seconds $(or $(SECONDS_EACH),60) || exit 1; done

clean:
	rm -rf .venv

.venv/installed: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "zteleop needs Python 3.11 or newer; found $$($(PYTHON) -V). Say: make PYTHON=python3.12 demo"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
		{ echo "Python's venv module is missing; say: sudo apt install python3-venv"; exit 1; }
	@echo "installing into .venv, which may take half a minute ..."
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	@$(BIN)/pip install --quiet --retries 10 --disable-pip-version-check --editable .
	@touch $@

.venv/installed-dev: .venv/installed
	@echo "installing what the tests need ..."
	@$(BIN)/pip install --quiet --retries 10 --disable-pip-version-check --editable '.[dev]'
	@touch $@
