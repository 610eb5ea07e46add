# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's verdicts, on made-up numbers: they follow from what was measured, and a missed bound shows."""

import pytest


@pytest.fixture(scope="module")
def report():
    from benchmarks.cost import cost_report

    return cost_report


@pytest.fixture
def measured(report):
    """Ray tracing adds 10 s; the stages take 1.3 s, 0.5 s of it on the GPU; ticking adds 1.5 s; 300 and 700 MB."""
    stages = {"write passes": 0.7, **dict.fromkeys(report.GPU_STAGES, 0.1), "hand back": 0.1}

    def frames(*walls):
        return [report.Frame(wall, 2 * wall) for wall in walls]

    return report.Measured(
        title="box.blend",
        size=(1280, 720),
        machine="a machine",
        command="bench.py",
        commit="0123456",
        radius=16,
        first=stages,
        stages=[stages] * 3,
        plain=frames(3, 9, 3),
        lit=frames(4.5, 10.5, 4.4),
        samples=16,
        untraced=frames(30, 50, 30),
        traced=frames(40, 90, 39),
        memory={"plain": 2000, "compositor": 2100, "draft": 2300, "paper": 2700},
        memory_size=(1920, 1080),
        presets={name: report.Preset("Paper", "Half", 64, stages, 4.5) for name in ("draft", "paper")},
    )


def kept(report, measured):
    return [holds for _, holds in report.verdicts(measured)]


def test_pairs_are_compared_with_each_other(measured):
    """A busy machine slows both frames of a pair: medians of each alone would be misled by it."""
    assert measured.ray_tracing == pytest.approx(10)
    assert measured.whole == pytest.approx(1.5)


def test_the_larger_of_stages_and_frames_counts(measured):
    measured.lit = measured.plain
    assert measured.whole == pytest.approx(1.3)


def test_all_kept(report, measured):
    assert kept(report, measured) == [True] * 4
    assert "MISSED" not in report.page(measured)


@pytest.mark.parametrize("missed", range(4))
def test_each_bound_can_be_missed(report, measured, missed):
    if missed == 0:
        measured.lit = [report.Frame(frame.wall + 10, 0) for frame in measured.plain]
    elif missed == 1:
        measured.stages = [stages | {"gather": 0.7} for stages in measured.stages]
    else:
        measured.memory[("draft", "paper")[missed - 2]] = 2701
    assert kept(report, measured) == [index != missed for index in range(4)]
    assert report.page(measured).count("MISSED") == 1


def test_several_views_may_take_more_memory(report, measured):
    measured.presets["draft"] = of_views(report, measured, 0.1)
    for more, keeps in ((1500, True), (1501, False)):
        measured.memory["draft"] = 2000 + more
        assert kept(report, measured) == [True, True, True, keeps, True]


def of_views(report, measured, each):
    """Draft with Radiosity, whose five stages take so long."""
    stages = {"place views": 1, "EEVEE, views": 5, **dict.fromkeys(report.VIEWS_STAGES, each)}
    return measured.presets["draft"]._replace(method="Radiosity", stages=stages)


def test_several_views_may_take_some_samples_of_eevee(report, measured):
    """Sixteen samples take 27 s more than one: 1.8 s for each of fifteen."""
    for each, keeps in ((0.35, True), (0.37, False)):
        measured.presets["draft"] = of_views(report, measured, each)
        assert kept(report, measured) == [True, True, keeps, True, True]
    measured.untraced = measured.plain
    assert kept(report, measured)[2] is False


def test_ray_tracing_that_costs_nothing_keeps_no_promise(report, measured):
    measured.traced = measured.untraced
    assert kept(report, measured)[:2] == [False, False]


def test_page_holds_every_number(report, measured):
    page = report.page(measured)
    for row in (
        "| gather | 0.100 | 0.100 | 0.100 to 0.100 |",
        "| **all stages** | 1.300 | 1.300 | 1.300 to 1.300 |",
        "| EEVEE, 16 samples | 30.00 | 30.00 to 50.00 | 60.00 |",
        "| Paper | Paper | Half | 64 | 0.10 | 1.30 | 4.50 |",
        "| **what ray tracing adds**, pair by pair | 10.00 | 9.00 to 40.00 | 20.00 |",
        "| EEVEE and Afterlight, Paper | 2700 | +700 |",
    ):
        assert row in page
