"""What is known of one design and what of it belongs to its present text: all that the page is told follows from it.

Events (edited, checked, drawn, pressed, ...) bring facts, each with the design from which it was made. Nothing that can
be derived is stored: the phase, its sentence, what is current and what is still wanted are asked for
when they are told. So an answer that comes late is one of an older design, whatever happened meanwhile.
"""

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from softdot.studio.comparison import design_words
from softdot.studio.design_facts import Artefact, Json, KnownPress, Origin, Phase, Stop
from softdot.studio.document import Document
from softdot.studio.estimate import Estimator, same_but_for
from softdot.studio.phase_words import phase_words

MOST_PRESSES = 6
"""Presses that are kept: shown as curves, and at once again where the design comes back."""
MOST_CHECKS = 64
OF_RECORDING = frozenset({"recording", "verdict", "plate"})
"""Artefacts that are of no design."""


class DesignState:
    """One design. All methods are quick and pure: nothing is read, started or sent here."""

    def __init__(self, text: str) -> None:
        self.document = Document(text)
        self.revision = 0
        self._machine: dict[str, str] = {}
        self.saved: str | None = None
        self.progress: Json | None = None
        self.tasks: dict[str, Json] = {}
        self.estimator = Estimator()
        self._checks: OrderedDict[str, Json] = OrderedDict()
        self._by_family: OrderedDict[str, Json | None] = OrderedDict()
        self._last_check: tuple[int, Json] = (0, {})
        self._presses: OrderedDict[str, KnownPress] = OrderedDict()
        self._made: dict[str, Artefact] = {}
        self._drawn: str | None = None
        self._undrawn: str | None = None
        self._stop: Stop | None = None
        self._job: Origin | None = None
        self._count = 0
        self._text_before = text

    # Facts of the present design.

    @property
    def text(self) -> str:
        """Of the design."""
        return self.document.text

    @property
    def check(self) -> Json | None:
        """What a check said of exactly this text."""
        return self._checks.get(self.text)

    @property
    def present(self) -> Origin:
        """The design as it is now."""
        found = self.check or {}
        return Origin(self.revision, self.text, found.get("values"), found.get("press_hash"))

    @property
    def press(self) -> KnownPress | None:
        """The press of exactly this design."""
        return self._presses.get(self.present.press_hash or "")

    @property
    def shown_press(self) -> KnownPress | None:
        """That of this design; else the last one, which is of another."""
        return self.press or next(reversed(self._presses.values()), None)

    @property
    def job(self) -> Origin | None:
        """The design that is being pressed."""
        return self._job

    @property
    def stop(self) -> Stop | None:
        """Why this design was not checked or pressed."""
        found = self._stop
        return found if found is not None and self._is_same(found.origin, self.present) else None

    @property
    def is_edited(self) -> bool:
        """Whether the text is another one than the last event knew."""
        return self.text != self._text_before

    # What is still to be done for it.

    @property
    def wants_parts(self) -> bool:
        """Whether its parts are to be drawn."""
        return self.text not in (self._drawn, self._undrawn)

    @property
    def wants_check(self) -> bool:
        """Whether it is to be checked."""
        return self.check is None and self.stop is None

    @property
    def wants_press(self) -> bool:
        """Whether it is to be pressed, or goes on to be."""
        if self.present.press_hash is None or self.stop is not None:
            return False
        return self.press is None or not self.press.complete

    @property
    def wants_circuit(self) -> bool:
        """Whether its amplifier is to answer from the charge of its press."""
        press, made = self.shown_press, self._made.get("circuit")
        if press is None or press.quality == "array" or (self.check or {}).get("mistakes"):
            return False
        return made is None or made.origin.text != self.text or made.content["history"] != press.found["history"]

    @property
    def wants_exponents(self) -> bool:
        """Whether designs beside it are to be estimated from its press, which is done."""
        press = self.press
        done = press is not None and press.complete and press.answer is not None and self._job is None
        return done and not self.estimator.knows(self.present.press_hash or "")

    @property
    def wants_family(self) -> bool:
        """Whether a family is to be asked for this design, until its press is there."""
        return self.press is None and self.text not in self._by_family

    @property
    def is_of_family(self) -> bool:
        """Whether a family has answered for this design."""
        return self._by_family.get(self.text) is not None

    @property
    def presses_to_do(self) -> Sequence[str]:
        """Tasks of its press, without those that are done."""
        tasks: Sequence[str] = (self.check or {}).get("presses", ())
        return tasks[1:] if self.press is not None and len(tasks) > 1 else tasks

    @property
    def need_GB(self) -> float:
        """Memory of its accurate press; 0 where it is not known."""
        need: float = ((self.check or {}).get("cost") or {}).get("memory_GB", 0.0)
        return need

    # Events.

    def edited(self, circuit_alone: bool = False) -> None:
        """The text is another one. circuit_alone : but for the amplifier the design is the same, so its parts are."""
        if circuit_alone and self._drawn == self._text_before:
            self._drawn = self.text
        self.revision, self._text_before = self.revision + 1, self.text
        self._settle()

    def machine_says(self, of: str, said: str | None) -> None:
        """Why something takes longer than it should, for a reason that is not the design's; None once it is over."""
        self._machine.pop(of, None)
        if said is not None:
            self._machine[of] = said

    def checked(self, text: str, found: Json) -> None:
        """A check has answered, of this text or of one before."""
        _remember(self._checks, text, found)
        self._settle()

    def answered_by_family(self, text: str, found: Json | None) -> None:
        """What a family says of this text; None where it is none of the family."""
        _remember(self._by_family, text, found)

    def drawn(self, origin: Origin, view: Json | None) -> None:
        """Parts at rest; None for a design that has none, or whose drawing failed."""
        if view is not None:
            self._drawn = origin.text
            self.made("parts", origin, view)
        elif origin.text == self.text:
            self._undrawn = origin.text

    def press_begins(self) -> Origin:
        """The press of the present design is under way."""
        self._job, self._stop, self.progress = self.present, None, None
        return self._job

    def press_goes_on(self, job: Origin, progress: Json) -> None:
        """How far it is; that of a press which was given up says nothing."""
        if job is self._job:
            self.progress = progress

    def pressed(self, job: Origin, found: Json, complete: bool) -> None:
        """A press has answered: the accurate one takes the place of the coarse one."""
        key = job.press_hash or ""
        before = self._presses.pop(key, None)
        label = before.label if before else self._label(job)
        if before is not None and found.get("view") is None:
            found = {**found, "view": before.found.get("view")}
        quality = "array" if "array" in found else found["quality"]
        self._presses[key] = KnownPress(job, label, quality, found, complete, self._next())
        made = self._presses[key]
        if complete and made.answer is not None:
            self.estimator.learn(key, job.text, job.values or {}, made.answer, made.mesh_errors)
        while len(self._presses) > MOST_PRESSES:
            self._presses.popitem(last=False)
        self._settle()

    def press_ends(self, job: Origin, phase: Phase | None = None, said: str = "") -> None:
        """It is over. phase : failed or cancelled, with a sentence; None where it is done, or was given up."""
        if job is not self._job:
            return
        self._job, self.progress = None, None
        if phase is not None:
            self._stop = Stop(job, phase, said)
        self._settle()

    def check_fails(self, origin: Origin, said: str) -> None:
        """No check has answered, for a reason that is not the design's."""
        self._stop = Stop(origin, "failed", said)
        self._settle()

    def again(self) -> None:
        """Check and press it once more, whatever became of it before."""
        self._stop, self._undrawn, self._machine = None, None, {}
        if self.press is not None:
            self._presses[self.press.origin.press_hash or ""] = replace(self.press, complete=False)

    def made(self, name: str, origin: Origin, content: Any) -> None:
        """Something else was made of a design: influences, a kit, ..."""
        self._made[name] = Artefact(origin, content, self._next())

    def dropped(self, *names: str) -> None:
        """These artefacts are no more."""
        for name in names:
            self._made.pop(name, None)
            self.tasks.pop(name, None)

    def _settle(self) -> None:
        """Forget why another design stopped; its press is the last one where there is one."""
        if self.check is not None:
            self._last_check = (self.revision, self.check)
            if self.stop is None:
                self._stop = None
        if self.press is not None:
            self._presses.move_to_end(self.present.press_hash or "")

    def _next(self) -> int:
        self._count += 1
        return self._count

    def _label(self, job: Origin) -> str:
        """What distinguishes a press from the one before."""
        before = next(reversed(self._presses.values()), None)
        if before is None:
            return "first design"
        return design_words(before.origin.values, job.values) or "the same again"

    # What the page is told.

    @property
    def phase(self) -> Phase:
        """How far the present design is."""
        if self.stop is not None:
            return self.stop.phase
        press = self.press
        if press is not None:
            if press.failure is not None and press.complete:
                return "failed"
            return "accurate" if press.quality == "accurate" else "coarse"
        if self.check is not None and self.present.press_hash is None:
            return "checked"
        if self.estimate is not None:
            return "estimated"
        if self._drawn == self.text:
            return "drawn"
        return "edited" if self.check is None else "checked"

    def artefacts(self) -> dict[str, Artefact]:
        """All that can be shown, by name; contents are told in messages of their own."""
        found = dict(self._made)
        single = [one for one, _ in self._read_presses()]
        for names, press in ((("numbers", "curves"), single[-1:]), (("view",), [self.shown_press])):
            for name in names:
                if press and press[0] is not None:
                    found[name] = Artefact(press[0].origin, press[0].found, press[0].number)
        arrays = [one for one in self._presses.values() if one.quality == "array"]
        if arrays:
            found["array"] = Artefact(arrays[-1].origin, arrays[-1].found["array"], arrays[-1].number)
        return found

    def is_current(self, name: str, made: Artefact) -> bool:
        """Whether an artefact belongs to the present design."""
        if name in OF_RECORDING:
            return True
        now, origin = self.present, made.origin
        if name in ("numbers", "curves", "view", "array"):
            return now.press_hash is not None and origin.press_hash == now.press_hash
        if name == "parts":
            return self._drawn == now.text
        if name == "response":
            return same_but_for(made.content["result"]["key"], origin.text, now.text)
        if name == "circuit":
            press = self.press
            same = press is not None and made.content["history"] == press.found.get("history")
            return same and origin.text == now.text
        return origin.text == now.text

    def curves(self) -> list[Json]:
        """Presses of single segments, the last one last; what its amplifier reads is that of its circuit."""
        return [
            {
                "label": one.label,
                "quality": one.quality,
                "press_hash": one.origin.press_hash,
                "revision": one.origin.revision,
                "numbers": {**one.found["numbers"], "readout_voltage_V": _reading(circuit)},
            }
            for one, circuit in self._read_presses()
        ]

    @property
    def version_of_curves(self) -> list[tuple[int, int | None]]:
        """Changes with the curves."""
        return [(one.number, circuit.number if circuit else None) for one, circuit in self._read_presses()]

    def _read_presses(self) -> list[tuple[KnownPress, Artefact | None]]:
        """Presses of single segments, each with the circuit that reads it."""
        return [(one, self._circuit_of(one)) for one in self._presses.values() if one.quality != "array"]

    def _circuit_of(self, press: KnownPress) -> Artefact | None:
        made = self._made.get("circuit")
        if made is None or made.content["history"] != press.found["history"] or made.content["found"] is None:
            return None
        return None if press is self.press and made.origin.text != self.text else made

    @property
    def estimate(self) -> Json | None:
        """Force, charge and voltage of this design by a family or to first order, until its press is there."""
        if self.press is not None:
            return None
        return self._by_family.get(self.text) or self.estimator.estimate(self.text)

    @property
    def _pressing(self) -> Json | None:
        """How far the press of the present design is; None where it is not under way."""
        job, now = self._job, self.present
        if job is None:
            return None
        return self.progress or {} if self._is_same(job, now) else None

    @staticmethod
    def _is_same(one: Origin, other: Origin) -> bool:
        """Whether they have the same text, or are pressed alike."""
        return one.text == other.text or (one.press_hash is not None and one.press_hash == other.press_hash)

    def _words(self) -> Json:
        press, stop = self.press, self.stop
        pressed = None if press is None else (press.quality, press.failure)
        by = (self.estimate or {}).get("by", "press")
        return phase_words(self.phase, self.check, pressed, stop.said if stop else None, self._pressing, by)

    def told(self) -> Json:
        """The message of the whole state, but for the contents of artefacts."""
        document, (of, check) = self.document, self._last_check
        reset = document.text != document.start
        last_values = check.get("values")
        return {
            "design": {
                "revision": self.revision, "text": document.text, "undo": document.can_undo, "redo": document.can_redo,
                "reset": reset, "is_checked": self.check is not None, "of": of,
                "values": None, "stated": None, "mistakes": [], "warnings": [], "remedies": [], **check,
            },
            "phase": self.phase,
            **self._words(),
            "progress": self._pressing,
            "machine": "; ".join(dict.fromkeys(self._machine.values())) or None,
            "saved": True if self.saved is None else self.saved,
            "estimate": self.estimate,
            "is_of_family": self.is_of_family,
            "artefacts": {
                name: {
                    "revision": made.origin.revision,
                    "current": self.is_current(name, made),
                    "what": design_words(last_values, made.origin.values) or "this design",
                }
                for name, made in self.artefacts().items()
            },
            "tasks": self.tasks,
        }  # fmt: skip


def _reading(circuit: Artefact | None) -> Any:
    return circuit and circuit.content["found"]["readout_voltage_V"]


def _remember(known: OrderedDict[str, Any], text: str, found: Any) -> None:
    """Keep what is known of MOST_CHECKS texts."""
    known[text] = found
    known.move_to_end(text)
    while len(known) > MOST_CHECKS:
        known.popitem(last=False)
