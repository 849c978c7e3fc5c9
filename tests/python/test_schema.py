"""Every shipped file keeps to the JSON Schema that `hairpin schema` prints for editors."""

import json
import os
import subprocess
import tomllib
from functools import cache
from pathlib import Path

import jsonschema
import pytest

HAIRPIN = os.environ["HAIRPIN_BIN"]
DATA = Path(__file__).parents[2] / "data"
ROBOTS = {path.stem: path for path in DATA.glob("robots/*/*.toml")}
SCENARIOS = sorted(DATA.glob("scenarios/*.toml"))
# What `hairpin schema` calls the files of a kind; those of others stand within their scenarios' schemas alone.
DOCUMENTS = {"quadrotor": "robot", "rover": "rover", "car": "car", "differential-drive": "differential-drive", "arm": "arm"}


@cache
def validator(*asked):
    printed = subprocess.run([HAIRPIN, "schema", *asked], check=True, capture_output=True).stdout
    schema = json.loads(printed)
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def kind(robot):
    return tomllib.loads(ROBOTS[robot].read_text()).get("kind", "quadrotor")


def mistakes(validator, text):
    return [error.message for error in validator.iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda path: path.stem)
def test_scenarios(scenario):
    text = scenario.read_text()
    assert mistakes(validator("--kind", kind(tomllib.loads(text)["robot"])), text) == []


@pytest.mark.parametrize("robot", [robot for robot in ROBOTS if kind(robot) in DOCUMENTS])
def test_robots(robot):
    assert mistakes(validator(DOCUMENTS[kind(robot)]), ROBOTS[robot].read_text()) == []


def test_all_are_there_and_a_mistake_is_one():
    assert {"quadrotor", "rover", "arm", "boat"} <= {path.stem for path in SCENARIOS}
    assert set(DOCUMENTS) <= {kind(robot) for robot in ROBOTS}
    template = (DATA / "scenarios" / "quadrotor.toml").read_text()
    broken = template.replace("cases = 20", "cases = -20")
    assert broken != template and mistakes(validator("scenario"), broken)
    assert mistakes(validator("scenario"), template) == []
