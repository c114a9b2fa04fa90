"""A pytest plugin that records which tests run which lines: ``-p tests.experiments.mutants.recording``.

What several tests share (a cached call of a helper, a fixture of a module or of the session) is run once, by
whichever test comes first. Its lines count for all tests that ask for it.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import coverage
import pytest

FOLDER, PATHS, KNOWN = "MUTANTS_RECORD", "MUTANTS_PATHS", "MUTANTS_KNOWN"
"""Environment: the folder to write into; the folders whose lines count, one a line; a file with the ids of
tests that are recorded already, one a line."""

IMPORT = ""
"""The context of what runs when a module is imported."""


class Recorder:
    """Lines by context, and who asked for what is shared.

    A context is the id of a test, or the name of a shared value while it is made.
    """

    def __init__(self, folder: Path, paths: list[str]) -> None:
        self.folder = folder
        self.coverage = coverage.Coverage(data_file=None, config_file=False, source=paths)
        self.stack = [IMPORT]
        self.asked: dict[str, set[str]] = defaultdict(set)
        self.seconds: dict[str, float] = defaultdict(float)
        self.tests: set[str] = set()
        self.since = time.process_time()
        self.failed: set[str] = set()
        self.files: dict[str, str] = {}

    def enter(self, context: str) -> None:
        self.charge()
        self.stack.append(context)
        self.coverage.switch_context(context)

    def leave(self) -> None:
        self.charge()
        self.stack.pop()
        self.coverage.switch_context(self.stack[-1])

    def charge(self) -> None:
        """Count the CPU since the last change of the context to the present one."""
        now = time.process_time()
        self.seconds[self.stack[-1]] += now - self.since
        self.since = now

    def shares(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Cache a function as functools does, and note who asks for which of its values."""

        def made(*args: Any, **kwargs: Any) -> Any:
            self.enter(name(args, kwargs))
            try:
                return function(*args, **kwargs)
            finally:
                self.leave()

        def name(args: Any, kwargs: Any) -> str:
            key = hash((args, tuple(sorted(kwargs.items()))))
            return f"shared {function.__module__}.{function.__qualname__} {key}"

        kept = functools.lru_cache(maxsize=None)(made)

        @functools.wraps(function)
        def asking(*args: Any, **kwargs: Any) -> Any:
            self.asked[name(args, kwargs)].add(self.stack[-1])
            return kept(*args, **kwargs)

        asking.cache_clear = kept.cache_clear  # type: ignore[attr-defined]
        return asking

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Leave the tests that are not recorded yet, and note the text of their files."""
        known = set(Path(os.environ[KNOWN]).read_text(encoding="utf-8").split("\n"))
        items[:] = [item for item in items if _plain(item) not in known]
        for path in {item.path for item in items}:
            self.files[path.relative_to(Path.cwd()).as_posix()] = text_digest(path)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        name = _plain(item)
        self.tests.add(name)
        self.enter(name)
        result = yield
        self.leave()
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item) -> Iterator[None]:
        report: Any = yield
        if report.failed:
            self.failed.add(_plain(item))
        return report

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any, request: pytest.FixtureRequest) -> Iterator[None]:
        if fixturedef.scope == "function":
            return (yield)
        self.enter(_fixture(fixturedef, request))
        try:
            return (yield)
        finally:
            self.leave()

    def pytest_runtest_setup(self, item: Any) -> None:
        for definitions in item._fixtureinfo.name2fixturedefs.values():
            for definition in definitions:
                self.asked[f"fixture {definition.baseid} {definition.argname}"].add(_plain(item))

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self) -> None:
        """Write the record while the run still waits for this process: one that is slow is ended later."""
        self.coverage.stop()
        data = self.coverage.get_data()
        lines = {
            str(Path(path).relative_to(Path.cwd())): {
                str(line): contexts for line, contexts in data.contexts_by_lineno(path).items()
            }
            for path in data.measured_files()
        }
        record = {
            "lines": lines,
            "asked": {name: sorted(by) for name, by in self.asked.items()},
            "seconds": {name: self.seconds[name] for name in self.tests},
            "shared": {name: s for name, s in self.seconds.items() if name not in self.tests},
            "failed": sorted(self.failed),
            "files": self.files,
        }
        (self.folder / f"{os.getpid()}.json").write_text(json.dumps(record), encoding="utf-8")


def text_digest(path: Path) -> str:
    """Return what tells one text of a file from another."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _fixture(definition: Any, request: pytest.FixtureRequest) -> str:
    return f"fixture {definition.baseid} {request.fixturename}"


def _plain(item: pytest.Item) -> str:
    """Return the id of a test without the group that xdist adds to it."""
    group = item.get_closest_marker("xdist_group")
    return item.nodeid.removesuffix(f"@{group.args[0]}") if group else item.nodeid


RECORDER = pytest.StashKey[Recorder]()


@pytest.hookimpl(tryfirst=True)
def pytest_load_initial_conftests(early_config: pytest.Config) -> None:
    """Start before anything of ours is imported."""
    recorder = Recorder(Path(os.environ[FOLDER]), os.environ[PATHS].split("\n"))
    early_config.stash[RECORDER] = recorder
    cache = functools.cache

    def cached(function: Callable[..., Any]) -> Callable[..., Any]:
        ours = function.__module__.startswith("tests.") or ".test_" in f".{function.__module__}"
        return recorder.shares(function) if ours else cache(function)

    functools.cache = cached  # type: ignore[assignment]
    recorder.coverage.start()
    recorder.coverage.switch_context(IMPORT)


def pytest_configure(config: pytest.Config) -> None:
    """Record; the process that only hands tests out records nothing."""
    recorder = config.stash[RECORDER]
    if config.getoption("numprocesses", None) and not hasattr(config, "workerinput"):
        recorder.coverage.stop()
    else:
        config.pluginmanager.register(recorder)
