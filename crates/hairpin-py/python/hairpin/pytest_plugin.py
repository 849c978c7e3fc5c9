"""Campaigns in pytest: ``pytest --hairpin scenario.toml`` has one test a case, the fixture ``hairpin_stress`` stresses a
controller and fails with its shrunk worst case."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    import hairpin

DEMO = "demo-quadrotor"


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
    for scenario in scenarios:
        if not scenario.is_file():
            raise pytest.UsageError(
                f"--hairpin {scenario}: must be a scenario file that is there (hairpin new quadrotor writes one)"
            )
    if scenarios:
        asked = config.args_source is pytest.Config.ArgsSource.ARGS
        named = [str(scenario) for scenario in scenarios]
        config.args = [*(config.args if asked else []), *(name for name in named if name not in config.args or not asked)]


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    scenarios = [Path(name).resolve() for name in parent.config.getoption("--hairpin")]
    if file_path.resolve() in scenarios:
        return ScenarioFile.from_parent(parent, path=file_path)
    return None


class ScenarioFile(pytest.File):
    """A scenario; its tests are the cases of its campaign, which is run where they are collected."""

    def collect(self) -> Iterator[pytest.Item]:
        import hairpin

        config = self.config
        place = config.getoption("--hairpin-out")
        folder = Path(place) if place else Path(config.cache.mkdir("hairpin")) if config.cache else Path(".hairpin")
        folder.mkdir(parents=True, exist_ok=True)
        values = dict(_split(pair) for pair in config.getoption("--hairpin-set"))
        from hairpin._jobs import _stress_with_texts

        try:
            campaign = _stress_with_texts(
                self.path, out=folder / self.path.stem, texts=values, executor=config.getoption("--hairpin-executor")
            )
        except (hairpin.InputError, hairpin.ExecutorError) as error:
            raise self.CollectError(str(error)) from None
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
            pytest.skip('nothing is asked of it: spec = "none"')
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


def _split(pair: str) -> tuple[str, str]:
    key, equals, value = pair.partition("=")
    if not equals:
        raise pytest.UsageError(f"--hairpin-set {pair}: must be KEY=VALUE")
    return key.strip(), value.strip()


@pytest.fixture
def hairpin_stress(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[..., hairpin.Campaign]:
    """Stresses a controller, and fails with the shrunk worst case if one of its runs violates the spec.

    ``hairpin_stress(controller, scenario=None, *, shrink_budget=50, **settings)``: what steers, a scenario (that of the ini key
    ``hairpin_scenario`` if not given), and settings of :func:`hairpin.stress`. Gives the campaign.
    """

    def run(controller: Any = None, scenario: Any = None, *, shrink_budget: int = 50, **settings: Any) -> hairpin.Campaign:
        import hairpin

        __tracebackhide__ = True
        source = scenario if scenario is not None else request.config.getini("hairpin_scenario")
        campaign = hairpin.stress(source, controller=controller, out=settings.pop("out", tmp_path / "campaign"), **settings)
        if campaign.exit_code == 0:
            return campaign
        lines = [str(campaign.verdict)]
        worst = next(iter(campaign.failing), None)
        if worst is not None:
            shrunk = campaign.shrink(worst, budget=shrink_budget)
            points = "\n".join(f"  {x:.3f}, {y:.3f}, {z:.3f}" for x, y, z in shrunk.waypoints_m)
            lines += [f"case {shrunk.case}: {shrunk}", points, f"again: hairpin replay {shrunk.repro}"]
        pytest.fail("\n".join(lines), pytrace=False)

    return run
