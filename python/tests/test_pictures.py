"""Content of pictures."""

import matplotlib

matplotlib.use("agg")

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.collections import LineCollection

import moorline


@pytest.fixture(autouse=True)
def closed():
    yield
    pyplot.close("all")


def drawn(ax):
    return [collection for collection in ax.collections if isinstance(collection, LineCollection)]


def test_a_side_view_has_every_line_coloured_by_its_tension(semi):
    ax = moorline.plot(semi)
    lines = drawn(ax)
    assert len(lines) == 3
    tension = semi.statics().lines[0].profile.tension
    assert np.allclose(lines[0].get_array(), 0.5e-3 * (tension[:-1] + tension[1:]))
    assert "three chains on a vessel" in ax.get_title()


def test_a_simulation_is_drawn_where_it_is_now(semi):
    simulation = moorline.Simulation(semi)
    for _ in range(20):
        simulation.advance({"platform.x": 0.5}, 0.1)
    ax = moorline.plot(simulation, across="x")
    end = drawn(ax)[0].get_segments()[-1][-1]
    assert np.allclose(end, [10.5, -8.0], atol=1e-9)  # points on a vessel are placed in its axes
    assert "t = 2.00 s" in ax.get_title()


def test_a_view_in_space_draws_what_the_side_view_draws(semi, chain):
    for scene in (semi, chain):
        assert len(drawn(moorline.plot3d(scene))) == len(scene.lines)


def test_an_animation_has_a_picture_for_every_shape(semi, tmp_path):
    table = moorline.run(semi, duration=1.0, shapes=0.2)
    moorline.animate(table).save(tmp_path / "side.gif")
    moorline.animate(table, space=True).save(tmp_path / "space.gif")
    from PIL import Image

    assert Image.open(tmp_path / "side.gif").n_frames == Image.open(tmp_path / "space.gif").n_frames == 6


def test_what_cannot_be_drawn_is_refused(chain):
    with pytest.raises(moorline.InputError, match="shapes="):
        moorline.animate(moorline.run(chain, duration=0.1))
    with pytest.raises(moorline.InputError, match="cannot be drawn"):
        moorline.plot("chain.toml")
    with pytest.raises(moorline.InputError, match="horizontal axis"):
        moorline.plot(chain, across="z")
