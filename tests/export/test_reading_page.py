"""The page of a reading: what it says without JavaScript, what it plays with it, and that it stays small and closed."""

import base64
import re

import numpy as np
import pytest

from export.array.reading_page import (
    MOST_BINS,
    MOST_VALUES,
    bin_voltages,
    player_data,
    text_differences,
    write_reading_page,
)
from foundation.errors import InputError
from geometry.braille_cells import dot_offset_mm, raised_dots
from tests.axe import axe
from tests.cases import for_each

LETTERS = dict(zip("abcdefghijklmnopqrstuvwxyz ", "⠁⠃⠉⠙⠑⠋⠛⠓⠊⠚⠅⠇⠍⠝⠕⠏⠟⠗⠎⠞⠥⠧⠺⠭⠽⠵⠀", strict=True))
CENTRES = np.array([[x, y] for y in (-2.5, 0.0, 2.5) for x in (-1.25, 1.25)])
SPEED, RATE, CELL = 20.0, 500.0, 6.0
RATE_OF = {"value": 0.93, "low": 0.85, "high": 0.97}
SERIOUS = ("serious", "critical")


def reading_of(true, read, **changes):
    """What reading.json would say of a text."""
    return {
        "format": "softdot-reading/1",
        "text_true": true,
        "text_read": read,
        "cells_true": "".join(map(LETTERS.get, true)),
        "cells_read": "".join(LETTERS.get(one, one) for one in read),
        "characters": len(true),
        "character_accuracy": RATE_OF,
        "word_accuracy": {"value": 0.5, "low": 0.0945, "high": 0.9055},
        "words_per_minute": 40.0,
        "cells_per_s": SPEED / CELL,
        "decoder": "matched filter",
        "conditions": {"speed_mm_per_s": SPEED, "indentation_mm": 0.25, "worn_dots": 2, "noise_mV": 1.5},
        "confusion": [{"true": "⠁", "read": "⠃", "count": 3}, {"true": "⠁", "read": "⠁", "count": 9}],
        "missed_dots": dict(zip("123456", (0, 2, 0, 1, 0, 0), strict=True)),
        "false_dots": dict(zip("123456", (0, 3, 0, 0, 0, 0), strict=True)),
        "decoders": {
            "matched filter": {"character_accuracy": RATE_OF, "word_accuracy": RATE_OF},
            "threshold": {"character_accuracy": RATE_OF, "word_accuracy": {"value": None, "low": None, "high": None}},
        },
        "warnings": [],
        "kernel": {
            "labels": [f"segment-r{r}c{c}" for r in (1, 2, 3) for c in (1, 2)],
            "centres_mm": CENTRES.tolist(),
            "size_mm": [2.2, 2.2],
            "standard": "marburg-medium",
            "dot": {"base_diameter_mm": 1.6, "height_mm": 0.5},
        },
        **changes,
    }


def signals_of(true, read, rate=RATE):
    """A bump of voltage wherever a dot passes a segment, as wide as the segment."""
    cell_x = CELL * np.arange(len(true))
    dots = [
        (x - 1.25 + offset[0], offset[1] - 2.5)
        for x, letter in zip(cell_x, true, strict=True)
        for offset in (dot_offset_mm(dot, 2.5) for dot in raised_dots(LETTERS[letter]))
    ]
    place = np.array(dots).reshape(-1, 2)
    time = np.arange(0.0, (cell_x[-1] + 2 * CELL) / SPEED, 1.0 / rate)
    position = SPEED * time - CELL
    height = np.full(len(place), 0.5)
    height[::5] = 0.3
    voltage = np.zeros((len(time), len(CENTRES)))
    for (x, y), high in zip(place, height, strict=True):
        for segment, (across, along) in enumerate(CENTRES):
            if abs(y - along) < 0.1:
                first, last = np.searchsorted(position, [x - across - 4.0, x - across + 4.0])
                away = position[first:last] + across - x
                voltage[first:last, segment] += high * np.exp(-((away / 0.8) ** 2))
    return {
        "time_s": time,
        "voltage_V": voltage,
        "position_mm": position,
        "cell_x_mm": cell_x,
        "cell_true": np.array([LETTERS[one] for one in true]),
        "cell_read": np.array([LETTERS.get(one, one) for one in read]),
        "cell_likely": np.array([LETTERS[one] for one in true]),
        "cell_probability": np.linspace(0.5, 1.0, len(true)),
        "read_time_s": (cell_x + 1.5 * CELL) / SPEED,
        "dot_x_mm": place[:, 0],
        "dot_y_mm": place[:, 1],
        "dot_height_mm": height,
    }


TRUE, READ = "a soft pad reads braille", "a sofl pad reads briille"


def page_of(folder, reading, signals):
    write_reading_page(folder / "report.html", reading, signals)
    return (folder / "report.html").read_text("utf-8")


def test_the_result_is_told_without_javascript(tmp_path):
    page = page_of(tmp_path, reading_of(TRUE, READ), signals_of(TRUE, READ)).replace("&nbsp;", " ")
    assert "93.0 % of 24 characters" in page
    assert "95 % interval 85.0 to 97.0 %" in page
    assert f'<p class="text">{TRUE}</p>' in page
    assert 'a sof<span class="wrong">l<small><span class="aside"> was </span>(t)</small></span> pad' in page
    cells = re.findall(r"<span>(.)</span>", page)
    assert len(cells) == 22  # two of the 24 are wrong
    assert page.count('<span class="wrong">⠇<small>') == 1
    assert "speed mm/s" in page
    assert '<tr><td class="words cell">⠁</td><td class="words cell">⠃</td><td>3</td></tr>' in page
    assert '<td class="words cell">⠁</td><td class="words cell">⠁</td>' not in page  # that was no confusion
    assert "<td>0</td><td>3</td><td>0</td>" in page  # false dots
    unsure = page_of(tmp_path, reading_of(TRUE, "?" + READ[1:]), signals_of(TRUE, "?" + READ[1:]))
    assert '<span class="unsure">?<small><span class="aside"> not certain, most likely ⠁, was </span>(⠁)' in unsure
    assert unsure.count('class="unsure">') == 2  # and the text


def test_a_line_that_nobody_knows_has_a_page_without_rates(tmp_path):
    reading = reading_of(TRUE, "?" + TRUE[1:], text_true=None)
    rates = ("character_accuracy", "word_accuracy", "confusion", "missed_dots", "false_dots", "decoders", "characters")
    unknown = {key: value for key, value in reading.items() if key not in rates}
    page = page_of(tmp_path, unknown, signals_of(TRUE, "?" + TRUE[1:]))
    assert "<strong>24 cells</strong> were read, 23 of them certain. What the line says is not known." in page
    assert '?<small><span class="aside"> not certain, most likely </span>(⠁)</small>' in page
    assert "None" not in page
    assert "correctly" not in page


def test_words_of_a_user_are_text_and_nothing_is_loaded(tmp_path):
    bad = "<script>alert(1)</script>"
    reading = reading_of(TRUE, READ, text_true=bad, text_read=bad + "x", decoder=bad, warnings=[bad])
    reading["kernel"]["labels"][0] = "</script>" + bad
    reading["conditions"][bad] = bad
    page = page_of(tmp_path, reading, signals_of(TRUE, READ))
    assert page.count("<script") == 2
    assert page.count("</script>") == 2
    assert "alert(1)</script>" not in page
    assert re.findall(r"https?:|(?:src|href)=(?!.data:)|@import|url\(", page) == []
    assert "default-src 'none'" in page


def test_a_long_reading_stays_small_and_keeps_its_peaks(tmp_path):
    true = "abcdefghij" * 100
    signals = signals_of(true, true, rate=1000.0)
    signals["voltage_V"] += 1e-3 * np.random.default_rng(0).standard_normal(signals["voltage_V"].shape)
    signals["voltage_V"][123_457, 2] = 7.5
    assert len(signals["time_s"]) > 300_000
    page_of(tmp_path, reading_of(true, true), signals)
    assert (tmp_path / "report.html").stat().st_size < 5e6
    bins = bin_voltages(signals["time_s"], signals["position_mm"], signals["voltage_V"])
    assert bins.high_V.size + bins.low_V.size <= MOST_VALUES
    assert len(bins.time_s) <= MOST_BINS
    assert bins.high_V[:, 2].max() == 7.5
    np.testing.assert_array_equal(bins.low_V.min(axis=0), signals["voltage_V"].min(axis=0))
    k = bins.high_V[:, 2].argmax()
    assert bins.time_s[k] == pytest.approx(123.457, abs=bins.time_s[1] - bins.time_s[0])


def test_numbers_of_the_player_are_the_signals():
    signals = signals_of(TRUE, READ)
    data = player_data(reading_of(TRUE, READ), signals)
    low = np.frombuffer(base64.b64decode(data["low"]), "<i2").reshape(6, -1)
    assert data["high"] is None
    np.testing.assert_allclose(low.T * data["top"] / 32767, signals["voltage_V"], atol=data["top"] / 32767)
    assert data["labels"][1] == "r1c2"
    np.testing.assert_allclose(data["certain"], np.linspace(0.5, 1.0, len(TRUE)), atol=1e-4)
    assert data["dots"][0] == sorted(data["dots"][0])


def test_texts_of_different_length_are_compared():
    assert text_differences("Dot 12", "dot 2") == [("D", "d"), ("ot ", "ot "), ("1", ""), ("2", "2")]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"position_mm": np.zeros(3)}, "position_mm (3,): must be as time_s"),
        ({"voltage_V": np.zeros((5, 6))}, "voltage_V (5, 6): must be"),
        ({"dot_height_mm": np.full(57, np.nan)}, "dot_height_mm must be finite"),
    ],
)
def test_signals_that_do_not_fit_are_refused(tmp_path, change, said):
    with pytest.raises(InputError, match=re.escape(said)):
        write_reading_page(tmp_path / "report.html", reading_of(TRUE, READ), {**signals_of(TRUE, READ), **change})
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def page_at(browser, tmp_path):
    """Open the page from its file; whatever its console complains of fails the test."""
    write_reading_page(tmp_path / "report.html", reading_of(TRUE, READ), signals_of(TRUE, READ))
    contexts, wrong = [], []

    def opened(width=1366, **options):
        contexts.append(browser.new_context(viewport={"width": width, "height": 800}, **options))
        page = contexts[-1].new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda said: wrong.append(said.text) if said.type in ("error", "warning") else None)
        page.goto((tmp_path / "report.html").as_uri())
        return page

    yield opened
    for context in contexts:
        context.close()
    assert wrong == []


def seen(page):
    """Cells that can be seen."""
    return page.locator(".cells > span:not(.unread)").count()


@pytest.mark.browser
def test_it_plays_and_is_scrubbed_by_keys(page_at):
    page = page_at()
    assert seen(page) == 1  # it begins where the first cell is read
    page.locator(".line").focus()
    for _ in range(4):
        page.keyboard.press("ArrowRight")
    assert seen(page) == 5
    page.keyboard.press("ArrowLeft")
    assert seen(page) == 4
    assert "cells" in page.locator(".scrub").get_attribute("aria-valuetext")
    assert page.locator(".said").text_content() == "Cell 4 of 24: dots 1 3 5, probability 56.5 %"
    page.get_by_label("Sound").check()
    picture = page.locator(".line").screenshot()
    page.get_by_label("Speed").select_option("20")
    page.get_by_role("button", name="Play").click()
    page.get_by_role("button", name="Play").wait_for()  # it has come to the end
    assert seen(page) == len(TRUE)
    assert page.locator(".line").screenshot() != picture
    page.get_by_label("Time", exact=False).focus()
    page.keyboard.press("Home")
    assert seen(page) == 0


@pytest.mark.browser
def test_where_motion_is_not_wanted_it_goes_from_cell_to_cell(page_at):
    page = page_at(reduced_motion="reduce")
    page.locator(".line").focus()
    page.keyboard.press("Space")
    page.get_by_role("button", name="Pause").wait_for()
    page.locator(".cells > span").nth(2).and_(page.locator(":not(.unread)")).wait_for()
    shown = page.locator(".clock").inner_text()
    page.get_by_role("button", name="Pause").click()
    times = [f"{k * CELL / SPEED + 1.5 * CELL / SPEED:.2f} s" for k in range(len(TRUE))]
    assert any(shown.startswith(one) for one in times)


@pytest.mark.browser
@for_each(("scheme", "width"), [("light", 1366), ("dark", 1366), ("light", 400), ("dark", 400)])
def test_axe_finds_nothing_serious_in_a_reading(page_at, scheme, width):
    checker = axe()
    page = page_at(width, color_scheme=scheme, bypass_csp=True)
    page.locator(".line").focus()
    page.keyboard.press("End")
    found = checker.run(page).response["violations"]
    assert [(one["id"], one["nodes"][0]["html"][:120]) for one in found if one["impact"] in SERIOUS] == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.browser
def test_without_javascript_every_cell_is_seen(page_at):
    page = page_at(java_script_enabled=False)
    assert seen(page) == len(TRUE)
    assert not page.locator(".moving").is_visible()
    assert page.get_by_text("To play the reading your browser must run JavaScript").is_visible()
