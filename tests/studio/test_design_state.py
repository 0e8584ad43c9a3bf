"""Whatever happens in whatever order, the page is told nothing of a design that is not so of exactly this design."""

import hypothesis.strategies as st
import pytest
from hypothesis import settings
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from softdot.studio.design_state import DesignState
from softdot.studio.kept_designs import KeptDesigns
from softdot.studio.large_messages import large_messages

THICKNESS = st.sampled_from([0.4, 0.47, 0.52, -1.0, 0.0])
"""-1 is a mistake, and of 0 nothing is to be pressed."""
FINAL = ("accurate", "failed", "cancelled")


def text_of(thickness, comment, resistance):
    return f"thickness = {thickness}\nresistance = {resistance}\n# {comment}\n"


def parsed(text):
    thickness, resistance = (float(line.split("=")[1]) for line in text.splitlines()[:2])
    return thickness, resistance


def true_check(text):
    thickness, resistance = parsed(text)
    values = {"thickness": thickness, "resistance": resistance}
    if thickness < 0:
        return {"values": values, "stated": values, "mistakes": ["below 0"], "warnings": [], "remedies": [None]}
    pressed = f"hash of {thickness}" if thickness > 0 else None
    told = {"mistakes": [], "warnings": [], "remedies": [], "presses": ("coarse", "accurate"), "press_hash": pressed}
    return {"values": values, "stated": values, "cost": {"memory_GB": 1.0}, **told}


def true_press(text, quality):
    thickness, _ = parsed(text)
    answer = {"reaction_force_N": [thickness], "film_charge_pC": [thickness], "open_circuit_voltage_V": [thickness**2]}
    numbers = {"voltage": 10 * thickness, "solver": {"converged": True}, **answer}
    view = f"pressed {thickness} {quality}"
    return {"quality": quality, "numbers": numbers, "view": view, "history": f"{thickness} {quality}".encode()}


class Page:
    """What a tab has heard: contents that changed, then the state."""

    def __init__(self):
        self.versions, self.contents, self.state = {}, {}, None

    def hear(self, studio_state):
        for name, (version, content) in large_messages(studio_state).items():
            if self.versions.get(name) != version:
                self.versions[name], self.contents[name] = version, content()
        self.state = studio_state.told()
        self.contents = {name: one for name, one in self.contents.items() if name in self.state["artefacts"]}


class Studied(RuleBasedStateMachine):
    """A design under a hand, with processes that answer late, die, or are given up."""

    def __init__(self):
        super().__init__()
        self.state = DesignState(text_of(0.4, "a", 1))
        self.page = Page()
        self.draws, self.checks, self.circuits, self.jobs, self.kits = [], [], [], [], []
        self.family_asked, self.responses = [], []

    # The hand.

    @rule(thickness=THICKNESS, comment=st.sampled_from("ab"), resistance=st.sampled_from([1, 2]))
    def write(self, thickness, comment, resistance):
        self.state.document.write(text_of(thickness, comment, resistance))
        self.edited()

    @rule(resistance=st.sampled_from([1, 2, 3]))
    def turn_the_resistor(self, resistance):
        old = self.state.text.splitlines()
        self.state.document.write("\n".join([old[0], f"resistance = {resistance}", old[2], ""]))
        self.edited(circuit_alone=True)

    @rule(name=st.sampled_from(["undo", "redo"]))
    def step(self, name):
        getattr(self.state.document, name)()
        self.edited()

    def edited(self, **how):
        if self.state.is_edited:
            self.state.edited(**how)

    @precondition(lambda self: self.state.job is not None)
    @rule()
    def cancel(self):
        self.state.press_ends(self.state.job, "cancelled", "The press was cancelled.")

    @rule()
    def press_again(self):
        if self.state.job is not None:
            self.state.press_ends(self.state.job)
        self.state.again()

    @rule()
    def load_the_page_again(self):
        self.page = Page()

    # The processes.

    @precondition(lambda self: self.state.wants_parts and not self.draws)
    @rule()
    def draw(self):
        self.draws.append(self.state.present)

    @precondition(lambda self: self.draws)
    @rule(dies=st.booleans())
    def is_drawn(self, dies):
        origin = self.draws.pop()
        self.state.drawn(origin, None if dies else f"parts of {parsed(origin.text)[0]}")

    @precondition(lambda self: self.state.wants_check and not self.checks)
    @rule()
    def check(self):
        self.checks.append(self.state.present)

    @precondition(lambda self: self.checks)
    @rule(dies=st.booleans())
    def is_checked(self, dies):
        origin = self.checks.pop()
        if dies:
            self.state.check_fails(origin, "this machine did not answer")
        else:
            self.state.checked(origin.text, true_check(origin.text))

    @precondition(lambda self: self.state.wants_circuit and not self.circuits)
    @rule()
    def ask_the_amplifier(self):
        self.circuits.append((self.state.present, self.state.shown_press))

    @precondition(lambda self: self.circuits)
    @rule()
    def the_amplifier_answers(self):
        origin, press = self.circuits.pop()
        volts = parsed(origin.text)[1] * press.found["numbers"]["voltage"]
        content = {"history": press.found["history"], "found": {"readout_voltage_V": volts}}
        self.state.made("circuit", origin, content)

    @precondition(lambda self: self.state.job and self.state.check)
    @rule()
    def give_up_the_press_of_another_design(self):
        if self.state.job.press_hash != self.state.present.press_hash:
            self.state.press_ends(self.state.job)

    @precondition(lambda self: self.state.wants_press and self.state.job is None)
    @rule()
    def press(self):
        tasks = list(self.state.presses_to_do)
        self.jobs.append((self.state.press_begins(), tasks))

    @precondition(lambda self: self.jobs)
    @rule(number=st.integers(0, 9), ends=st.sampled_from(["well", "well", "well", "refused"]))
    def a_press_answers(self, number, ends):
        """Also one that was given up."""
        job, tasks = self.jobs[number % len(self.jobs)]
        self.state.press_goes_on(job, {"stage": "press", "done": 1, "count": 3, "left_s": 1.0})
        if ends == "refused":
            self.state.press_ends(job, "failed", "not converged")
            tasks.clear()
        else:
            self.state.pressed(job, true_press(job.text, tasks.pop(0)), complete=not tasks)
            if not tasks:
                self.state.press_ends(job)
        self.jobs = [one for one in self.jobs if one[1]]

    @precondition(lambda self: self.state.wants_exponents)
    @rule()
    def exponents_are_known(self):
        self.state.estimator.add_exponents(self.state.present.press_hash, {"thickness": (1.0, 1.0, 2.0)})

    @precondition(lambda self: self.state.wants_family and not self.family_asked)
    @rule()
    def ask_the_family(self):
        self.family_asked.append(self.state.text)

    @precondition(lambda self: self.family_asked)
    @rule(knows=st.booleans())
    def the_family_answers(self, knows):
        text = self.family_asked.pop()
        thickness = parsed(text)[0]
        values = {"force_N": thickness, "charge_pC": thickness, "voltage_V": thickness**2}
        found = {name: {"value": value, "error": 0.1} for name, value in values.items()} | {"by": "family"}
        self.state.answered_by_family(text, found if knows else None)

    @precondition(lambda self: (self.state.check or {}).get("press_hash"))
    @rule()
    def follow_the_thickness(self):
        self.responses.append(self.state.present)

    @precondition(lambda self: self.responses)
    @rule(is_last=st.booleans())
    def a_point_is_pressed(self, is_last):
        """Also of a design before; more points may come."""
        origin = self.responses.pop() if is_last else self.responses[-1]
        found = {"key": "thickness", "range": [0.4, 0.52], "points": [], "resistance": parsed(origin.text)[1]}
        self.state.made("response", origin, {"result": found})

    @precondition(lambda self: self.state.check and not self.state.check["mistakes"])
    @rule(thickness=st.sampled_from([0.47, 0.52]))
    def move_to_a_goal(self, thickness):
        self.state.document.set(["thickness"], thickness)
        self.edited()
        self.state.made("goal", self.state.present, {"result": {"thickness": thickness}})

    @rule()
    def ask_for_a_kit(self):
        self.kits.append(self.state.present)

    @precondition(lambda self: self.kits)
    @rule()
    def the_kit_is_made(self):
        origin = self.kits.pop(0)
        self.state.made("kit", origin, {"result": parsed(origin.text)})

    @invariant()
    def nothing_is_told_that_is_not_so(self):
        self.page.hear(self.state)
        self.what_is_called_current_is_of_this_design()
        self.the_amplifier_stands_beside_its_own_press()
        self.the_phase_is_what_the_sentence_says()
        self.nothing_is_stuck()
        self.a_page_that_is_loaded_again_is_told_the_same()

    def what_is_called_current_is_of_this_design(self):
        page, text = self.page, self.state.text
        thickness, resistance = parsed(text)
        true = {
            "parts": lambda one: one["view"] == f"parts of {thickness}",
            "view": lambda one: one["view"].startswith(f"pressed {thickness} "),
            "curves": lambda one: one["curves"][-1]["numbers"]["voltage"] == 10 * thickness,
            "circuit": lambda one: one["found"]["readout_voltage_V"] == 10 * thickness * resistance,
            "kit": lambda one: one["result"] == (thickness, resistance),
            "response": lambda one: one["result"]["resistance"] == resistance,
            "goal": lambda one: one["result"]["thickness"] == thickness,
        }
        for name, content in page.contents.items():
            assert not page.state["artefacts"][name]["current"] or true[name](content)
            assert content["revision"] == page.state["artefacts"][name]["revision"]
        for one in page.contents.get("response", {"result": {"line": []}})["result"]["line"]:
            assert one["voltage_V"]["value"] == pytest.approx(one["value"] ** 2)
        assert page.state["design"]["text"] == text

    def the_amplifier_stands_beside_its_own_press(self):
        _, resistance = parsed(self.state.text)
        if not self.state.curves():
            return
        reading, now = self.state.curves()[-1]["numbers"], self.page.state["artefacts"]["numbers"]["current"]
        if reading["readout_voltage_V"] is not None and now:
            assert reading["readout_voltage_V"] == resistance * reading["voltage"]

    def the_phase_is_what_the_sentence_says(self):
        told, now = self.page.state, true_check(self.state.text)
        phase, current = told["phase"], {name for name, one in told["artefacts"].items() if one["current"]}
        if told["design"]["is_checked"]:
            assert told["design"]["mistakes"] == now["mistakes"]
        if phase in ("coarse", "accurate"):
            assert {"numbers", "curves", "view"} <= current
            assert self.page.contents["curves"]["curves"][-1]["quality"] == phase
            assert self.page.contents["view"]["quality"] == phase
        if told["estimate"] is not None:
            thickness = parsed(self.state.text)[0]
            assert phase not in ("coarse", "accurate")
            assert told["estimate"]["voltage_V"]["value"] == pytest.approx(thickness**2)
            assert told["estimate"].get("by") != "family" or told["is_of_family"]
        assert (phase == "estimated") <= (told["estimate"] is not None)
        assert ("by the family" in told["said"]) <= (phase == "estimated" and told["is_of_family"])
        if phase == "drawn":
            assert "parts" in current
        if phase == "checked" and not told["busy"]:
            assert told["design"]["is_checked"]
        if "as softdot run does" in told["said"]:
            assert phase == "accurate"
        if "Pressing" in told["said"] or "Pressed: " in told["said"]:
            assert told["busy"]
            assert self.state.job.press_hash == now["press_hash"] or self.state.job.text == self.state.text
        assert ("has a mistake" in told["said"]) <= bool(now["mistakes"])

    def nothing_is_stuck(self):
        """Where nothing is under way and nothing is wanted, an answer or a button is there."""
        state, told = self.state, self.page.state
        if state.job or state.wants_check or state.wants_press:
            return
        is_answered = told["phase"] in FINAL or told["design"]["mistakes"] or state.present.press_hash is None
        assert is_answered
        assert told["again"] == (told["phase"] in FINAL and not (state.check or {}).get("mistakes"))

    def a_page_that_is_loaded_again_is_told_the_same(self):
        again = Page()
        again.hear(self.state)
        assert again.state == self.page.state
        assert again.contents == self.page.contents


TestStudied = Studied.TestCase
TestStudied.settings = settings(max_examples=60, stateful_step_count=40, deadline=None)


def test_undo_while_it_presses_leads_back_to_a_press():
    """0.47, then -1 while it presses, then 0.47 again: it is pressed again, and no mistake is told."""
    state = DesignState(text_of(0.47, "a", 1))
    state.checked(state.text, true_check(state.text))
    first = state.press_begins()
    state.document.write(text_of(-1.0, "a", 1))
    state.edited()
    state.checked(state.text, true_check(state.text))
    state.press_ends(first)
    assert "has a mistake" in state.told()["said"]
    state.document.undo()
    state.edited()
    assert state.wants_press
    assert "mistake" not in state.told()["said"]


def pressed(state, thickness):
    """Write, check and press."""
    state.document.write(text_of(thickness, "a", 1))
    state.edited()
    state.checked(state.text, true_check(state.text))
    job = state.press_begins()
    state.pressed(job, true_press(state.text, "accurate"), complete=True)
    state.press_ends(job)


def test_an_accurate_press_is_there_at_once_where_its_design_comes_back():
    state = DesignState(text_of(0.47, "a", 1))
    for thickness in (0.47, 0.52):
        pressed(state, thickness)
    state.document.undo()
    state.edited()
    assert (state.phase, state.wants_press) == ("accurate", False)
    assert state.curves()[-1]["numbers"]["voltage"] == 10 * 0.47


def test_a_kept_design_has_the_numbers_of_its_own_press():
    state, kept = DesignState(text_of(0.47, "a", 1)), KeptDesigns()
    state.checked(state.text, true_check(state.text))
    kept.keep(state, "thin")
    job = state.press_begins()
    state.document.write(text_of(0.52, "a", 1))
    state.edited()
    state.pressed(job, true_press(job.text, "coarse"), complete=False)
    kept.renew(state)
    assert kept.message()[1]()["designs"][0]["numbers"]["voltage"] == 10 * 0.47


def test_curves_are_told_again_where_only_their_order_has_changed():
    """Of three presses the first one and the last come back: the curves between have changed places."""
    state, page = DesignState(text_of(0.4, "b", 1)), Page()
    for thickness in (0.4, 0.47, 0.52):
        pressed(state, thickness)
    page.hear(state)
    for thickness in (0.4, 0.52):
        state.document.write(text_of(thickness, "a", 1))
        state.edited()
    page.hear(state)
    assert [one["numbers"]["voltage"] for one in page.contents["curves"]["curves"]] == pytest.approx([4.7, 4.0, 5.2])


def test_a_view_that_is_pressed_again_is_of_the_design_that_asked_for_it():
    state, page = DesignState(text_of(0.4, "b", 1)), Page()
    pressed(state, 0.4)
    page.hear(state)
    state.document.write(text_of(0.4, "b", 1))
    state.edited()
    pressed(state, 0.4)
    page.hear(state)
    assert page.contents["view"]["revision"] == page.state["artefacts"]["view"]["revision"]
