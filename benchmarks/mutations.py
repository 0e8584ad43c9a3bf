"""Mutants of a module: another operator, constant, condition, min, returned value or way out of a loop.

Texts, annotations, decorators, imports and what is raised stay as they are.
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from types import CodeType
from typing import Any

OTHER: dict[type, tuple[type, ...]] = {
    ast.Lt: (ast.LtE, ast.GtE), ast.LtE: (ast.Lt, ast.Gt), ast.Gt: (ast.GtE, ast.LtE), ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,), ast.Is: (ast.IsNot,), ast.IsNot: (ast.Is,), ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,), ast.And: (ast.Or,), ast.Or: (ast.And,), ast.Add: (ast.Sub,), ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,), ast.Div: (ast.Mult,), ast.FloorDiv: (ast.Mult,), ast.Mod: (ast.Mult,), ast.Pow: (ast.Mult,),
    ast.BitAnd: (ast.BitOr,), ast.BitOr: (ast.BitAnd,), ast.Continue: (ast.Break,), ast.Break: (ast.Continue,),
}  # fmt: skip
PAIRS = (("min", "max"), ("minimum", "maximum"), ("argmin", "argmax"), ("any", "all"), ("floor", "ceil"))
SWAPPED = {**dict(PAIRS), **{other: one for one, other in PAIRS}}
UNTOUCHED = (ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom)
HIDDEN = {"annotation", "returns", "decorator_list", "format_spec"}
TOLD = {"description", "title"}


@dataclass(frozen=True)
class Mutant:
    """start, end : bytes that after stands in for, in a line (text) from a column on.

    lines : first and last of what runs when that place does.
    """

    file: str
    line: int
    column: int
    lines: tuple[int, int]
    text: str
    before: str
    after: str
    start: int
    end: int

    @property
    def name(self) -> str:
        """By which it is known again when other lines of its file have changed."""
        return f"{self.file}: {self.text}: {self.column}: {self.before} -> {self.after}"

    def applied(self, root: Path) -> bytes:
        """The source of its file with the change."""
        source = (root / self.file).read_bytes()
        return source[: self.start] + self.after.encode() + source[self.end :]

    def differs(self, root: Path) -> bool:
        """Whether its byte code is another."""
        return _byte_code(self.applied(root)) != _byte_code((root / self.file).read_bytes())


def _byte_code(source: bytes | CodeType) -> tuple[Any, ...]:
    code = source if isinstance(source, CodeType) else compile(source, "", "exec")
    return code.co_code, code.co_names, [_byte_code(c) if isinstance(c, CodeType) else repr(c) for c in code.co_consts]


def mutants_of(root: Path, file: str) -> Iterator[Mutant]:
    """Every mutant of a file below root."""
    source = (root / file).read_bytes()
    rows = source.splitlines(keepends=True)
    begins = [0, *accumulate(map(len, rows))]
    for node, new, lines in _changes(ast.parse(source), None):
        start = begins[node.lineno - 1] + node.col_offset
        end = begins[node.end_lineno - 1] + node.end_col_offset
        after = f"({ast.unparse(new)})" if isinstance(new, ast.expr) else ast.unparse(new)
        text = rows[node.lineno - 1].decode().strip()
        yield Mutant(file, node.lineno, node.col_offset, lines, text, source[start:end].decode(), after, start, end)


def _changes(node: Any, lines: tuple[int, int] | None) -> Iterator[tuple[Any, ast.AST, tuple[int, int]]]:
    """Each node in this one, what may stand in its place, and the lines that run when it does."""
    if isinstance(node, UNTOUCHED) or _is_for_readers(node):
        return
    if hasattr(node, "lineno"):
        own = node.lineno, node.end_lineno
        lines = None if isinstance(node, ast.stmt) and hasattr(node, "body") else lines or own
        yield from ((node, new, lines or own) for new in _instead(node))
    test = getattr(node, "test", None)
    if isinstance(test, ast.Name | ast.Attribute | ast.Call | ast.BoolOp | ast.NamedExpr):
        yield test, ast.UnaryOp(ast.Not(), test), lines or (test.lineno, test.end_lineno or test.lineno)
    for name, inner in ast.iter_fields(node):
        for one in inner if isinstance(inner, list) else [inner]:
            if isinstance(one, ast.AST) and name not in HIDDEN:
                yield from _changes(one, lines)


def _is_for_readers(node: ast.AST) -> bool:
    """Docstrings, descriptions, what only type checkers see."""
    match node:
        case ast.Expr(value=ast.Constant()) | ast.Assign(targets=[ast.Name(id="__all__")]):
            return True
        case ast.If(test=ast.Name(id="TYPE_CHECKING")):
            return True
        case ast.keyword(arg=name):
            return name in TOLD
    return False


def _instead(node: Any) -> Iterator[ast.AST]:
    """What a node is mutated to."""
    match node:
        case ast.Compare(left=left, ops=ops, comparators=right):
            for n, op in enumerate(ops):
                yield from (ast.Compare(left, [*ops[:n], new(), *ops[n + 1 :]], right) for new in OTHER[type(op)])
        case ast.BinOp(left=left, op=op, right=right):
            yield from (ast.BinOp(left, new(), right) for new in OTHER.get(type(op), ()))
        case ast.AugAssign(target=target, op=op, value=value):
            yield from (ast.AugAssign(target, new(), value) for new in OTHER.get(type(op), ()))
        case ast.BoolOp(op=op, values=values):
            yield ast.BoolOp(OTHER[type(op)][0](), values)
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            yield operand
        case ast.Continue() | ast.Break():
            yield OTHER[type(node)][0]()
        case ast.Return(value=ast.expr()):
            yield ast.Return(ast.Constant(None))
        case ast.Constant(value=value):
            yield from map(ast.Constant, _other_values(value))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=keywords) if name in SWAPPED:
            yield ast.Call(ast.Name(SWAPPED[name]), args, keywords)
        case ast.Call(func=ast.Attribute(value=value, attr=name), args=args, keywords=keywords) if name in SWAPPED:
            yield ast.Call(ast.Attribute(value, SWAPPED[name]), args, keywords)


def _other_values(value: object) -> list[Any]:
    """In place of a constant; a text with blanks is told to somebody."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, value - 1]
    if isinstance(value, float):
        return [value + 1.0]
    return [f"{value}X"] if isinstance(value, str) and value and " " not in value else []
