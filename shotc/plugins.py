"""The discovery of plugins of all groups by entry points.

An entry point names an object with ``name``, ``summary`` and ``api`` (the api version that it is written
for). Plugins are imported at first use. A clash of names, a failed import or another api version is a
diagnostic that names the package, never a silent choice.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.requirements import remedy

API_VERSION = 1
OPTIONAL = (
    *("numpy", "scipy", "clarabel", "toppra", "pymap3d", "matplotlib", "rerun", "casadi"),
    "pymavlink",
    "rotorpy",
    "distributed",
)
"""Libraries that the base install does not have; a plugin without its library is not broken."""
OURS = "shotc"
OUR_REFINER, NO_REFINER = "ours", "none"
GROUPS = {
    "kinds": "shotc.kinds",
    "refiners": "shotc.refiners",
    "emitters": "shotc.emitters",
    "replanners": "shotc.replanners",
    "saliency": "shotc.saliency",
}


class LoadedPlugins(NamedTuple):
    """The usable plugins of one group by name, and the faults of the others.

    faults : diagnostics of unusable plugins by name; they concern only what names these plugins
    lacking : names of plugins whose optional library is not installed, with that library
    """

    plugins: Mapping[str, Any]
    faults: Mapping[str, Diagnostic]
    lacking: Mapping[str, str]

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All faults."""
        return tuple(self.faults.values())

    @property
    def unusable(self) -> Mapping[str, Diagnostic]:
        """The diagnostics of unusable registered names, with those of missing libraries."""
        if not self.lacking:
            return self.faults
        missing = {n: not_installed("P004", f"plugin `{n}`", [lib]) for n, lib in self.lacking.items()}
        return {**self.faults, **missing}


class Source(NamedTuple):
    """One plugin and where it comes from.

    plugin : None if it is unusable; then the diagnostics say why
    package : its distribution; reference : module:attribute of its entry point
    """

    plugin: Any
    package: str
    reference: str
    diagnostics: tuple[Diagnostic, ...] = ()


class OnDemand(Mapping[str, Any]):
    """A mapping of known keys that makes each value at its first use."""

    def __init__(self, keys: Iterable[str], make: Callable[[str], Any]) -> None:
        self._keys = dict.fromkeys(keys)
        self._make = cache(make)

    def __getitem__(self, key: str) -> Any:
        if key not in self._keys:
            raise KeyError(key)
        return self._make(key)

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)

    def __contains__(self, key: object) -> bool:
        return key in self._keys


@cache
def discover(group: str) -> LoadedPlugins:
    """Load every plugin of ``group`` ("kinds", "refiners", "emitters", "replanners" or "saliency")."""
    return _prove(group, _by_name(group))


def one(group: str, name: str) -> Source:
    """Load one plugin of a group, independent of faults of others; raise KeyError if the name is unknown."""
    entries = _by_name(group)[name]
    source = _prove(group, {name: entries})
    owners = " and ".join(dict.fromkeys(map(_owner, entries)))
    missing = tuple(
        not_installed("P004", f"{group.removesuffix('s')} `{name}`", [library])
        for library in source.lacking.values()
    )
    return Source(source.plugins.get(name), owners, entries[0].value, source.diagnostics + missing)


def package_of(group: str, name: str) -> str:
    """Return the distribution that registers a plugin; ours if the name is not registered."""
    entries = _by_name(group).get(name)
    return _owner(entries[0]) if entries else OURS


def usual_refiner() -> str:
    """Return the name of the default refiner: ours if it is installed."""
    return OUR_REFINER if OUR_REFINER in names("refiners") else NO_REFINER


def no_refiner() -> Diagnostic:
    """Return the diagnostic for planning without a refiner because ours is not installed."""
    return Diagnostic(
        "P007",
        "planned without a refiner, the convex path is flown as it is",
        help="install shotc-casadi, which has the refiner `ours`; `--refiner none` is to mean it",
    )


@cache
def shot_kinds() -> LoadedPlugins:
    """Return the shot kinds: those of other packages loaded and checked, ours each loaded at first use.

    A mission uses few of our kinds, and making the models of all takes longer than checking the mission.
    """
    table = _by_name("kinds")
    ours = {name: entries[0] for name, entries in table.items() if len(entries) == 1 and _is_ours(entries[0])}
    others = _prove("kinds", {name: entries for name, entries in table.items() if name not in ours})
    known = sorted([*ours, *others.plugins])
    plugins = OnDemand(known, lambda name: ours[name].load() if name in ours else others.plugins[name])
    return LoadedPlugins(plugins, others.faults, others.lacking)


def names(group: str) -> list[str]:
    """Return the names registered in ``group`` without importing any of them."""
    return list(_by_name(group))


class Listed(NamedTuple):
    """A plugin in a list: its name, its summary, and its package."""

    name: str
    summary: str
    package: str


def listing(group: str) -> list[Listed]:
    """Return every plugin of ``group``, with those that lack a library."""
    known = discover(group)
    summaries = {name: plugin.summary for name, plugin in known.plugins.items()}
    summaries |= {name: f"needs {library}, which is not installed" for name, library in known.lacking.items()}
    return [
        Listed(name, summaries[name], _owner(entries[0]))
        for name, entries in _by_name(group).items()
        if name in summaries
    ]


def is_optional(missing: ModuleNotFoundError) -> bool:
    """Return whether the missing module belongs to an optional library."""
    return (missing.name or "").partition(".")[0] in OPTIONAL


def not_installed(code: str, what: str, libraries: Sequence[str]) -> Diagnostic:
    """Return the diagnostic for missing optional libraries; code : P004 refuses, P005 continues without."""
    return Diagnostic(
        code, f"{what} needs {', '.join(libraries)}, not installed here", help=remedy(libraries)
    )


def forget() -> None:
    """Clear the caches of installed packages, so that the next call searches again."""
    for remembered in (discover, shot_kinds, _search, _installed):
        remembered.cache_clear()


def _prove(group: str, table: Mapping[str, list[EntryPoint]]) -> LoadedPlugins:
    """Load and check every plugin of a table."""
    plugins: dict[str, Any] = {}
    faults: dict[str, Diagnostic] = {}
    lacking: dict[str, str] = {}
    for name, entries in table.items():
        if len(entries) > 1:
            faults[name] = _clash(group, name, entries)
            continue
        try:
            loaded = _load(entries[0], group)
        except ModuleNotFoundError as missing:
            lacking[name] = str(missing.name)
            continue
        if isinstance(loaded, Diagnostic):
            faults[name] = loaded
        else:
            plugins[name] = loaded
    return LoadedPlugins(plugins, faults, lacking)


@cache
def _search() -> Any:
    """Return the entry points of installed packages: EntryPoints, before Python 3.12 SelectableGroups.

    The search reads a file of every installed package, so it is made once for all groups. For a package that
    is found twice, it has those of the first.
    """
    return entry_points()


@cache
def _installed(group: str) -> tuple[EntryPoint, ...]:
    return tuple(_search().select(group=GROUPS[group]))


def _is_ours(entry: EntryPoint) -> bool:
    return entry.module.startswith(f"{__package__}.")


def _by_name(group: str) -> dict[str, list[EntryPoint]]:
    table: dict[str, list[EntryPoint]] = {}
    for entry in _installed(group):
        table.setdefault(entry.name, []).append(entry)
    return dict(sorted(table.items()))


def _load(entry: EntryPoint, group: str) -> Any:
    """Return the plugin, or its fault; raise ModuleNotFoundError if an optional library is missing.

    A kind of another package gets the name of that package, to distinguish its faults from ours.
    """
    try:
        plugin = entry.load()
        name, api = plugin.name, plugin.api
        if group == "kinds" and not _is_ours(entry):
            plugin = plugin._replace(package=_owner(entry))
    except Exception as fault:
        if isinstance(fault, ModuleNotFoundError) and is_optional(fault):
            raise
        return Diagnostic(
            "P002",
            f"plugin `{entry.name}` cannot be loaded",
            notes=(_where(entry), f"{type(fault).__name__}: {fault}"),
            help=f"update or remove {_owner(entry)}",
        )
    if api != API_VERSION or name != entry.name:
        return Diagnostic(
            "P003",
            f"plugin `{entry.name}` does not fit this version of shotc",
            notes=(
                _where(entry),
                f"it says name `{name}`, api {api}; wanted name `{entry.name}`, api {API_VERSION}",
            ),
            help=f"update {_owner(entry)}",
        )
    return plugin


def _clash(group: str, name: str, entries: list[EntryPoint]) -> Diagnostic:
    owners = " and ".join(f"{_owner(e)} (`{e.value}`)" for e in entries)
    return Diagnostic(
        "P001",
        f"two packages register `{name}` in {GROUPS[group]}",
        notes=(owners,),
        help="remove one of them; neither is used",
    )


def _where(entry: EntryPoint) -> str:
    return f"`{entry.value}` of package {_owner(entry)}"


def _owner(entry: EntryPoint) -> str:
    return entry.dist.name if entry.dist is not None else "an unknown package"
