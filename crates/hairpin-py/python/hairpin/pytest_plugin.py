"""Campaigns in pytest: ``pytest --hairpin scenario.toml`` has one test a case, the fixture ``hairpin_stress`` stresses a
controller and fails with its shrunk worst case."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    import hairpin

DEMO = "demo-quadrotor"
# Of a run of pytest: the campaign of each scenario, or why there is none.
_CAMPAIGNS: pytest.StashKey[dict[Path, hairpin.Campaign | str]] = pytest.StashKey()
NOTHING_ASKED = 'nothing is asked of it: spec = "none"'


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("hairpin", "stressful trajectories as tests")
    group.addoption(
        "--hairpin",
        action="append",
        default=[],
        metavar="SCENARIO.toml",
        help="run a campaign; each of its cases is a test (may be given several times)",
    )
    group.addoption("--hairpin-out", metavar="DIR", help="folder of campaign folders; in pytest's cache if not given")
    group.addoption("--hairpin-set", action="append", default=[], metavar="KEY=VALUE", help="another value of a scenario's key")
    group.addoption("--hairpin-executor", metavar="COMMAND", help="program that carries missions out")
    parser.addini("hairpin_scenario", "scenario that the fixture hairpin_stress takes where none is given", default=DEMO)


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    scenarios = [Path(name) for name in config.getoption("--hairpin")]
    config.stash[_CAMPAIGNS] = {}
    for pair in config.getoption("--hairpin-set"):
        _split(pair)
    for scenario in scenarios:
        if not scenario.is_file():
            raise pytest.UsageError(
                f"--hairpin {scenario}: must be a scenario file that is there (hairpin new quadrotor writes one)"
            )
    if scenarios:
        asked = config.args_source is pytest.Config.ArgsSource.ARGS
        given = config.args if asked else []
        # `scenario.toml::0002` is that case of it alone.
        known = {Path(word.partition("::")[0]).resolve() for word in given}
        config.args = [*given, *(str(scenario) for scenario in scenarios if scenario.resolve() not in known)]


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Of pytest-xdist: campaigns are made before the first worker begins, and workers read them."""
    made: dict[str, dict[str, Any]] = {}
    for scenario in _scenarios(node.config):
        found = _made(node.config, scenario)
        if isinstance(found, str):
            made[str(scenario)] = {"trouble": found}
        else:
            made[str(scenario)] = {"folder": str(found.folder.resolve()), "verdict": found.verdict, "exit_code": found.exit_code}
    node.workerinput["hairpin"] = made


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    if file_path.resolve() in _scenarios(parent.config):
        return ScenarioFile.from_parent(parent, path=file_path)
    return None


class ScenarioFile(pytest.File):
    """A scenario; its tests are the cases of its campaign, which is run where they are collected."""

    def collect(self) -> Iterator[pytest.Item]:
        campaign = _made(self.config, self.path.resolve())
        if isinstance(campaign, str):
            raise self.CollectError(campaign)
        for case in campaign:
            yield CaseItem.from_parent(self, name=case.id, campaign=campaign, case=case)
        if campaign.exit_code and all(case.status in ("pass", "unjudged") for case in campaign):
            # The campaign's own verdict, where no case has it: nothing feasible, too few cases for the share that is asked.
            yield CaseItem.from_parent(self, name="verdict", campaign=campaign, case=None)


class CaseItem(pytest.Item):
    """A case as a test."""

    def __init__(self, *, campaign: hairpin.Campaign, case: hairpin.Case | None, **rest: Any) -> None:
        super().__init__(**rest)
        self.campaign, self.case = campaign, case

    def runtest(self) -> None:
        case = self.case
        if case is None:
            raise CaseFailed(str(self.campaign.verdict))
        if case.status == "unjudged":
            pytest.skip(NOTHING_ASKED)
        if case.status != "pass":
            raise CaseFailed(_told(self.campaign, case))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        if isinstance(excinfo.value, CaseFailed):
            return str(excinfo.value)
        return super().repr_failure(excinfo)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        return self.path, None, f"hairpin: {self.name}"


class CaseFailed(AssertionError):
    """A case is not within its spec, or was not carried out."""


def _told(campaign: hairpin.Campaign, case: hairpin.Case) -> str:
    """Both numbers, and how to have it again."""
    lines = [f"case {case.id}: {violation.told}" for violation in case.violations] or [f"case {case.id}: {case.status}"]
    if case.message:
        lines.append(case.message)
    repro = campaign.folder / "repro" / f"{case.id}.json"
    again = f"hairpin replay {repro}" if repro.is_file() else f"hairpin replay {campaign.folder} --case {case.number}"
    if case.violations:
        lines += [f"again:   {again}", f"shorter: hairpin shrink {campaign.folder} --case {case.number}"]
    report = campaign.folder / "report.html"
    if report.is_file():
        lines.append(f"report:  {report}")
    return "\n".join(lines)


def _scenarios(config: pytest.Config) -> dict[Path, Path]:
    """Each once, whatever it is called: by the file that it is, as it was first given, which is where its own files are."""
    found: dict[Path, Path] = {}
    for name in config.getoption("--hairpin"):
        found.setdefault(Path(name).resolve(), Path(os.path.abspath(name)))
    return found


def _made(config: pytest.Config, scenario: Path) -> hairpin.Campaign | str:
    """The campaign of a scenario, made where nobody has made it yet; or why there is none."""
    import hairpin
    from hairpin._jobs import _stress_with_texts

    made = config.stash[_CAMPAIGNS]
    if scenario in made:
        return made[scenario]
    found: hairpin.Campaign | str
    elsewhere = getattr(config, "workerinput", {}).get("hairpin", {}).get(str(scenario))
    if elsewhere is not None:
        found = elsewhere.get("trouble") or hairpin.Campaign(elsewhere["folder"], said=elsewhere)
    else:
        place = config.getoption("--hairpin-out")
        folder = Path(place) if place else Path(config.cache.mkdir("hairpin")) if config.cache else Path(".hairpin")
        folder.mkdir(parents=True, exist_ok=True)
        given = _scenarios(config)
        out = folder / _names(list(given.values()), None if place else config.rootpath)[given[scenario]]
        values = dict(_split(pair) for pair in config.getoption("--hairpin-set"))
        try:
            found = _stress_with_texts(given[scenario], out=out, texts=values, executor=config.getoption("--hairpin-executor"))
        except (hairpin.InputError, hairpin.ExecutorError) as error:
            found = str(error)
    made[scenario] = found
    return found


def _names(scenarios: list[Path], root: Path | None = None) -> dict[Path, str]:
    """A campaign folder's name for each: the file's own, with as many of its folders' before it as tell it from the others. From
    `root` on all of them: what lies there outlives a run, whose scenarios are not those of the next."""
    names: dict[Path, str] = {}
    for scenario in scenarios:
        within = scenario.relative_to(root) if root is not None and scenario.is_relative_to(root) else scenario
        parts = [*(part for part in within.parts[:-1] if part != within.anchor), within.stem]
        others = [(*other.parts[:-1], other.stem) for other in scenarios if other != scenario]
        count = len(parts) if root is not None else 1
        while count < len(parts) and any(_alike(other[-count:], parts[-count:]) for other in others):
            count += 1
        name = whole = "-".join(parts[-count:])
        number = 2
        while any(_alike([name], [taken]) for taken in names.values()):
            name, number = f"{whole}-{number}", number + 1
        names[scenario] = name
    return names


def _alike(a: Sequence[str], b: Sequence[str]) -> bool:
    """Whether a disk that does not tell capitals from small letters takes one for the other."""
    return [part.casefold() for part in a] == [part.casefold() for part in b]


def _split(pair: str) -> tuple[str, str]:
    key, equals, value = pair.partition("=")
    if not equals:
        raise pytest.UsageError(f"--hairpin-set {pair}: must be KEY=VALUE")
    return key.strip(), value.strip()


@pytest.fixture
def hairpin_stress(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[..., hairpin.Campaign]:
    """Stresses a controller, and fails with the shrunk worst case if one of its runs violates the spec.

    ``hairpin_stress(controller, scenario=None, *, shrink_budget=50, **settings)``: what steers, a scenario (that of the ini key
    ``hairpin_scenario`` if not given), and settings of :func:`hairpin.stress`. Gives the campaign. Where nothing is asked of its
    runs (``spec = "none"``) the test is skipped. Each call has a folder of its own, unless ``out`` names one.
    """
    calls = itertools.count(1)

    def run(controller: Any = None, scenario: Any = None, *, shrink_budget: int = 50, **settings: Any) -> hairpin.Campaign:
        import hairpin

        __tracebackhide__ = True
        source = scenario if scenario is not None else request.config.getini("hairpin_scenario")
        number = next(calls)
        own = tmp_path / ("campaign" if number == 1 else f"campaign-{number}")
        campaign = hairpin.stress(source, controller=controller, out=settings.pop("out", own), **settings)
        if campaign.exit_code == 0:
            if len(campaign) and all(case.status == "unjudged" for case in campaign):
                pytest.skip(NOTHING_ASKED)
            return campaign
        lines = [str(campaign.verdict)]
        worst = next(iter(campaign.failing), None)
        if worst is not None:
            try:
                shrunk = campaign.shrink(worst, budget=shrink_budget)
            except Exception as error:  # The campaign has its verdict, whatever became of a smaller case.
                lines += [_told(campaign, worst), f"not shrunk: {type(error).__name__}: {error}"]
            else:
                points = "\n".join(f"  {x:.3f}, {y:.3f}, {z:.3f}" for x, y, z in shrunk.waypoints_m)
                lines += [f"case {shrunk.case}: {shrunk}", points, f"again: hairpin replay {shrunk.repro}"]
        pytest.fail("\n".join(lines), pytrace=False)

    return run
