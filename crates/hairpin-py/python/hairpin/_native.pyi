from os import PathLike
from typing import Any, final

__all__ = [
    "Code",
    "Vehicle",
    "__version__",
    "run",
    "stress",
    "generate",
    "explain",
    "score_key",
    "execute",
    "judge",
    "verify",
    "shrink",
    "compare",
    "learn",
    "report",
    "read",
    "max_load",
]

__version__: str

_Path = str | PathLike[str]

@final
class Code:
    def __new__(cls, score: Any | None = None, target: Any | None = None, controller: Any | None = None) -> Code: ...

@final
class Vehicle:
    def __new__(
        cls,
        rover: str,
        files: tuple[_Path | None, _Path | None],
        may: tuple[bool, bool],
        time_limit_s: float | None,
    ) -> Vehicle: ...
    def answer(self, table: bytes, on_map: bool, common: Any, waiting: Any) -> tuple[bytes, bytes, list[str]]: ...
    @property
    def facts(self) -> tuple[str, float, float]: ...

def run(arguments: list[str]) -> int: ...
def stress(begun: Any, given: tuple[_Path | None, _Path | None], means: Any, waiting: Any) -> dict[str, Any]: ...
def generate(begun: Any, means: Any, waiting: Any) -> dict[str, Any]: ...
def explain(
    asked: tuple[str, list[tuple[str, str]]], effort: tuple[int, float | None], means: Any, waiting: Any
) -> dict[str, Any]: ...
def score_key(scenario: str, sets: list[tuple[str, str]]) -> str: ...
def execute(flights: Any, means: Any, waiting: Any) -> dict[str, Any]: ...
def judge(folder: _Path, sets: list[tuple[str, str]], waiting: Any) -> dict[str, Any]: ...
def verify(folder: _Path, waiting: Any) -> dict[str, Any]: ...
def shrink(
    asked: tuple[_Path, int], effort: tuple[int, float | None, _Path | None], means: Any, waiting: Any
) -> dict[str, Any]: ...
def compare(folders: tuple[_Path, _Path], tolerance_m: float, waiting: Any) -> dict[str, Any]: ...
def learn(files: tuple[list[_Path], _Path], stress: str, waiting: Any) -> dict[str, Any]: ...
def report(folder: _Path, asked: list[int], waiting: Any) -> str: ...
def read(folder: _Path) -> dict[str, Any]: ...
def max_load(table: bytes, points: int, wanted: Any, waiting: Any) -> dict[str, Any]: ...
