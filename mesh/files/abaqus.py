"""Input files of Abaqus and CalculiX: nodes, tetrahedra and element sets of parts and their instances.

As the Abaqus keyword reference has them: names are alike in capitals and small letters, in quotes or not; a line that
ends with a comma goes on; sets hold numbers, other sets and, with GENERATE, ranges. Keywords that would make nodes or
elements in another way are refused, and those that say nothing of the mesh are passed over.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.files import regular_file_size

TET_NODE_COUNTS = {"C3D4": 4, "C3D10": 10}
"""Beginning of the type of a tetrahedron, such as C3D10MH -> number of its nodes, which are in VTK's order."""
TRIANGLE_NODE_COUNTS = {
    "S3": 3, "CPS3": 3, "CPE3": 3, "M3D3": 3, "R3D3": 3, "SFM3D3": 3, "CPS6": 6, "CPE6": 6, "M3D6": 6, "SFM3D6": 6,
    "STRI65": 6,
}  # fmt: skip
"""Type of a facet that may belong to a named surface -> number of its nodes."""
LINE_NODE_COUNTS = {"T3D2": 2, "T3D3": 3, "B31": 2, "B32": 3, "T2D2": 2, "T2D3": 3}
"""Type of an edge, as Gmsh writes them -> number of its nodes; edges are passed over."""
GENERATOR_KEYWORDS = (
    "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SUBMODEL", "SYMMETRIC MODEL GENERATION",
    "IMPORT", "PARAMETER",
)  # fmt: skip
DEEPEST_INCLUDE = 10  # files that include files
MOST_IN_A_RANGE = 1_000_000
LARGEST_INPUT_MB = 500
FIELD_PATTERN = re.compile(r'(?:"[^"]*"|[^,"])+')
Member = tuple[str, int]
"""An element: name of the instance, empty where there is none, and number."""


@dataclass(frozen=True)
class KeywordBlock:
    """A keyword with its parameters, all names in capitals, its data lines, and its place in the file for messages."""

    name: str
    parameters: Mapping[str, str]
    data: Sequence[str]
    place: str

    def input_error(self, reason: str) -> InputError:
        """The InputError for a reason, which names the keyword and its line."""
        return InputError(f"{self.place}: *{self.name}: {reason}")


@dataclass
class Scope:
    """Nodes, elements and sets that are numbered together: those of a part, or of a file without parts."""

    nodes: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    elements: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    sets: dict[str, set[Member]] = field(default_factory=dict)


@dataclass(frozen=True)
class Instance:
    """A part where it stands in the assembly.

    shift : (3,); turn : None, or two points of an axis and degrees (7,).
    """

    part: str
    shift: Floats
    turn: Floats | None

    def points_in_assembly(self, points: Floats) -> Floats:
        """Points (n, 3) of the part, shifted and turned into the assembly."""
        moved = points + self.shift
        if self.turn is None:
            return np.asarray(moved)
        start, end, angle = self.turn[:3], self.turn[3:6], self.turn[6]
        axis = (end - start) / np.linalg.norm(end - start)
        return np.asarray(start + Rotation.from_rotvec(np.radians(angle) * axis).apply(moved - start))


@dataclass
class AbaqusMesh:
    """The mesh in an input file.

    points_mm : (n, 3); cells : type of Abaqus and numbers of its nodes; sets : name in small letters -> numbers of
    cells.
    """

    points_mm: Floats
    cells: list[tuple[str, tuple[int, ...]]]
    sets: dict[str, list[int]]


class _Model:
    """Parts, instances and sets that the keywords of a file have defined so far."""

    def __init__(self) -> None:
        self.root = Scope()
        self.parts: dict[str, Scope] = {}
        self.instances: dict[str, Instance] = {}
        self.scope = self.root
        self.inside_instance = False

    def read_block(self, block: KeywordBlock) -> None:
        """Read one keyword with its data. InputError for one that is not supported or contradicts others."""
        if block.name in GENERATOR_KEYWORDS:
            raise block.input_error("is not read; write all nodes and elements out")
        known = {
            "NODE": self._read_nodes,
            "ELEMENT": self._read_elements,
            "ELSET": self._read_element_set,
            "PART": self._read_part,
            "INSTANCE": self._read_instance,
        }
        if block.name in known:
            if self.inside_instance and block.name != "INSTANCE":
                raise block.input_error(
                    "stands inside an *INSTANCE; only those that take all from their *PART are read"
                )
            known[block.name](block)
        elif block.name == "END PART":
            self.scope = self.root
        elif block.name == "END INSTANCE":
            self.inside_instance = False

    def _read_part(self, block: KeywordBlock) -> None:
        name = _required_parameter(block, "NAME")
        if name in self.parts:
            raise block.input_error(f"NAME = '{name}' appears twice")
        self.scope = self.parts[name] = Scope()

    def _read_instance(self, block: KeywordBlock) -> None:
        name, part = _required_parameter(block, "NAME"), _required_parameter(block, "PART")
        if name in self.instances:
            raise block.input_error(f"NAME = '{name}' appears twice")
        if part not in self.parts:
            raise block.input_error(f"PART = '{part}' is not defined before it")
        rows = [[_real_number(text, block) for text in _comma_fields(line)] for line in block.data]
        shift = np.array(rows[0] if rows else (0.0, 0.0, 0.0))
        turn = np.array(rows[1]) if len(rows) > 1 else None
        if len(shift) != 3 or (turn is not None and (len(turn) != 7 or np.array_equal(turn[:3], turn[3:6]))):
            raise block.input_error("needs three numbers of a shift, and then two points of an axis and an angle")
        self.instances[name] = Instance(part, shift, turn)
        self.inside_instance, self.scope = True, self.root

    def _read_nodes(self, block: KeywordBlock) -> None:
        if block.parameters.get("SYSTEM", "R") != "R":
            raise block.input_error("SYSTEM must be R; cylindrical and spherical coordinates are not read")
        for line in block.data:
            texts = _comma_fields(line)
            x, y, z = (_real_number(text, block) if text else 0.0 for text in [*texts[1:4], "", "", ""][:3])
            number = _integer(texts[0], block)
            if self.scope.nodes.setdefault(number, (x, y, z)) != (x, y, z):
                raise block.input_error(f"node {number} is defined twice")

    def _read_elements(self, block: KeywordBlock) -> None:
        kind = _required_parameter(block, "TYPE")
        count = _node_count(kind)
        if count is None:
            raise block.input_error(f"TYPE = {kind} is not read; all solids must be tetrahedra, C3D4 or C3D10")
        numbers = []
        for record in _integer_rows(block, count + 1):
            number, nodes = record[0], tuple(record[1:])
            if self.scope.elements.setdefault(number, (kind, nodes)) != (kind, nodes):
                raise block.input_error(f"element {number} is defined twice")
            numbers.append(number)
        if "ELSET" in block.parameters:
            self.scope.sets.setdefault(block.parameters["ELSET"], set()).update(("", number) for number in numbers)

    def _read_element_set(self, block: KeywordBlock) -> None:
        name, instance = _required_parameter(block, "ELSET"), block.parameters.get("INSTANCE", "")
        if instance and instance not in self.instances:
            raise block.input_error(f"INSTANCE = '{instance}' is not defined before it")
        found = self.scope.sets.setdefault(name, set())
        for line in block.data:
            texts = [text for text in _comma_fields(line) if text]
            if "GENERATE" in block.parameters:
                found |= {(instance, number) for number in _generated_numbers(texts, block)}
            else:
                for text in texts:
                    found |= self._set_members(text, instance, block)

    def _set_members(self, text: str, instance: str, block: KeywordBlock) -> set[Member]:
        """Elements that a number or the name of a set stands for, either behind the name of an instance."""
        place, _, rest = text.rpartition(".")
        inside = _capital_name(place) in self.instances
        owner, own = (_capital_name(place), _capital_name(rest)) if inside else (instance, _capital_name(text))
        if own.isascii() and own.isdigit():
            return {(owner, int(own))}
        sets = self.parts[self.instances[owner].part].sets if owner else self.scope.sets
        if own not in sets:
            raise block.input_error(
                f"holds '{text[:40]}', which is neither a number nor a set that was defined before it"
            )
        return {(inner or owner, number) for inner, number in sets[own]}

    def assembled_mesh(self, where: str) -> AbaqusMesh:
        """The mesh of every instance of a part, or of every part once where there is no instance. InputError."""
        placed: dict[str, tuple[Scope, Instance | None]] = {
            name: (self.parts[one.part], one) for name, one in self.instances.items()
        }
        placed = placed or {f"part {name}": (part, None) for name, part in self.parts.items()}
        mesh = AbaqusMesh(np.zeros((0, 3)), [], {})
        found: dict[Member, int] = {}
        for name, (scope, instance) in {"": (self.root, None), **placed}.items():
            _add_body(mesh, found, name, scope, instance, where)
        bodies = {"": self.root, **{name: scope for name, (scope, _) in placed.items()}}
        for name, scope in bodies.items():
            for label, members in scope.sets.items():
                cells = mesh.sets.setdefault(label.lower(), [])
                for inner, number in sorted(members):
                    if (inner or name, number) not in found:
                        raise InputError(f"{where}: set '{label}' holds element {number}, which is not there")
                    cells.append(found[inner or name, number])
        return mesh


def _add_body(
    mesh: AbaqusMesh, found: dict[Member, int], name: str, scope: Scope, instance: Instance | None, where: str
) -> None:
    """Add the nodes and elements of one body behind those of the mesh. InputError for an unknown node."""
    points = np.array(list(scope.nodes.values()), dtype=np.float64).reshape(-1, 3)
    places = {number: len(mesh.points_mm) + place for place, number in enumerate(scope.nodes)}
    for number, (kind, nodes) in scope.elements.items():
        try:
            cell = tuple(places[node] for node in nodes)
        except KeyError as error:
            raise InputError(f"{where}: element {number} has node {error}, which is not there") from None
        found[name, number] = len(mesh.cells)
        mesh.cells.append((kind, cell))
    mesh.points_mm = np.concatenate(
        [mesh.points_mm, points if instance is None else instance.points_in_assembly(points)]
    )


def read_abaqus(path: Path, where: str) -> AbaqusMesh:
    """The mesh in a file and those that it includes. where : how a message calls it. InputError for other content."""
    model = _Model()
    for block in _keyword_blocks(path, where, ()):
        model.read_block(block)
    return model.assembled_mesh(where)


def is_tet(kind: str) -> bool:
    """Whether a type of Abaqus is a tetrahedron."""
    return kind.startswith("C3D") and _node_count(kind) is not None


def is_triangle(kind: str) -> bool:
    """Whether a type of Abaqus is a facet."""
    return not is_tet(kind) and any(kind.startswith(name) for name in TRIANGLE_NODE_COUNTS)


def _node_count(kind: str) -> int | None:
    """Number of nodes of a type of element; None for a type that is not read."""
    found = re.fullmatch(r"(C3D10|C3D4)[A-Z]*", kind)
    if found:
        return TET_NODE_COUNTS[found[1]]
    return {**TRIANGLE_NODE_COUNTS, **LINE_NODE_COUNTS, "S3R": 3, "S3RS": 3, "B31H": 2, "B32H": 3}.get(kind)


def _keyword_blocks(path: Path, where: str, outer: tuple[Path, ...]) -> Iterator[KeywordBlock]:
    """Keywords of a file with their data, those of included files at their place. InputError."""
    if len(outer) == DEEPEST_INCLUDE or path.resolve() in outer:
        raise InputError(f"{where}: '{path.name}' is included in a circle or deeper than {DEEPEST_INCLUDE} files")
    inside = (*outer, path.resolve())
    lines = _file_text(path, where, bool(outer)).splitlines()
    number = 0
    while number < len(lines):
        begun, line = number, lines[number].strip()
        number += 1
        if not line.startswith("*"):
            if line:
                raise InputError(f"{where}: line {begun + 1} of '{path.name}' belongs to no keyword")
            continue
        while line.endswith(",") and number < len(lines):  # a keyword that goes on
            line += lines[number].strip()
            number += 1
        data = []
        while number < len(lines) and not _is_keyword(lines[number]):
            if lines[number].strip() and not lines[number].startswith("**"):
                data.append(lines[number].strip())
            number += 1
        if line.startswith("**"):
            continue
        block = _parse_block(line, data, f"{where}: line {begun + 1} of '{path.name}'")
        if block.name == "INCLUDE":
            yield from _keyword_blocks(path.parent / _input_file_name(block), where, inside)
        elif block.name in ("NODE", "ELEMENT", "ELSET") and "INPUT" in block.parameters:
            rows = _file_text(path.parent / _input_file_name(block), where, True).splitlines()
            below = [row.strip() for row in rows if row.strip() and not row.startswith("**")]
            yield KeywordBlock(block.name, block.parameters, [*below, *data], block.place)
        else:
            yield block


def _file_text(path: Path, where: str, named: bool) -> str:
    """Text of a file. InputError where it cannot be read or is too large.

    Bytes that are not UTF-8 can only be in a remark or a foreign name, and are replaced.
    """
    what = f"{where}: '{path.name}'" if named else where
    if (size := regular_file_size(path, what)) > 1e6 * LARGEST_INPUT_MB:
        raise InputError(f"{what}: has {size / 1e6:.0f} MB, at most {LARGEST_INPUT_MB} MB are read")
    try:
        return path.read_bytes().decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"{what}: cannot be read ({error.strerror})") from None


def _is_keyword(line: str) -> bool:
    stripped = line.strip()
    return stripped.startswith("*") and not stripped.startswith("**")


def _parse_block(line: str, data: list[str], place: str) -> KeywordBlock:
    """Keyword of a line and its data.

    *ELSET, elset="Medium2", generate -> ELSET, {ELSET: MEDIUM2, GENERATE: ""}.
    """
    first, *rest = [text.strip() for text in FIELD_PATTERN.findall(line)]
    parameters = {}
    for text in rest:
        key, _, value = text.partition("=")
        if "".join(key.split()):
            parameters[" ".join(key.upper().split())] = (
                value.strip() if key.strip().upper() == "INPUT" else _capital_name(value)
            )
    return KeywordBlock(" ".join(first.lstrip("*").upper().split()), parameters, data, place)


def _input_file_name(block: KeywordBlock) -> str:
    """Name of the file that a keyword names, as it is written. InputError where it is missing."""
    file = block.parameters.get("INPUT", "").strip('"')
    if not file or "\0" in file:
        raise block.input_error("INPUT is missing, the name of a file")
    return file


def _capital_name(text: str) -> str:
    return text.strip().strip('"').strip().upper()


def _required_parameter(block: KeywordBlock, key: str) -> str:
    if not block.parameters.get(key):
        raise block.input_error(f"{key} is missing")
    return block.parameters[key]


def _comma_fields(line: str) -> list[str]:
    """Texts between commas, commas within quotes not counted."""
    if '"' in line:
        return [text.strip() for text in FIELD_PATTERN.findall(line)]
    return [text.strip() for text in line.split(",")]


def _integer_rows(block: KeywordBlock, length: int) -> Iterator[list[int]]:
    """Rows of this many whole numbers, each on one line or on several that end with a comma. InputError."""
    record: list[int] = []
    for line in block.data:
        record += [_integer(text, block) for text in line.split(",") if text.strip()]
        if len(record) == length:
            yield record
            record = []
        elif len(record) > length or not line.endswith(","):
            raise block.input_error(
                f"'{line[:60]}' must be {length} numbers: that of the element and those of its nodes"
            )
    if record:
        raise block.input_error(f"its last element must have {length} numbers")


def _generated_numbers(texts: Sequence[str], block: KeywordBlock) -> range:
    """Numbers from the first to the last by a step, which may be left out where it is 1. InputError."""
    numbers = [_integer(text, block) for text in texts]
    first, last, step = [*numbers, 1][:3] if len(numbers) == 2 else numbers if len(numbers) == 3 else (0, 0, 0)
    if step < 1 or last < first or (last - first) % step or (last - first) // step > MOST_IN_A_RANGE:
        raise block.input_error(
            f"'{', '.join(texts)[:60]}' must be the first number, the last, and the step between them"
        )
    return range(first, last + 1, step)


def _integer(text: str, block: KeywordBlock) -> int:
    own = text.strip()
    if not (own.isascii() and own.isdigit() and len(own) < 19):
        raise block.input_error(f"'{own[:40]}' must be a whole number")
    return int(own)


def _real_number(text: str, block: KeywordBlock) -> float:
    own = text.strip()
    try:
        return float(own.upper().replace("D", "E").replace("_", "?"))
    except ValueError:
        raise block.input_error(f"'{own[:40]}' must be a number") from None
