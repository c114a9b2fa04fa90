"""CSV and GPX: what is read, and which line is blamed."""

from __future__ import annotations

import pytest

from shotc.kinds.files import FileFault, NumberTable, read_table
from shotc.kinds.gpx import read_gpx

XYZ = (("x", "y", "z"), ("lat", "lon", "height"))
GPX = '<?xml version="1.0"?>\n<gpx xmlns="http://www.topografix.com/GPX/1/1">\n{}\n</gpx>'


def test_a_header_may_order_its_columns() -> None:
    table = read_table(b"z,X,y\n3,1,2\n\n# rest\n6,4,5\n", XYZ)
    assert table == NumberTable(("z", "x", "y"), ((3.0, 1.0, 2.0), (6.0, 4.0, 5.0)), (2, 5))


def test_rows_without_a_header_take_the_first_layout() -> None:
    assert read_table(b"\xef\xbb\xbf1, 2, 3\r\n4,5,6", XYZ) == NumberTable(
        XYZ[0], ((1, 2, 3), (4, 5, 6)), (1, 2)
    )


@pytest.mark.parametrize(
    ("data", "line", "says"),
    [
        (b"", None, "empty"),
        (b"\n# only a remark\n", None, "empty"),
        (b"x,y,z\n1,2,abc\n", 2, "`abc` is not a number for `z`"),
        (b"x,y,z\n1,2,3\n1,nan,3\n", 3, "out of bounds"),
        (b"x,y,z\n1,inf,3\n", 2, "out of bounds"),
        (b"x,y,z\n1,1e300,3\n", 2, "out of bounds"),
        (b"x,y,z\n1,2\n", 2, "2 columns, not 3"),
        (b"x,y,z\n1,2,1_000\n", 2, "not a number"),
        (b"a,b,c\n1,2,3\n", 1, "names other columns"),
        (b"# r\na,b,c\n", 2, "names other columns"),
        (b"x;y;z\n1;2;3\n", 1, "separated by semicolons"),
        (b"1\t2\t3\n", 1, "separated by tabs"),
        (b"<kml></kml>", 1, "XML"),
        (b"1,2\n", 1, "2 columns"),
        (b"x,y,z\n\xff\xfe\n", 2, "UTF-8"),
        (b"x,y,z\n1,\x002,3\n", 2, "NUL"),
        (b"lat,lon,height\n91,0,0\n", 2, "out of bounds for `lat`"),
    ],
)
def test_a_faulty_table_names_its_line(data: bytes, line: int | None, says: str) -> None:
    fault = read_table(data, XYZ)
    assert isinstance(fault, FileFault)
    assert fault.line == line
    assert says in fault.message


def test_track_points_come_before_route_points() -> None:
    point = '<{0} lat="47.1" lon="8.2"><ele>412.5</ele><time>x</time></{0}>'
    both = GPX.format(
        f"<rte>{point.format('rtept')}</rte><trk><trkseg>{point.format('trkpt') * 2}</trkseg></trk>"
    )
    assert read_gpx(both.encode()) == NumberTable(("lat", "lon", "ele"), ((47.1, 8.2, 412.5),) * 2, (3, 3))
    route = GPX.format(f"<g:rte xmlns:g='u'>{point.format('g:rtept')}</g:rte>")
    assert read_gpx(route.encode()) == NumberTable(("lat", "lon", "ele"), ((47.1, 8.2, 412.5),), (3,))


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ('<!DOCTYPE gpx [<!ENTITY a "b">]>\n<gpx/>', 1, "document type"),
        ("<gpx>", 1, "not well-formed"),
        ("", 1, "not well-formed"),
        (GPX.format(""), None, "no track points"),
        (GPX.format('<trkpt lat="1" lon="2"></trkpt>'), 3, "no elevation"),
        (GPX.format('<trkpt lat="one" lon="2"><ele>1</ele></trkpt>'), 3, "`one` is not a number for `lat`"),
        (GPX.format('<trkpt lon="2"><ele>1</ele></trkpt>'), 3, "`` is not a number for `lat`"),
        (GPX.format('<trkpt lat="91" lon="2"><ele>1</ele></trkpt>'), 3, "out of bounds"),
        (GPX.format('<trkpt lat="1" lon="2"><ele>nan</ele></trkpt>'), 3, "out of bounds for `ele`"),
    ],
)
def test_a_faulty_gpx_names_its_line(text: str, line: int | None, says: str) -> None:
    fault = read_gpx(text.encode())
    assert isinstance(fault, FileFault)
    assert fault.line == line
    assert says in fault.message


def test_deep_gpx_is_read_without_recursion() -> None:
    depth = 20_000
    assert isinstance(read_gpx(b"<a>" * depth + b"</a>" * depth), FileFault)
