"""VTK XML files of unstructured grids: text around arrays in base64, in blocks of zlib.

What does not change from step to step is encoded once. Numbers of a field are noise to a compressor, which spends most
of the time of a file on a twentieth of its size: a block of which a sample does not shrink is stored as it is.
"""

import zlib
from base64 import b64encode
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats, Ints

BLOCK_BYTES, SAMPLE_BYTES = 1 << 17, 1 << 12
WORTHWHILE_RATIO = 0.8  # of its size, to which a sample must shrink
FASTEST_LEVEL = 1
VTK_TYPES = {"f8": "Float64", "i8": "Int64", "i4": "Int32", "u1": "UInt8"}

Arrays = Mapping[str, tuple[NDArray[Any], Sequence[str]]]
"""Name -> values (n,) or (n, c), and the names of their components."""


def encode_blocks(values: NDArray[Any]) -> bytes:
    """Base64 of an array in compressed blocks, as VTK reads it.

    The head states the number of blocks, their size, that of a last one that is shorter, and their compressed sizes;
    the
    blocks follow.
    """
    raw = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).tobytes()
    blocks = [_compress_block(raw[start : start + BLOCK_BYTES]) for start in range(0, len(raw), BLOCK_BYTES)]
    sizes = np.array([len(blocks), BLOCK_BYTES, len(raw) % BLOCK_BYTES, *map(len, blocks)], "<u4")
    return b64encode(sizes.tobytes()) + b64encode(b"".join(blocks))


def _compress_block(block: bytes) -> bytes:
    sample = block[:SAMPLE_BYTES]
    return zlib.compress(
        block, FASTEST_LEVEL if len(zlib.compress(sample, FASTEST_LEVEL)) < WORTHWHILE_RATIO * len(sample) else 0
    )


def data_array(name: str, values: NDArray[Any], components: Sequence[str] = (), tuples: bool = False) -> bytes:
    """One array as an XML element. components : their names.

    tuples : whether the number of tuples is stated, as field data need.
    """
    told = f'<DataArray type="{VTK_TYPES[values.dtype.str[1:]]}" Name={quoteattr(name)}'
    if values.ndim > 1:
        told += f' NumberOfComponents="{values.shape[1]}"'
    told += "".join(f" ComponentName{k}={quoteattr(one)}" for k, one in enumerate(components))
    told += f' NumberOfTuples="{len(values)}"' if tuples else ""
    return told.encode() + b' format="binary">\n' + encode_blocks(values) + b"\n</DataArray>\n"


class VtkGrid:
    """Points (n, 3) in mm and cells of one VTK type (m, nodes per cell), encoded once for all steps."""

    def __init__(self, points_mm: Floats, cells: Ints, cell_type: int) -> None:
        self._points, self._cells = len(points_mm), len(cells)
        ends = np.arange(1, len(cells) + 1, dtype=np.int64) * cells.shape[1]
        nodes, types = cells.astype(np.int64).ravel(), np.full(len(cells), cell_type, np.uint8)
        self._geometry = [
            b"<Points>\n", data_array("Points", points_mm), b"</Points>\n<Cells>\n", data_array("connectivity", nodes),
            data_array("offsets", ends), data_array("types", types), b"</Cells>\n",
        ]  # fmt: skip

    def write(self, path: Path, point_data: Arrays, cell_data: Arrays, field_data: Arrays | None = None) -> None:
        """Write a file with these arrays. ValueError for an array of another length."""
        piece = f'<Piece NumberOfPoints="{self._points}" NumberOfCells="{self._cells}">\n'
        content = [
            b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian" ',
            b'header_type="UInt32" compressor="vtkZLibDataCompressor">\n<UnstructuredGrid>\n<FieldData>\n',
            *(data_array(name, *array, tuples=True) for name, array in (field_data or {}).items()),
            b"</FieldData>\n", piece.encode(), *_data_section("PointData", point_data, self._points),
            *_data_section("CellData", cell_data, self._cells), *self._geometry,
            b"</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
        ]  # fmt: skip
        path.write_bytes(b"".join(content))


def _data_section(kind: str, arrays: Arrays, count: int) -> list[bytes]:
    """Element of all arrays of points or of cells; the first is what ParaView shows at first."""
    for name, (values, _) in arrays.items():
        if len(values) != count:
            raise ValueError(f"{name} has the length {len(values)}, not {count}")
    first = next((f" Scalars={quoteattr(name)}" for name in arrays), "")
    told = [data_array(name, np.asarray(values), components) for name, (values, components) in arrays.items()]
    return [f"<{kind}{first}>\n".encode(), *told, f"</{kind}>\n".encode()]
