"""A notebook in a kernel of its own: an own robot, a controller written in a cell, the worst flight, its reduction, a view while it runs."""

import os
from pathlib import Path

import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")

ROBOT = (Path(__file__).parents[2] / "data/robots/quadrotor/anafi.toml").read_text()
CELLS = (
    "import hairpin",
    """def controller(t_s, state, reference):
    target = reference["waypoints_m"][min(reference["next"], len(reference["waypoints_m"]) - 1)]
    return {"v_m_s": [1.5 * (goal - at) for goal, at in zip(target, state["p_m"])]}""",
    """found = hairpin.stress(
    hairpin.Scenario("demo-quadrotor", robot="own.toml"), controller=controller, out="out", progress=hairpin.live(),
    values={"generate.search": {"method": "uniform", "waypoints": 60, "cases": 2}, "execute.repeat": 1, "execute.baseline": 0,
            "spec.deviation.max_m": 0.2},
)
found""",
    "found.show()",
    "found.worst.violations[0].told",
    "small = found.shrink(budget=6)\nassert len(small.waypoints_m) <= len(small.waypoints_before_m)\nprint(small)",
)


@pytest.fixture(scope="module")
def outputs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("notebook")
    (folder / "own.toml").write_text(ROBOT.replace('name = "', 'name = "own-'))
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
    kernel = {"cwd": str(folder), "env": {**os.environ, "IPYTHONDIR": str(folder / "ipython")}}
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute(**kernel)
    return folder, [cell["outputs"] for cell in notebook.cells]


def htmls(outputs):
    return ["".join(one["data"]["text/html"]) for one in outputs if "text/html" in one.get("data", {})]


def test_the_worst_flight_is_seen_in_a_cell(outputs):
    folder, cells = outputs
    told = htmls(cells[2])[-1]
    assert "FAIL" in told and "<svg" in told and 'class="worst"' in told
    assert htmls(cells[3])[0].startswith("<iframe") and "srcdoc=" in htmls(cells[3])[0]
    assert "deviat" in cells[4][0]["data"]["text/plain"] and "still" in "".join(one.get("text", "") for one in cells[5])
    # Who gets the folder goes on with what was written in the cell.
    assert "def control" in (folder / "out/controller.py").read_text()
    assert hairpin.open_campaign(folder / "out").robot.startswith("own-")


def test_a_bar_tells_how_far_a_job_is(outputs):
    _, cells = outputs
    bars = [html for html in htmls(cells[2]) if html.startswith("<progress")]
    # One display, brought up to date: what is left of it is its last state.
    assert len(bars) == 1 and bars[0].count("/") >= 1


def test_a_line_tells_it_elsewhere(capsys):
    show = hairpin.live()
    show("execute", 1, 4)
    show("execute", 4, 4)
    show("judge", 0, 2)
    assert capsys.readouterr().err == "\rexecute 1/4\rexecute 4/4\n\rjudge 0/2"
