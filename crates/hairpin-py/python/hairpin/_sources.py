"""The text of a file that does what a callable does: its source, and that of what it uses of its module."""

from __future__ import annotations

import ast
import builtins
import inspect
import sys
import textwrap
import types
from collections.abc import Iterable
from typing import Any

from hairpin._many import takes_many

_LITERALS = (bool, int, float, str, bytes, tuple, list, dict, type(None))
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
_ASKED = {"controller": {"control", "reset"}, "score": {"score", "left"}, "target": {"target"}}
"""What a file is asked for, by name."""
_OURS = frozenset({"_Own", "_own", "_whole", "_parts", "_np"})
"""What is added to a file."""


def source(given: Any, what: str = "controller") -> str | None:
    """The text of a file that does what a callable does, if its source stands alone: imports, plain values and functions of its
    module count, what it closes over or holds as an attribute does not; ``None`` where it does not.

    >>> source(len) is None
    True
    """
    if not isinstance(given, types.FunctionType | type):
        # What an object holds is nowhere in its source.
        return None
    asked = "control" if what == "controller" else what
    found = _Found()
    name = asked if _is_lambda(given) else given.__name__
    if not found.take(name, given):
        return None
    if found.values.get(asked, given) is not given or not (_OURS | _ASKED[what] - {asked}).isdisjoint(found.values):
        # Something else has a name by which the file is asked.
        return None
    lines = found.in_order(name)
    if isinstance(given, type):
        lines.append(_OF_A_CLASS.format(name=name))
    elif what == "score" and takes_many(given):
        # The command asks for one leg at a time.
        lines.append(_ONE_BY_ONE.format(name=name))
    else:
        if name != asked:
            lines.append(f"{asked} = {name}\n")
        if takes_many(given):
            lines.append(f"{asked}.hairpin_vectorised = True\n")
    return "\n\n".join(lines)


_OF_A_CLASS = """_Own = {name}
_own = _Own()

def reset(mission):
    global _own
    _own = _Own()
    if hasattr(_own, 'reset'):
        _own.reset(mission)

def control(t_s, state, reference):
    return _own.control(t_s, state, reference)
"""

_ONE_BY_ONE = """import numpy as _np

_whole = {name}

def _parts(leg):
    parts = _np.asarray(_whole({{key: _np.asarray([value], dtype=float) for key, value in leg.items()}}), dtype=float)
    return parts if parts.ndim == 2 else _np.stack([parts, 0 * parts], axis=1)

def score(leg):
    return float(_parts(leg)[0, 0])

def left(leg):
    return float(_parts(leg)[0, 1])
"""


class _Found:
    """What stands in a file under which name, each with its text."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self._plain: dict[str, str] = {}
        self._defined: dict[str, tuple[str, set[str], set[str]]] = {}

    def take(self, name: str, value: Any, scope: Any = None) -> bool:
        """Has the file mean ``value`` by ``name``; whether that, and all that it needs, has a source."""
        if name in self.values:
            # It may be on its way: what uses itself, or what uses it, is there once it is done.
            return self.values[name] is value
        self.values[name] = value
        if isinstance(value, types.ModuleType):
            self._plain[name] = f"import {value.__name__} as {name}\n"
            return True
        if isinstance(value, _LITERALS):
            self._plain[name] = f"{name} = {value!r}\n"
            return _reads_back(repr(value))
        if isinstance(value, types.FunctionType | type) and scope in (None, value.__module__):
            own = value.__name__
            if own == name or _is_lambda(value):
                return self._define(name, value)
            self._defined[name] = f"{name} = {own}\n", {own}, set()
            return self.take(own, value, scope)
        if isinstance(value, types.FunctionType | types.BuiltinFunctionType | type):
            self._plain[name] = f"from {value.__module__} import {value.__qualname__} as {name}\n"
            return value.__module__ != "__main__" and getattr(sys.modules.get(value.__module__), value.__qualname__, None) is value
        return False

    def _define(self, name: str, thing: Any) -> bool:
        node = _node(thing)
        if node is None or _holds(thing, node):
            return False
        text = ast.unparse(node)
        names = _names([node])
        self._defined[name] = f"{name} = {text}\n" if isinstance(node, ast.Lambda) else f"{text}\n", _names(_at_once(node)), names
        scope = thing.__globals__ if isinstance(thing, types.FunctionType) else vars(inspect.getmodule(thing) or builtins)
        return all(
            self.take(one, scope[one], thing.__module__)
            for one in sorted(names & set(scope))
            if getattr(builtins, one, None) is not scope[one]
        )

    def in_order(self, first: str) -> list[str]:
        """The texts: what one needs while it is defined stands before it, what it needs when it is called anywhere."""
        lines, begun = list(self._plain.values()), set[str]()

        def define(name: str) -> None:
            if name in begun or name not in self._defined:
                return
            begun.add(name)
            text, at_once, names = self._defined[name]
            for one in sorted(at_once):
                define(one)
            lines.append(text)
            for one in sorted(names):
                define(one)

        define(first)
        return lines


def _is_lambda(thing: Any) -> bool:
    return isinstance(thing, types.FunctionType) and thing.__name__ == "<lambda>"


def _reads_back(text: str) -> bool:
    """Whether a text is the value that it is of: that of NaN, or of a list with objects in it, is not."""
    try:
        return repr(ast.literal_eval(text)) == text
    except (ValueError, SyntaxError, RecursionError, MemoryError):
        return False


def _holds(thing: Any, node: ast.AST) -> bool:
    """Whether it has something that its source does not say: what it closes over, or attributes."""
    if isinstance(thing, types.FunctionType):
        return bool(thing.__code__.co_freevars) or not vars(thing).keys() <= {"hairpin_vectorised"}
    # What decorators make, as that of dataclasses does, comes of them again.
    written = [one.name for one in getattr(node, "body", ()) if isinstance(one, ast.FunctionDef) and not one.decorator_list]
    methods = [vars(thing).get(name) for name in written]
    return any(set(one.__code__.co_freevars) - {"__class__"} for one in methods if isinstance(one, types.FunctionType))


def _node(thing: Any) -> ast.expr | ast.stmt | None:
    """The definition of a function or class as the file has it; ``None`` where none was found, or more than one may be it."""
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(thing)))
    except (OSError, TypeError, SyntaxError):
        return None
    if _is_lambda(thing):
        names = thing.__code__.co_varnames[: thing.__code__.co_argcount]
        mine = [
            node
            for node in ast.walk(tree)
            if isinstance(node, ast.Lambda) and tuple(one.arg for one in (*node.args.posonlyargs, *node.args.args)) == names
        ]
        return mine[0] if len({ast.unparse(node) for node in mine}) == 1 else None
    definition = tree.body[0]
    if not isinstance(definition, ast.FunctionDef | ast.ClassDef) or definition.name != thing.__name__:
        return None
    # Decorators of ours are none of the file's.
    definition.decorator_list = [
        d
        for d in definition.decorator_list
        if not (isinstance(d, ast.Name) and d.id == "vectorised")
        and not (isinstance(d, ast.Attribute) and d.attr == "vectorised")
    ]
    return definition


def _names(nodes: Iterable[ast.AST]) -> set[str]:
    return {one.id for node in nodes for one in ast.walk(node) if isinstance(one, ast.Name)}


def _at_once(node: ast.AST) -> list[ast.AST]:
    """What of a definition is evaluated where it stands: all but what functions do when they are called."""
    if isinstance(node, _FUNCTIONS):
        body = node.body if isinstance(node.body, list) else [node.body]
        return [one for one in ast.iter_child_nodes(node) if one not in body]
    found: list[ast.AST] = []
    for one in ast.iter_child_nodes(node):
        found += _at_once(one) if isinstance(one, _FUNCTIONS) or any(isinstance(of, _FUNCTIONS) for of in ast.walk(one)) else [one]
    return found
