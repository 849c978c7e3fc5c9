"""A campaign on a Ray cluster (`pip install 'hairpin[ray]'`): Ray says where and how often, the shards of `hairpin run-shard` do the work.

    import hairpin.cluster

    found = hairpin.cluster.run("/shared/wide", address="auto")

The folder is one that `hairpin plan` made, where all nodes can read and write. A shard is one part of the plan: it appears whole or not at
all, so that whatever dies is simply done again, and what is found is what one machine would have found.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hairpin import _native
from hairpin._asked import flag, function, place, whole
from hairpin._campaign import Campaign
from hairpin._errors import ExecutorError, InputError, Interrupted, WriteError

_RETRIES = 8
_ERRORS: dict[int, type[BaseException]] = {2: InputError, 4: ExecutorError, 74: WriteError, 130: Interrupted}


@dataclass(frozen=True)
class Shard:
    """What a shard came to: ``shard`` as i/N, how many parts it ``made`` and how many were there, its ``cases``, the ``node`` that made it."""

    shard: str
    made: int
    there: int
    cases: int
    node: str


Progress = Callable[[int, int, Shard], object]


def run(
    plan: str | os.PathLike[str],
    *,
    address: str | None = None,
    shards: int | None = None,
    cpus: int = 1,
    retries: int = _RETRIES,
    allow_commands: bool = False,
    command: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> Campaign:
    """Makes all shards of a plan on a Ray cluster, and puts them together here.

    Args:
        plan: the folder of a plan, on a file system that all nodes have.
        address: of the cluster, as ``ray.init`` takes it; a cluster of this machine if not given. Where Ray is initialised already, that is used.
        shards: how many; one for each part of the plan if not given.
        cpus: of a shard: what Ray reserves, and threads that it has.
        retries: how often a shard is done again whose worker or node died.
        allow_commands: what the folder asks to run may.
        command: what `hairpin` is on the nodes; the package's own if not given.
        progress: called with done, of, and the :class:`Shard` that has landed.

    Raises:
        InputError: the folder is not planned, or by another version.
        ExecutorError: a program of the campaign's could not be used.

    The campaign is the one that ``hairpin.stress`` gives on one machine.
    """
    folder, own = Path(place("plan", plan, "the folder of a plan")).resolve(), _command(command)
    of = _parts(folder) if shards is None else whole("shards", shards, 1)
    if progress is not None:
        function("progress", progress, "a function of done, of, shard")
    made = 0
    for landed in stream(
        folder, address=address, shards=of, cpus=cpus, retries=retries, allow_commands=allow_commands, command=own
    ):
        made += 1
        if progress is not None:
            progress(made, of, landed)
    merged = _called([*own, "merge", str(folder), "--json", *_allowed(allow_commands)])
    return Campaign(folder, said={**merged["judged"], "content_hash": merged["content_hash"]})


def stream(
    plan: str | os.PathLike[str],
    *,
    address: str | None = None,
    shards: int | None = None,
    cpus: int = 1,
    retries: int = _RETRIES,
    allow_commands: bool = False,
    command: Sequence[str] | None = None,
) -> Iterator[Shard]:
    """The shards as they land, in whatever order; arguments and errors as of :func:`run`. Nothing is put together yet."""
    import ray

    folder, own = Path(place("plan", plan, "the folder of a plan")).resolve(), _command(command)
    of = _parts(folder) if shards is None else whole("shards", shards, 1)
    cpus, retries = whole("cpus", cpus, *_native.THREADS), whole("retries", retries, 0)
    begun = not ray.is_initialized()
    if begun:
        ray.init(address=address, include_dashboard=False, log_to_driver=False)
    try:
        # Defined here, it travels as it is: nodes need no module but what `command` runs.
        def shard(arguments: list[str]) -> tuple[int, str, str, str]:
            import subprocess as processes

            import ray as on_node

            done = processes.run(arguments, capture_output=True, text=True, stdin=processes.DEVNULL, check=False)
            return done.returncode, done.stdout, done.stderr, str(on_node.get_runtime_context().get_node_id())

        remote = ray.remote(num_cpus=cpus, max_retries=retries)(shard)
        options = ["--json", "--threads", str(cpus), *_allowed(allow_commands)]
        waiting = {remote.remote([*own, "run-shard", f"{i}/{of}", str(folder), *options]): i for i in range(1, of + 1)}
        while waiting:
            landed, _ = ray.wait(list(waiting), num_returns=1)
            for one in landed:
                del waiting[one]
                code, out, error, node = ray.get(one)
                said = _said(code, out, error)
                parts = said["parts"]
                yield Shard(said["shard"], parts["made"], parts["there"], said["counts"]["cases"], node)
    finally:
        if begun:
            ray.shutdown()


def _command(command: Sequence[str] | None) -> list[str]:
    return list(command) if command is not None else [sys.executable, "-m", "hairpin"]


def _allowed(allow_commands: bool) -> list[str]:
    return ["--allow-commands"] if flag("allow_commands", allow_commands) else []


def _parts(folder: Path) -> int:
    try:
        return int(json.loads((folder / "plan.json").read_text())["parts"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{folder} is not divided: hairpin plan SCENARIO --out DIR ({error})") from error


def _called(arguments: list[str]) -> dict[str, Any]:
    done = subprocess.run(arguments, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
    return _said(done.returncode, done.stdout, done.stderr)


def _said(code: int, out: str, error: str) -> dict[str, Any]:
    """What a command said as an object; raises what its exit code means."""
    try:
        said: dict[str, Any] = json.loads(out)
    except ValueError:
        said = {}
    if code == 0 and said:
        return said
    told = str(said.get("error") or said.get("told") or error.strip() or f"hairpin ended with exit code {code}")
    raise _ERRORS.get(code, RuntimeError)(told)
