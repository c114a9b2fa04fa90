"""PyYAML as it is imported: whole for whoever else uses it, without the wait for its own reader."""

from __future__ import annotations

import subprocess
import sys

CODE = """
import re
before = re.compile
from shotc.source.parser import LOADER, yaml
assert re.compile is before
late = yaml.reader.Reader.NON_PRINTABLE
assert not isinstance(late, re.Pattern), "it was compiled"
assert LOADER is yaml.CLoader
assert yaml.load("a: [1, 'ü \U0001f681']", Loader=yaml.SafeLoader) == {"a": [1, "ü \U0001f681"]}
for bad in "\\x00\\x07\\ud800\\ufffe":
    try:
        yaml.load(f"a: {bad}", Loader=yaml.SafeLoader)
    except yaml.reader.ReaderError as error:
        assert error.position == 3
    else:
        raise AssertionError(repr(bad))
print("well")
"""


def test_the_python_reader_still_reads_and_refuses_what_it_should() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("well\n", "")
