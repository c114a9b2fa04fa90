"""The loading of a mission: from the bytes of the file to its models, or to diagnostics."""

import re
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from pydantic import ValidationError

from shotc.diag.codes.yaml import text_diagnostic
from shotc.diag.model import Diagnostic
from shotc.ir.origin import OriginMap
from shotc.ir.source import Chosen, KeptFiles
from shotc.source.file import SourceFile
from shotc.source.yaml_tree import Document, parse
from shotc.spec.mission import VERSION, MissionSpec, is_version
from shotc.spec.places import TITLE
from shotc.spec.shape_faults import plan_given, shape_faults
from shotc.spec.shot import ShotBase

NOTHING: Mapping[str, Diagnostic] = MappingProxyType({})

# The start of a plan.json, which is also valid YAML.
_PLAN = rb'\s*\{\s*"format"\s*:\s*"shotc-plan"'


class LoadedMission(NamedTuple):
    """A mission of valid shape; its names are not resolved yet.

    folder : of the files that it names, or these files, or None for text without a folder
    sha256 : of the mission's bytes, hexadecimal; text : those bytes
    chosen : planning's choices where the text leaves them open
    """

    spec: MissionSpec
    origins: OriginMap
    folder: Path | KeptFiles | None
    sha256: str
    text: bytes = b""
    chosen: Chosen = Chosen()


class Loaded(NamedTuple):
    """The result of loading: a mission, or None if a diagnostic is an error.

    title : the mission's name, None if it has no valid one
    """

    mission: LoadedMission | None
    diagnostics: tuple[Diagnostic, ...]
    file: SourceFile
    title: str | None = None


def load(
    data: bytes,
    name: str,
    folder: Path | KeptFiles | None,
    kinds: Mapping[str, type[ShotBase]],
    unusable: Mapping[str, Diagnostic] = NOTHING,
) -> Loaded:
    """Read a mission; never raise, for any bytes.

    name : of the file in messages; folder : as in LoadedMission; kinds : the model of every kind of shot
    unusable : diagnostics of registered kinds that cannot be used
    """
    if data[:64].lstrip().startswith(b"{") and re.match(_PLAN, data):
        return Loaded(None, (plan_given(name),), SourceFile(name, ""))
    document = parse(data, name)
    if document.faults:
        return Loaded(None, tuple(text_diagnostic(fault, name) for fault in document.faults), document.file)
    origins = OriginMap(name, document.keys, document.values)
    spec, error = _validate(document, kinds)
    if spec is None or not _is_whole(document.root, kinds):
        faults = shape_faults(document.root, error, (kinds, unusable), origins, document.file)
        assert faults, "a mission is not rejected without a word"
        return Loaded(None, faults, document.file, _title(document))
    return Loaded(
        LoadedMission(spec, origins, folder, sha256(data).hexdigest(), data),
        (),
        document.file,
        spec.mission,
    )


def _title(document: Document) -> str | None:
    written = document.root.get("mission")
    return written if isinstance(written, str) and re.fullmatch(TITLE.pattern, written) else None


def _validate(
    document: Document, kinds: Mapping[str, type[ShotBase]]
) -> tuple[MissionSpec | None, ValidationError | None]:
    # The version is checked before and separately, so that a missing one does not hide the other faults.
    root = {**document.root, "shotc": VERSION}
    try:
        return MissionSpec.model_validate(root, context={"kinds": kinds}), None
    except ValidationError as error:
        return None, error


def _is_whole(root: Mapping[str, Any], kinds: Mapping[str, type[ShotBase]]) -> bool:
    """Return whether a mission that fits its models has its version, and shots of known kinds only."""
    known = [shot["kind"] in kinds for shot in root.get("shots", [])]
    return is_version(root.get("shotc")) and bool(known) and all(known)
