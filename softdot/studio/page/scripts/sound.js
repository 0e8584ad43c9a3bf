// A curve that is heard: pitch is its height, time its way from left to right. Keys are those of MAIDR (maidr.ai).
import { element, short } from "./dom.js";

const LOW_HZ = 200,
  HIGH_HZ = 1000,
  NOTE_S = 0.12,
  WHOLE_S = 3.0;
const CELLS = "⣀⠤⠒⠉"; // four heights of a curve in Braille, as MAIDR writes it
let sounds = null;

function note(pitch, pan, at, long) {
  const tone = sounds.createOscillator(),
    loud = sounds.createGain(),
    side = sounds.createStereoPanner();
  tone.frequency.value = pitch;
  side.pan.value = pan;
  loud.gain.setValueAtTime(0, at);
  loud.gain.linearRampToValueAtTime(0.2, at + 0.01);
  loud.gain.linearRampToValueAtTime(0, at + long);
  tone.connect(loud).connect(side).connect(sounds.destination);
  tone.start(at);
  tone.stop(at + long + 0.02);
  return tone;
}

// place: the element that takes the keys; series(): [{name, x, y}] that are shown; axes: {x, y}; say(text): read aloud.
export class Heard {
  constructor(place, series, axes, say) {
    this.place = place;
    this.series = series;
    this.axes = axes;
    this.say = say;
    this.row = 0;
    this.at = -1;
    this.text = true;
    this.sound = true;
    this.tones = [];
    this.braille = element("input", {
      class: "braille",
      readonly: true,
      hidden: true,
      "aria-label": `${axes.title} as Braille`,
    });
    this.braille.addEventListener("keydown", (event) => this.key(event));
    place.after(this.braille);
    place.addEventListener("keydown", (event) => this.key(event));
  }

  get shown() {
    const all = this.series();
    this.row = Math.min(this.row, all.length - 1);
    return all[this.row];
  }

  ends(all) {
    const heights = all.flatMap((one) => one.y).filter(Number.isFinite);
    return [Math.min(...heights), Math.max(...heights)];
  }

  pitch(y) {
    const [low, high] = this.ends(this.series());
    return LOW_HZ * (HIGH_HZ / LOW_HZ) ** ((y - low) / (high - low || 1));
  }

  wake() {
    sounds = sounds || new AudioContext();
    sounds.resume();
    for (const tone of this.tones.splice(0)) tone.stop();
  }

  point() {
    const { x, y, name } = this.shown;
    if (this.sound) {
      this.wake();
      this.tones.push(
        note(
          this.pitch(y[this.at]),
          (2 * this.at) / Math.max(1, x.length - 1) - 1,
          sounds.currentTime,
          NOTE_S,
        ),
      );
    }
    if (this.text)
      this.say(`${name}: ${this.axes.x} ${short(x[this.at])}, ${this.axes.y} ${short(y[this.at])}`);
    this.braille.setSelectionRange(this.at, this.at + 1);
  }

  // The whole curve, as long in sound as it is wide; pressed again it ends.
  whole() {
    if (this.tones.length && this.playing > performance.now()) {
      this.wake();
      this.playing = 0;
      return;
    }
    const { x, y, name } = this.shown,
      from = x[0],
      wide = x[x.length - 1] - from || 1;
    this.wake();
    this.say(`${name}, ${this.axes.title}: from ${short(y[0])} to ${short(y[y.length - 1])}`);
    const start = sounds.currentTime + 0.05,
      tone = note(this.pitch(y[0]), 0, start, WHOLE_S);
    x.forEach((one, i) =>
      tone.frequency.linearRampToValueAtTime(this.pitch(y[i]), start + (WHOLE_S * (one - from)) / wide),
    );
    this.tones.push(tone);
    this.playing = performance.now() + 1e3 * WHOLE_S;
  }

  // The curve in Braille, a cell for each point: a display that is attached shows it, and the keys go along it.
  write() {
    const [low, high] = this.ends(this.series()),
      height = (y) => Math.min(3, Math.floor((4 * (y - low)) / (high - low || 1)));
    this.braille.hidden = !this.braille.hidden;
    this.braille.value = this.shown.y.map((y) => CELLS[height(y)]).join("");
    (this.braille.hidden ? this.place : this.braille).focus();
  }

  key(event) {
    if (event.altKey || event.metaKey || !this.series().length) return;
    const { x } = this.shown,
      last = x.length - 1,
      far = event.ctrlKey;
    const keys = {
      ArrowRight: () => {
        if (far && event.shiftKey) this.whole();
        else {
          this.at = far ? last : Math.min(last, this.at + 1);
          this.point();
        }
      },
      ArrowLeft: () => {
        this.at = far ? 0 : Math.max(0, this.at - 1);
        this.point();
      },
      ArrowUp: () => this.other(-1),
      ArrowDown: () => this.other(1),
      Home: () => {
        this.at = 0;
        this.point();
      },
      End: () => {
        this.at = last;
        this.point();
      },
      " ": () => {
        this.at = Math.max(0, this.at);
        this.point();
      },
      Enter: () => this.whole(),
      t: () => {
        this.text = !this.text;
        this.say(this.text ? "text on" : "text off");
      },
      s: () => {
        this.sound = !this.sound;
        this.say(this.sound ? "sound on" : "sound off");
      },
      b: () => this.write(),
      x: () => this.say(`across: ${this.axes.x}`),
      y: () => this.say(`up: ${this.axes.y}`),
    };
    if (!keys[event.key]) return;
    keys[event.key]();
    event.preventDefault();
  }

  other(way) {
    const count = this.series().length;
    this.row = (this.row + way + count) % count;
    this.at = Math.max(0, Math.min(this.at, this.shown.x.length - 1));
    if (!this.braille.hidden) {
      this.write();
      this.write();
    }
    this.point();
  }
}
