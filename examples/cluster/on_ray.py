"""A campaign on a Ray cluster: python on_ray.py FOLDER_OF_THE_PLAN [ADDRESS]

The folder is one that all nodes can write; `hairpin plan quadrotor.toml --cases 10000 --out FOLDER` makes it.
"""

import sys

import hairpin.cluster


def tell(done: int, of: int, shard: hairpin.cluster.Shard) -> None:
    print(f"{done}/{of}: shard {shard.shard} with {shard.cases} cases", file=sys.stderr)


if __name__ == "__main__":
    found = hairpin.cluster.run(sys.argv[1], address=sys.argv[2] if len(sys.argv) > 2 else None, progress=tell)
    print(found.verdict)
