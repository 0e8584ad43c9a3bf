"""What is sent stays in its folder and within its bounds, whatever it claims."""

import io
import stat
import zipfile

import pytest

from foundation.errors import InputError
from softdot.studio import uploads
from softdot.studio.uploads import split, unpack
from tests.cases import for_each


def zipped(files, compression=zipfile.ZIP_DEFLATED):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", compression) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return [("recording.zip", made.getvalue())]


def everything_below(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


@pytest.fixture
def inner(tmp_path):
    folder = tmp_path / "inner"
    folder.mkdir()
    return folder


FILES = {
    "rig/rig.toml": b"seed = 0\n",
    "rig/press.csv": b"time_s\n0\n",
    "rig/photo.jpg": b"x",
    "__MACOSX/rig/._rig.toml": b"x",
}


@pytest.mark.parametrize("sent", [list(FILES.items()), zipped(FILES)], ids=["folder", "zip"])
def test_tables_and_samples_are_unpacked_and_the_rest_is_left_out(inner, sent):
    assert unpack(sent, inner) == inner / "rig"
    assert everything_below(inner) == ["rig/press.csv", "rig/rig.toml"]
    assert (inner / "rig/rig.toml").read_bytes() == b"seed = 0\n"


OUTSIDE = [
    "../rig.toml",
    "/tmp/rig.toml",
    "a/../../rig.toml",
    "..\\rig.toml",
    "C:\\rig.toml",
    "C:rig.toml",
    "a\nb/rig.toml",
    "//server/share/rig.toml",
    "a/\x00/rig.toml",
    "a:stream.toml",
]


@for_each("name", OUTSIDE)
@for_each("as_zip", [False, True])
def test_no_name_leads_out_of_the_folder(inner, name, as_zip):
    sent = zipped({name: b"x"}) if as_zip else [(name, b"x")]
    with pytest.raises(InputError, match=r"not allowed|no rig\.toml"):
        unpack(sent, inner)
    assert everything_below(inner.parent) in ([], ["inner/a/rig.toml"] if "\x00" in name else [])


def test_a_link_in_a_zip_file_is_refused(inner):
    link = zipfile.ZipInfo("rig.toml")
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr(link, "/etc/passwd")
    with pytest.raises(InputError, match="links"):
        unpack([("x.zip", made.getvalue())], inner)
    assert everything_below(inner) == []


def test_a_zip_bomb_is_stopped_while_it_unpacks(inner, monkeypatch):
    monkeypatch.setattr(uploads, "LARGEST_UNPACKED_MB", 3.0)
    with pytest.raises(InputError, match="more than 3 MB"):
        unpack(zipped({"rig.toml": b"0" * 2_000_000, "a.csv": b"0" * 50_000_000}), inner)
    assert sum(path.stat().st_size for path in inner.rglob("*.csv")) <= 3_000_000


def test_too_many_files_are_refused(inner):
    many = [(f"{number}.csv", b"") for number in range(uploads.MOST_FILES + 1)]
    with pytest.raises(InputError, match="at most 500"):
        unpack(many, inner)
    with pytest.raises(InputError, match="at most 500"):
        unpack(zipped(dict(many)), inner)
    assert everything_below(inner) == []


@for_each("content", [b"PK\x03\x04" + bytes(range(256)) * 40, zipped(FILES)[0][1][:-30], b"PK\x03\x04"])
def test_a_damaged_zip_file_is_refused_in_one_sentence(inner, content):
    with pytest.raises(InputError, match="damaged"):
        unpack([("x.zip", content)], inner)


def test_the_same_name_twice_is_refused(inner):
    with pytest.raises(InputError, match="cannot be written"):
        unpack([("rig.toml", b"1"), ("rig.toml", b"2")], inner)


@for_each(
    "body",
    [b"", b"[]", b"[[1]]\n", b'[["a", 5]]\nabc', b'[["a", -1], ["b", 4]]\nabc', b"[" * 100_000 + b"\n", b"\xff\n"],
)
def test_an_upload_of_another_form_is_refused(body):
    with pytest.raises(InputError, match=r"form|as long"):
        split(body + b"x")


def test_an_upload_is_split_as_it_was_sent():
    assert split(b'[["a/b.csv", 3], ["c.toml", 0], ["d.csv", 2]]\nabcde') == [
        ("a/b.csv", b"abc"),
        ("c.toml", b""),
        ("d.csv", b"de"),
    ]
