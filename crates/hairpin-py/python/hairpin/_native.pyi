from os import PathLike
from typing import Any, final

__all__ = [
    "Code",
    "Table",
    "Vehicle",
    "__version__",
    "THREADS",
    "GRAPHS",
    "VISITS",
    "PROGRAMS",
    "LARGEST_SEED",
    "LONGEST",
    "run",
    "stress",
    "generate",
    "explain",
    "facts",
    "execute",
    "judge",
    "judge_log",
    "verify",
    "shrink",
    "compare",
    "learn",
    "report",
    "read",
    "max_load",
    "max_load_of_cloud",
]

__version__: str
THREADS: tuple[int, int]
GRAPHS: tuple[int, int]
VISITS: tuple[int, int]
PROGRAMS: tuple[int, int]
LARGEST_SEED: int
LONGEST: float

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

@final
class Table:
    def __new__(cls, folder: _Path, name: str, only: tuple[int | None, int | None]) -> Table: ...
    def __arrow_c_stream__(self, requested_schema: Any | None = None) -> Any: ...
    def __arrow_c_schema__(self) -> Any: ...
    def columns(self) -> dict[str, Any]: ...
    @property
    def names(self) -> list[str]: ...

def run(arguments: list[str]) -> int: ...
def stress(begun: Any, given: tuple[_Path | None, _Path | None], means: Any, waiting: Any) -> dict[str, Any]: ...
def generate(begun: Any, means: Any, waiting: Any) -> dict[str, Any]: ...
def explain(
    asked: tuple[str, list[tuple[str, str]]], effort: tuple[int, float | None], means: Any, waiting: Any
) -> dict[str, Any]: ...
def facts(scenario: str, sets: list[tuple[str, str]]) -> tuple[str, int | None]: ...
def execute(flights: Any, means: Any, waiting: Any) -> dict[str, Any]: ...
def judge(folder: _Path, sets: list[tuple[str, str]], waiting: Any) -> dict[str, Any]: ...
def judge_log(logs: Any, sets: list[tuple[str, str]], waiting: Any) -> dict[str, Any]: ...
def verify(folder: _Path, waiting: Any) -> dict[str, Any]: ...
def shrink(
    asked: tuple[_Path, int], effort: tuple[int, float | None, _Path | None], means: Any, waiting: Any
) -> dict[str, Any]: ...
def compare(folders: tuple[_Path, _Path], tolerance_m: float, waiting: Any) -> dict[str, Any]: ...
def learn(files: tuple[list[_Path], _Path], stress: str, waiting: Any) -> dict[str, Any]: ...
def report(folder: _Path, asked: list[int], waiting: Any) -> str: ...
def read(folder: _Path) -> dict[str, Any]: ...
def max_load(table: bytes, points: int, wanted: Any, waiting: Any) -> dict[str, Any]: ...
def max_load_of_cloud(cloud: Any, wanted: Any, waiting: Any) -> dict[str, Any]: ...
