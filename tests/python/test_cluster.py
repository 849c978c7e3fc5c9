"""Campaigns on several machines: the examples for schedulers, and two nodes of Ray."""

import json
import os
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
import yaml

HAIRPIN = os.environ["HAIRPIN_BIN"]
EXAMPLES = Path(__file__).parents[2] / "examples" / "cluster"


def told(*arguments):
    command = [HAIRPIN, *map(str, arguments), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(done.stdout)


def planned(folder, cases):
    few = ["execute.baseline=0", "execute.repeat=1"]
    sets = [word for one in few for word in ("--set", one)]
    return told("plan", "demo-quadrotor", "--out", folder, "--cases", cases, *sets)


def tool(name):
    """A linter of the tests' own environment."""
    return str(Path(sys.executable).with_name(name))


def test_the_script_for_slurm_makes_the_shards(tmp_path):
    script = EXAMPLES / "slurm-array.sh"
    subprocess.run([tool("shellcheck"), str(script)], check=True)
    headers = [line.split()[1] for line in script.read_text().splitlines() if line.startswith("#SBATCH")]
    assert "--array=0-15" in headers and "--requeue" in headers
    # As Slurm runs it, with a stand-in for `sbatch` that notes what it was asked.
    plan = planned(tmp_path / "wide", 3)
    bin = tmp_path / "bin"
    bin.mkdir()
    (bin / "hairpin").symlink_to(Path(HAIRPIN).resolve())
    (bin / "sbatch").write_text('#!/bin/sh\nprintf "%s\\n" "$@" > "$NOTED"\n')
    (bin / "sbatch").chmod(0o755)
    for task in range(2):
        slurm = {"SLURM_ARRAY_TASK_ID": task, "SLURM_ARRAY_TASK_MIN": 0, "SLURM_ARRAY_TASK_MAX": 1, "SLURM_ARRAY_TASK_COUNT": 2,
                 "SLURM_ARRAY_TASK_STEP": 1, "SLURM_ARRAY_JOB_ID": 77, "SLURM_CPUS_PER_TASK": 1}  # fmt: skip
        environment = {**os.environ, **{name: str(value) for name, value in slurm.items()}}
        environment |= {"PATH": f"{bin}:{os.environ['PATH']}", "NOTED": str(tmp_path / "noted")}
        subprocess.run(["bash", str(script), str(tmp_path / "wide")], check=True, env=environment, capture_output=True)
    noted = (tmp_path / "noted").read_text()
    assert "--dependency=afterok:77" in noted and "hairpin merge" in noted
    assert told("merge", tmp_path / "wide")["parts"] == plan["parts"] == 3


def test_the_job_for_kubernetes_is_one_by_its_schema_and_does_every_shard():
    file = EXAMPLES / "kubernetes-job.yaml"
    # The first that knows `backoffLimitPerIndex` without being asked for it.
    subprocess.run([tool("kubernetes-validate"), "--strict", "-k", "1.29", str(file)], check=True)
    job = yaml.safe_load(file.read_text())
    spec, pod = job["spec"], job["spec"]["template"]["spec"]
    assert spec["completionMode"] == "Indexed" and 0 < spec["parallelism"] <= spec["completions"]
    assert pod["restartPolicy"] == "Never"  # what backoffLimitPerIndex asks for
    [container] = pod["containers"]
    assert container["command"][:4] == ["hairpin", "run-shard", "--shard", "from-env"]
    assert {one["name"]: one["value"] for one in container["env"]} == {"HAIRPIN_SHARDS": str(spec["completions"])}
    mounted = {mount["name"]: mount["mountPath"] for mount in container["volumeMounts"]}
    assert container["command"][4].startswith(mounted["shared"]) and pod["volumes"][0]["name"] == "shared"


@pytest.fixture
def two_nodes(tmp_path, monkeypatch):
    """Two nodes of Ray on this machine, with a home, a folder and a port of their own."""
    import ray
    from ray.cluster_utils import Cluster

    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    # Names of sockets must be short.
    with tempfile.TemporaryDirectory(prefix="hp-ray-", dir="/tmp", ignore_cleanup_errors=True) as place, socket.socket() as free:
        monkeypatch.setenv("RAY_TMPDIR", place)
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
        free.close()
        few = {"num_cpus": 1, "object_store_memory": 80 * 2**20}
        cluster = Cluster(initialize_head=True, head_node_args={**few, "include_dashboard": False, "gcs_server_port": port})
        try:
            second = cluster.add_node(**few)
            ray.init(address=cluster.address, log_to_driver=False)
            cluster.wait_for_nodes()
            yield cluster, second
        finally:
            ray.shutdown()
            cluster.shutdown()


def test_two_ray_nodes_of_which_one_is_killed_give_what_one_machine_gives(tmp_path, two_nodes):
    import hairpin.cluster

    cluster, second = two_nodes
    one, many = tmp_path / "one", tmp_path / "many"
    planned(one, 5)
    told("run-shard", "1/1", one)
    expected = told("merge", one)["content_hash"]
    planned(many, 5)
    # A shard takes a while, so that some are under way when the node dies.
    slow = tmp_path / "slow"
    slow.write_text(f'#!/bin/sh\nsleep 1\nexec "{Path(HAIRPIN).resolve()}" "$@"\n')
    slow.chmod(0o755)
    nodes, landed = [], []

    def progress(done, of, shard):
        nodes.append(shard.node)
        landed.append((done, of))
        if len(set(nodes)) == 2 and cluster.worker_nodes:
            cluster.remove_node(second, allow_graceful=False)

    found = hairpin.cluster.run(many, command=[str(slow)], progress=progress)
    assert landed == [(done, 5) for done in range(1, 6)]
    assert not cluster.worker_nodes and len(set(nodes)) == 2
    assert found.summary["content_hash"] == expected and len(found) == 5
    with pytest.raises(ValueError, match="not divided"):
        hairpin.cluster.run(tmp_path)
