"""The workflows that `hairpin init ci` writes are YAML as the servers read it, and their steps are shell."""

import os
import subprocess

import yaml

HAIRPIN = os.environ["HAIRPIN_BIN"]


def written(place, server, file):
    command = [HAIRPIN, "init", "ci", server, "--scenario", 'my "best" rover.toml']
    subprocess.run(command, cwd=place, check=True, capture_output=True)
    return yaml.safe_load((place / file).read_text())


def is_shell(script):
    subprocess.run(["sh", "-n"], input=script, text=True, check=True)


def test_github(tmp_path):
    workflow = written(tmp_path, "github", ".github/workflows/hairpin.yml")
    job = workflow["jobs"]["stress"]
    assert job["env"]["SCENARIO"] == 'my "best" rover.toml'
    assert job["env"]["BUDGET"] == "5m"
    names = [step.get("name") for step in job["steps"]]
    assert names.index("stress") > names.index("saved violations from the cache") > names.index("install hairpin")
    uses = [step["uses"].split("@")[0] for step in job["steps"] if "uses" in step]
    assert {"actions/checkout", "actions/cache", "actions/cache/save", "actions/upload-artifact"} <= set(uses)
    # What is kept is kept of a failure above all.
    kept = [step for step in job["steps"] if step.get("uses", "").startswith(("actions/upload", "actions/cache/save"))]
    assert len(kept) == 2 and all(step["if"] == "always()" for step in kept)
    assert kept[1]["with"]["path"].split() == ["hairpin-junit.xml", "out/ci"]
    for step in job["steps"]:
        is_shell(step.get("run", ""))


def test_gitlab(tmp_path):
    job = written(tmp_path, "gitlab", ".gitlab-ci.yml")["hairpin"]
    assert job["variables"]["SCENARIO"] == 'my "best" rover.toml'
    assert job["artifacts"]["reports"]["junit"] == "hairpin-junit.xml"
    assert job["artifacts"]["when"] == "always"
    assert all(cache["when"] == "always" for cache in job["cache"])
    for part in ("before_script", "script", "after_script"):
        assert all(isinstance(line, str) for line in job[part])
        is_shell("\n".join(job[part]))
